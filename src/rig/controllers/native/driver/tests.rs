//! Transcripts of the native protocol: commands, replies, and their meaning; and every fault of a line.

use super::*;
use crate::controllers::Flags;
use crate::safety::failpoint::without;
use crate::testing::rig::{Scripted, ScriptedPort, VirtualClock};
use psd_plan::Interval;

const WHO: &str =
    "PSD-BENCH 0042 1.3 -2.000000 25.000000 -2000.000 12000.000 120.000000 17 1.250000";

fn line(body: &str) -> Vec<u8> {
    format!("<{body}*{:04X}\n", native::codec::checksum(body.as_bytes())).into_bytes()
}

fn script_reply(port: &ScriptedPort, body: &str) {
    port.reply(&[Scripted::After(0.01, line(body))]);
}

/// The frames that were sent, without lead character, checksum and line ending.
fn sent(port: &ScriptedPort) -> Vec<String> {
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    let body = |frame: String| {
        frame
            .trim_start_matches('>')
            .split('*')
            .next()
            .unwrap()
            .to_owned()
    };
    port.sent()
        .into_iter()
        .map(|(_, bytes)| body(text(bytes)))
        .collect()
}

fn device() -> (NativeDevice, ScriptedPort) {
    let clock = VirtualClock::default();
    let port = ScriptedPort::new(&clock);
    (
        NativeDevice::new(LineClient::new(
            Box::new(port.clone()),
            Box::new(clock),
            0.25,
        )),
        port,
    )
}

/// A rig after its identification, at sequence number 2.
fn identified() -> (NativeDevice, ScriptedPort) {
    let (mut device, port) = device();
    script_reply(&port, &format!("ACK 1 7F3A {WHO}"));
    script_reply(&port, "ACK 2 7F3A IDLE 0x0000");
    device.identify().unwrap();
    (device, port)
}

fn reading(sequence: u32, force: &str) -> String {
    format!("DATA {sequence} 7F3A 118203 1.249871 {force} 812344 0x0000 IDLE")
}

fn force(sample: &Sample) -> f64 {
    match sample.channels[0].force {
        Some(Force::Newtons(force)) => force,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_rig_is_asked_who_it_is_and_let_go_of_what_held_it_between_runs() {
    let (mut device, port) = device();
    script_reply(
        &port,
        &format!("ACK 1 7F3A {}", WHO.replace("PSD-BENCH", "PSD-SIM-1")),
    );
    script_reply(&port, "ACK 2 7F3A HELD 0x0080");
    script_reply(&port, "ACK 3 7F3A IDLE");
    let identity = device.identify().unwrap();
    assert_eq!(
        (
            identity.model.as_str(),
            identity.serial.as_str(),
            identity.firmware.as_str()
        ),
        ("PSD-SIM-1", "0042", "1.3")
    );
    assert_eq!(
        (identity.boot.as_deref(), identity.simulated),
        (Some("7F3A"), true)
    );
    assert_eq!(
        device.last_move(),
        Some(LastMove {
            id: 17,
            targets: vec![1.25e-3]
        })
    );
    assert_eq!(sent(&port), ["HELLO 1", "STAT 2", "CLR 3"]);
}

#[test]
fn a_rig_that_is_stopped_or_strange_is_unfit() {
    let (mut device, port) = device();
    script_reply(&port, &format!("ACK 1 7F3A {WHO}"));
    script_reply(&port, "ACK 2 7F3A HELD 0x0010");
    assert!(matches!(device.identify(), Err(DeviceFault::Unfit(_))));
    assert_eq!(sent(&port).len(), 2, "a pressed stop is not cleared");
    for strange in [
        WHO.replace("25.000000", "-25.000000"),
        WHO.replace("120.000000", "0.000000"),
        WHO.replace(" 17", ""),
    ] {
        let (mut device, port) = self::device();
        script_reply(&port, &format!("ACK 1 7F3A {strange}"));
        assert!(
            matches!(device.identify(), Err(DeviceFault::Unfit(_))),
            "{strange}"
        );
    }
}

#[test]
fn limits_are_only_narrowed_a_move_is_accepted_and_a_reading_read() {
    let (mut device, port) = identified();
    let displacement = Interval {
        low: -0.001,
        high: 0.5,
    };
    let limits = Limits {
        displacement,
        speed: Interval {
            low: 0.0,
            high: 0.01,
        },
        ..Limits::NONE
    };
    script_reply(&port, "ACK 3 7F3A IDLE");
    device.narrow_limits(&[limits]).unwrap();
    let going = device.encode(&[1.25e-3], 0.5e-3).unwrap();
    assert_eq!(
        (going.targets[0], going.speed, going.id, going.frames.len()),
        (1.25e-3, 0.5e-3, Some(18), 1)
    );
    script_reply(&port, "ACK 4 7F3A MOVING");
    device.start(&going).unwrap();
    script_reply(&port, &reading(5, "512.375"));
    let sample = device.sample().unwrap();
    assert_eq!(
        (sample.time, sample.channels[0].displacement, force(&sample)),
        (Some(118.203), Some(1.249_871e-3), 512.375)
    );
    assert_eq!(
        (sample.moving, sample.channels[0].flags),
        (Some(false), Flags::default())
    );
    assert_eq!(sample.raw, [reading_line(5)]);
    let expected = [
        "LIM 3 -1.000000 25.000000 -2000.000 12000.000 10.000000",
        "MOVE 4 18 1.250000 0.500000",
        "MEAS 5 1",
    ];
    assert_eq!(sent(&port)[2..], expected);
    let nowhere = Limits {
        displacement: Interval {
            low: 0.03,
            high: 0.04,
        },
        ..Limits::NONE
    };
    assert!(matches!(
        device.narrow_limits(&[nowhere]),
        Err(DeviceFault::Unfit(_))
    ));
}

fn reading_line(sequence: u32) -> Vec<u8> {
    let mut line = line(&reading(sequence, "512.375"));
    line.pop();
    line
}

#[test]
fn targets_that_cannot_be_encoded_or_are_outside_the_rig_are_not_proposed() {
    let (mut device, port) = identified();
    for (target, speed) in [
        (0.0251, 1e-3),
        (-0.0021, 1e-3),
        (f64::NAN, 1e-3),
        (0.0, 0.0),
        (0.0, 1e-11),
        (0.0, 0.13),
        (0.0, f64::NAN),
        (0.0, -1e-3),
    ] {
        assert!(device.encode(&[target], speed).is_err(), "{target} {speed}");
    }
    assert!(
        device.encode(&[0.025], 0.12).is_ok(),
        "the limits themselves are inside"
    );
    assert_eq!(
        device.encode(&[0.000_999_999_96], 1e-3).unwrap().targets[0],
        0.001,
        "what the bytes say"
    );
    assert_eq!(port.sent().len(), 2, "nothing of it was sent");
}

#[test]
fn a_number_belongs_to_one_target_until_a_move_is_accepted() {
    let (mut device, port) = identified();
    let id = |device: &mut NativeDevice, target| device.encode(&[target], 1e-3).unwrap().id;
    assert_eq!(
        (id(&mut device, 0.001), id(&mut device, 0.002)),
        (Some(18), Some(18)),
        "neither was sent"
    );
    let going = device.encode(&[0.002], 1e-3).unwrap();
    script_reply(&port, "ERR 3 7F3A BUSY");
    let refused = device.start(&going).unwrap_err();
    assert!(refused.to_string().contains("still moving"), "{refused}");
    assert_eq!(
        (id(&mut device, 0.002), id(&mut device, 0.003)),
        (Some(18), Some(19)),
        "the rig may know 18 by its target"
    );
    let going = device.encode(&[0.003], 1e-3).unwrap();
    script_reply(&port, "ACK 4 7F3A MOVING");
    device.start(&going).unwrap();
    assert_eq!(id(&mut device, 0.003), Some(20), "a move accepted is over");
}

#[test]
fn a_move_is_sent_as_it_was_made_or_not_at_all() {
    let (mut device, port) = identified();
    let going = device.encode(&[0.001], 1e-3).unwrap();
    script_reply(&port, &reading(3, "1.0"));
    device.sample().unwrap();
    assert!(matches!(device.start(&going), Err(DeviceFault::Unfit(_))));
    assert_eq!(sent(&port).last().unwrap(), "MEAS 3 1");
}

#[test]
fn a_lost_frame_is_sent_again_as_it_was_and_a_doubled_reply_used_once() {
    let (mut device, port) = identified();
    port.reply(&[]);
    port.reply(&[Scripted::After(
        0.01,
        [line(&reading(3, "1.0")), line(&reading(3, "1.0"))].concat(),
    )]);
    assert_eq!(force(&device.sample().unwrap()), 1.0);
    script_reply(&port, &reading(4, "2.0"));
    assert_eq!(force(&device.sample().unwrap()), 2.0);
    assert_eq!(sent(&port)[2..], ["MEAS 3 1", "MEAS 3 1", "MEAS 4 1"]);
    assert_eq!(
        device.line_statistics(),
        LineStatistics {
            resent: 1,
            ignored: 1,
            reread: 0
        }
    );
}

#[test]
fn a_reply_to_another_request_is_ignored_and_without_the_guard_it_would_pass() {
    let late = |device: &mut NativeDevice, port: &ScriptedPort| {
        port.reply(&[
            Scripted::After(0.01, line(&reading(2, "666.0"))),
            Scripted::After(0.01, line(&reading(3, "1.0"))),
        ]);
        force(&device.sample().unwrap())
    };
    let (mut device, port) = identified();
    assert_eq!(late(&mut device, &port), 1.0);
    assert_eq!(device.line_statistics().ignored, 1);
    let (mut device, port) = identified();
    assert_eq!(
        without(Guarding::Sequence, || late(&mut device, &port)),
        666.0
    );
}

#[test]
fn a_broken_reply_is_asked_for_again_and_without_the_guard_it_would_pass() {
    let broken = |device: &mut NativeDevice, port: &ScriptedPort| {
        let mut wrong = line(&reading(3, "512.375"));
        let at = wrong.windows(3).position(|part| part == b"512").unwrap();
        wrong[at] = b'9';
        port.reply(&[Scripted::After(0.01, wrong)]);
        port.reply(&[Scripted::After(0.01, line(&reading(3, "512.375")))]);
        force(&device.sample().unwrap())
    };
    let (mut device, port) = identified();
    assert_eq!(broken(&mut device, &port), 512.375);
    assert_eq!(
        device.line_statistics(),
        LineStatistics {
            resent: 1,
            ignored: 1,
            reread: 0
        }
    );
    let (mut device, port) = identified();
    assert_eq!(
        without(Guarding::Checksum, || broken(&mut device, &port)),
        912.375
    );
}

#[test]
fn a_new_power_up_is_seen_in_any_reply_and_without_the_guard_it_would_pass() {
    let after_restart = "DATA 3 0001 12 0.000000 0.000 0 0x0000 IDLE";
    let (mut device, port) = identified();
    script_reply(&port, after_restart);
    let rebooted = DeviceFault::Rebooted {
        was: "7F3A".to_owned(),
        is: "0001".to_owned(),
    };
    assert_eq!(device.sample(), Err(rebooted.clone()));
    script_reply(&port, "ERR 3 0001 SEQ");
    assert_eq!(device.sample(), Err(rebooted), "whatever number it answers");
    let (mut device, port) = identified();
    script_reply(&port, after_restart);
    assert_eq!(
        without(Guarding::Reboot, || device.sample())
            .unwrap()
            .channels[0]
            .displacement,
        Some(0.0)
    );
}

/// The reading after a fault of one reply: the rig repeats its last reply when the frame is sent again.
fn after_fault(pieces: &[Scripted]) -> (f64, LineStatistics) {
    let (mut device, port) = identified();
    port.reply(pieces);
    for _ in 0..3 {
        script_reply(&port, &reading(3, "512.375"));
    }
    (force(&device.sample().unwrap()), device.line_statistics())
}

#[test]
fn every_bit_flipped_and_every_truncation_gives_the_reading_or_asks_again() {
    let whole = line(&reading(3, "512.375"));
    for bit in 0..whole.len() * 8 {
        let mut flipped = whole.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        let (force, line_statistics) = after_fault(&[Scripted::After(0.01, flipped)]);
        assert_eq!(force, 512.375, "bit {bit}");
        assert!(
            line_statistics.resent >= 1 && line_statistics.ignored >= 1,
            "bit {bit}: {line_statistics:?}"
        );
    }
    for length in 1..whole.len() {
        let (force, line_statistics) =
            after_fault(&[Scripted::After(0.01, whole[..length].to_vec())]);
        assert_eq!(force, 512.375, "{length} bytes");
        assert!(line_statistics.resent >= 1, "{length} bytes");
    }
}

#[test]
fn bytes_one_at_a_time_and_noise_around_are_read_through() {
    let whole = line(&reading(3, "512.375"));
    let pieces: Vec<Scripted> = whole
        .iter()
        .map(|byte| Scripted::After(0.001, vec![*byte]))
        .collect();
    assert_eq!(after_fault(&pieces), (512.375, LineStatistics::default()));
    let noise = [b"\0\xff<<>\n".to_vec(), whole.clone()].concat();
    assert_eq!(
        after_fault(&[Scripted::After(0.0, noise)]),
        (
            512.375,
            LineStatistics {
                ignored: 1,
                ..LineStatistics::default()
            }
        )
    );
    let endless = [vec![b'x'; 512], b"\n".to_vec(), whole].concat();
    assert_eq!(
        after_fault(&[Scripted::After(0.0, endless)]),
        (
            512.375,
            LineStatistics {
                ignored: 1,
                ..LineStatistics::default()
            }
        )
    );
}

#[test]
fn a_whole_reply_with_a_field_missing_is_no_reading() {
    for body in [
        "DATA 3 7F3A 118203 1.249871 812344 0x0000 IDLE",
        "DATA 3 7F3A 118203 1.249871 nan 812344 0x0000 IDLE",
    ] {
        let (mut device, port) = identified();
        script_reply(&port, body);
        assert!(
            matches!(device.sample(), Err(DeviceFault::Impossible { .. })),
            "{body}"
        );
        script_reply(&port, &reading(4, "1.0"));
        assert!(device.sample().is_ok(), "asked again it is a new request");
    }
}

#[test]
fn after_silence_the_conversation_is_resumed_before_anything_else() {
    let (mut device, port) = identified();
    script_reply(&port, "ACK 3 7F3A IDLE");
    device.narrow_limits(&[Limits::NONE]).unwrap();
    let going = device.encode(&[0.001], 1e-3).unwrap();
    assert_eq!(
        device.start(&going),
        Err(DeviceFault::Silent { seconds: 2.0 })
    );
    assert!(
        device.encode(&[0.001], 1e-3).is_err() && device.start(&going).is_err(),
        "first the rig is read"
    );
    script_reply(
        &port,
        &format!("ACK 5 7F3A {}", WHO.replace("17 1.25", "18 1.00")),
    );
    script_reply(&port, "ACK 6 7F3A IDLE");
    script_reply(&port, &reading(7, "1.0"));
    device.sample().unwrap();
    let sent = sent(&port);
    assert_eq!(sent[3..7], vec!["MOVE 4 18 1.000000 1.000000"; 4]);
    assert_eq!(
        sent[7..],
        [
            "HELLO 5",
            "LIM 6 -2.000000 25.000000 -2000.000 12000.000 120.000000",
            "MEAS 7 1"
        ]
    );
    assert_eq!(
        device.encode(&[0.001], 1e-3).unwrap().id,
        Some(18),
        "said again under its number, it is not done twice"
    );
}

#[test]
fn a_hold_is_sent_immediately_and_cleared_only_with_the_next_move() {
    let (mut device, port) = identified();
    port.reply(&[]);
    script_reply(&port, "ACK 3 7F3A HELD");
    device.hold().unwrap();
    assert_eq!(sent(&port)[2..], ["!", "STOP 3"]);
    let going = device.encode(&[0.0], 1e-3).unwrap();
    script_reply(&port, "ACK 4 7F3A IDLE");
    script_reply(&port, "ACK 5 7F3A MOVING");
    device.start(&going).unwrap();
    assert_eq!(sent(&port)[4..], ["CLR 4", "MOVE 5 18 0.000000 1.000000"]);
    assert_eq!(device.emergency(), b"!");
}

#[test]
fn a_hold_by_the_rig_itself_is_not_let_go_of() {
    let (mut device, port) = identified();
    let going = device.encode(&[0.001], 1e-3).unwrap();
    script_reply(&port, "ERR 3 7F3A HELD");
    assert!(matches!(
        device.start(&going),
        Err(DeviceFault::Refused { .. })
    ));
    assert_eq!(device.encode(&[0.001], 1e-3).unwrap().frames.len(), 1);
}

/// A lateral axis, and one that holds 26.25 kN within 500 N.
const COLUMN: &str = "PSD-COLUMN 0044 1.5 -30.000000 30.000000 -80000.000 80000.000 -4.000000 4.000000 -300000.000 300000.000 120.000000 21 0.000000 26250.000";
const AXIAL: [Option<AxialAxis>; 2] = [
    None,
    Some(AxialAxis {
        storey: 0,
        rate: 5000.0,
        tolerance: 500.0,
        p_delta: 1.0,
    }),
];

fn column(status: &str) -> (NativeDevice, ScriptedPort) {
    let (device, port) = device();
    script_reply(&port, &format!("ACK 1 7F3A {COLUMN}"));
    script_reply(&port, &format!("ACK 2 7F3A {status}"));
    (device, port)
}

#[test]
fn targets_of_an_axis_in_force_control_are_forces() {
    let (mut device, port) = column("IDLE 0x0100");
    device.identify().unwrap();
    script_reply(&port, "ACK 3 7F3A IDLE");
    device.control_force(&AXIAL).unwrap();
    assert_eq!(
        device.last_move().unwrap().targets,
        [0.0, 26_250.0],
        "HELLO stated it before FORCE"
    );
    let going = device.encode(&[0.005, 30_000.125_4], 1e-3).unwrap();
    assert_eq!(going.targets, [0.005, 30_000.125]);
    script_reply(&port, "ACK 4 7F3A MOVING");
    device.start(&going).unwrap();
    assert_eq!(
        sent(&port)[2..],
        [
            "FORCE 3 0.000 0.000 5000.000 500.000",
            "MOVE 4 22 5.000000 30000.125 1.000000"
        ]
    );
    // The limits of displacement are those of the band, and not of its targets.
    assert!(device.encode(&[0.031, 0.0], 1e-3).is_err());
    assert!(device.encode(&[0.0, 300_001.0], 1e-3).is_err());
    script_reply(
        &port,
        "DATA 5 7F3A 240117 5.000000 0.125 103 0x0000 0.004167 30000.125 893001 0x0100 IDLE",
    );
    let flags = device.sample().unwrap().channels[1].flags;
    assert!(flags.in_force_control && flags.left_force_control().is_none());
}

#[test]
fn an_interrupted_conversation_states_the_force_control_again() {
    let (mut device, port) = column("IDLE 0x0100");
    device.identify().unwrap();
    script_reply(&port, "ACK 3 7F3A IDLE");
    device.control_force(&AXIAL).unwrap();
    script_reply(&port, "ERR 4 7F3A SEQ");
    assert!(device.sample().is_err());
    script_reply(&port, &format!("ACK 5 7F3A {COLUMN}"));
    script_reply(&port, "ACK 6 7F3A IDLE");
    script_reply(
        &port,
        "DATA 7 7F3A 240117 0.0 0.0 1 0x0000 0.0 26250.000 1 0x0100 IDLE",
    );
    device.sample().unwrap();
    assert_eq!(
        sent(&port)[4..],
        [
            "HELLO 5",
            "FORCE 6 0.000 0.000 5000.000 500.000",
            "MEAS 7 1"
        ]
    );
}

#[test]
fn a_firmware_without_force_control_is_unfit() {
    let (mut device, port) = column("IDLE 0x0000");
    device.identify().unwrap();
    device.control_force(&[None, None]).unwrap();
    script_reply(&port, "ERR 3 7F3A VERB");
    assert_eq!(
        device.control_force(&AXIAL),
        Err(DeviceFault::Unfit(
            "its firmware 1.5 cannot hold an axial force: the rig does not know this request (`ERR VERB`)"
                .to_owned()
        ))
    );
}

/// A load that the controller has left is not lost from view by the CLR of the next run.
#[test]
fn a_load_that_was_left_is_cleared_by_a_person_alone() {
    for (status, reason) in [
        ("HELD 0x0200", "its band"),
        ("HELD 0x0480", "did not follow"),
    ] {
        let (mut device, port) = column(status);
        let refused = device.identify().unwrap_err().to_string();
        assert!(refused.contains(reason), "{refused}");
        assert_eq!(sent(&port).len(), 2);
        let (device, port) = column(status);
        script_reply(&port, "ACK 3 7F3A IDLE");
        let allowed = crate::StopRequest::default().with_release_allowed(true);
        let mut device = NativeDevice::new(device.client.observing(allowed));
        device.identify().unwrap();
        assert_eq!(sent(&port)[2], "CLR 3");
    }
}
