//! The native protocol against the vectors of its specification, and against every single fault of a line.

use super::*;
use crate::safety::failpoint::without;

const DATA: &[u8] = b"<DATA 42 7F3A 118203 1.249871 512.375 812344 0x0000 IDLE*788B";
const ACK: &[u8] = b"<ACK 41 7F3A MOVING*1F01";

fn framed(body: &str) -> Vec<u8> {
    format!("<{body}*{:04X}", checksum(body.as_bytes())).into_bytes()
}

fn acknowledged(body: &str) -> Reply {
    reply(&framed(&format!("ACK 1 7F3A {body}"))).unwrap()
}

fn hello_of(body: &str) -> Option<Hello> {
    hello(&acknowledged(body).words())
}

fn read(line: &[u8]) -> Option<Data> {
    data(&reply(line).unwrap().words())
}

#[test]
fn the_vectors_of_the_specification() {
    assert_eq!(checksum(b"123456789"), 0x29b1);
    let written = |targets: &[f64], speed| (lengths(targets).unwrap(), length(speed).unwrap());
    let (targets, speed) = written(&[1.25e-3], 0.5e-3);
    let moving = Request::Move {
        id: 17,
        targets: &targets,
        speed: &speed,
    };
    assert_eq!(
        frame(41, &moving).unwrap(),
        b">MOVE 41 17 1.250000 0.500000*6858\n"
    );
    assert_eq!(
        frame(42, &Request::Measure { readings: 5 }).unwrap(),
        b">MEAS 42 5*5976\n"
    );
    let accepted = reply(ACK).unwrap();
    assert_eq!(
        (accepted.kind, accepted.sequence, accepted.boot()),
        (ReplyKind::Ack, 41, "7F3A")
    );
    assert_eq!(state(accepted.words()[0]), Some(ReportedState::Moving));
    let read = read(DATA).unwrap();
    let axis = AxisData {
        displacement: 1.249_871e-3,
        force: 512.375,
        raw: 812_344,
        flags: Flags::default(),
    };
    assert_eq!(
        (read.time, read.axes, read.state),
        (118.203, vec![axis], ReportedState::Idle)
    );
}

#[test]
fn each_request_states_its_verb() {
    let body = |request| {
        let frame = String::from_utf8(frame(7, &request).unwrap()).unwrap();
        assert!(frame.starts_with('>') && frame.ends_with('\n'));
        frame[1..].split('*').next().unwrap().to_owned()
    };
    let (displacement, force) = (
        Interval {
            low: -0.002,
            high: 0.025,
        },
        Interval {
            low: -2000.0,
            high: 12_000.0,
        },
    );
    let bounds = Bounds {
        axes: vec![AxisBounds {
            displacement,
            force,
        }],
        top_speed: 0.12,
    };
    assert_eq!(body(Request::Hello), "HELLO 7");
    assert_eq!(
        body(Request::Limits(&bounds)),
        "LIM 7 -2.000000 25.000000 -2000.000 12000.000 120.000000"
    );
    assert_eq!(body(Request::Status), "STAT 7");
    assert_eq!(body(Request::Stop), "STOP 7");
    assert_eq!(body(Request::Clear), "CLR 7");
    assert_eq!(body(Request::Reference { token: "R-12" }), "REF 7 R-12");
}

#[test]
fn values_that_cannot_be_encoded_are_not_sent() {
    assert_eq!(lengths(&[0.0, 1e-3]).as_deref(), Some("0.000000 1.000000"));
    for none in [f64::NAN, f64::INFINITY, 1e60] {
        assert_eq!((length(none), lengths(&[0.0, none])), (None, None));
        let end = End {
            position: none,
            velocity: 0.0,
        };
        assert_eq!(
            frame(
                1,
                &Request::Glide {
                    id: 1,
                    ends: &[end],
                    seconds: 1.0
                }
            ),
            None
        );
    }
    assert_eq!(frame(1, &Request::Reference { token: "two words" }), None);
    assert_eq!(
        frame(
            1,
            &Request::Reference {
                token: &"x".repeat(90)
            }
        ),
        None,
        "longer than a frame"
    );
}

#[test]
fn a_rig_identifies_itself() {
    let body = "PSD-BENCH 0042 1.3 -2.000000 25.000000 -2000.000 12000.000 120.000000 17 1.250000";
    let rig = hello_of(body).unwrap();
    assert_eq!(
        (
            rig.model.as_str(),
            rig.serial.as_str(),
            rig.firmware.as_str()
        ),
        ("PSD-BENCH", "0042", "1.3")
    );
    let (displacement, force) = (
        Interval {
            low: -0.002,
            high: 0.025,
        },
        Interval {
            low: -2000.0,
            high: 12_000.0,
        },
    );
    assert_eq!(
        rig.bounds,
        Bounds {
            axes: vec![AxisBounds {
                displacement,
                force
            }],
            top_speed: 0.12
        }
    );
    assert_eq!(rig.last, Some((17, vec![1.25])));
    assert_eq!(
        hello_of(&body.replace("17 1.25", "0 0.00")).unwrap().last,
        None
    );
    assert_eq!(hello_of(&body.replace("25.000000", "inf")), None);
    assert_eq!(hello_of(&body.replace(" 0042", "")), None);
}

#[test]
fn every_bit_flipped_and_every_truncation_of_a_line_is_no_reply() {
    for line in [DATA, ACK] {
        for bit in 0..line.len() * 8 {
            let mut flipped = line.to_vec();
            flipped[bit / 8] ^= 1 << (bit % 8);
            assert!(reply(&flipped).is_err(), "{}", flipped.escape_ascii());
        }
        for length in 0..line.len() {
            assert!(reply(&line[..length]).is_err(), "{length} bytes");
            assert!(
                reply(&line[length + 1..]).is_err(),
                "without the first {length}"
            );
        }
    }
}

#[test]
fn without_its_checksum_a_false_number_would_pass() {
    let mut flipped = DATA.to_vec();
    let at = DATA.iter().position(|byte| *byte == b'5').unwrap();
    flipped[at] = b'9';
    assert_eq!(reply(&flipped), Err(Broken::Checksum));
    let force = without(Guarding::Checksum, || read(&flipped).unwrap().axes[0].force);
    assert_eq!(force, 912.375);
}

#[test]
fn a_whole_line_with_a_false_field_is_no_reading() {
    for (right, false_field) in [
        (" 512.375", ""),
        (" 512.375", " 512.375 1.0"),
        ("512.375", "nan"),
        ("512.375", "5,12"),
        ("512.375", "--512"),
        ("512.375", "1e3"),
        ("1.249871", "1.249871."),
        ("118203", "-1"),
        ("812344", "8.5"),
        ("0x0000", "0x0800"),
        ("0x0000", "0000"),
        ("0x0000", "0x00"),
        ("IDLE", "idle"),
    ] {
        let body = String::from_utf8(DATA[1..DATA.len() - 5].to_vec())
            .unwrap()
            .replacen(right, false_field, 1);
        assert_eq!(read(&framed(&body)), None, "{body}");
    }
    // Complete replies with an invalid field.
    for field in ["", "1\x002"] {
        let whole = reply(&framed(&format!("DATA 42 7F3A 1 {field} 2"))).unwrap();
        let words = whole.words();
        assert_eq!(
            (words.as_slice(), data(&words)),
            (&["1", "", "2"][..], None)
        );
        assert_eq!(
            hello_of(&format!("{field} 0042 1.3 -25.0 25.0 -5.0 5.0 10.0 0 0.0")),
            None
        );
    }
    for body in [
        "DATA -1 7F3A",
        "DATA 4294967296 7F3A",
        "DATA 4 7f3a",
        "DATA 4",
        "NACK 1 7F3A",
    ] {
        assert_eq!(reply(&framed(body)), Err(Broken::Shape), "{body}");
    }
}

#[test]
fn each_flag_has_its_bit_and_each_code_its_words() {
    let set = |bit: u32| flags(&format!("0x{:04X}", 1 << bit)).unwrap();
    assert!(set(0).saturated && set(1).stale && set(2).limit_high && set(3).limit_low);
    assert!(
        set(4).emergency_stop && set(5).unreferenced && set(6).unsettled && set(7).watchdog_tripped
    );
    assert!(refusal(&["LIMIT"]).contains("outside the limits"));
    assert_eq!(
        refusal(&["WHAT"]),
        "for a reason unknown to psd (`ERR WHAT`)"
    );
}

/// A rig of two axes, as in `docs/reference/native-protocol.md`.
#[test]
fn the_vectors_of_several_axes() {
    let (targets, speed) = (
        lengths(&[1.5e-3, -2.75e-3]).unwrap(),
        length(0.5e-3).unwrap(),
    );
    let moving = Request::Move {
        id: 22,
        targets: &targets,
        speed: &speed,
    };
    assert_eq!(
        frame(62, &moving).unwrap(),
        b">MOVE 62 22 1.500000 -2.750000 0.500000*A8EB\n"
    );
    let limits = |displacement: f64, force: f64| AxisBounds {
        displacement: Interval {
            low: -displacement,
            high: displacement,
        },
        force: Interval {
            low: -force,
            high: force,
        },
    };
    let bounds = Bounds {
        axes: vec![limits(0.02, 6000.0), limits(0.04, 4000.0)],
        top_speed: 0.05,
    };
    let narrowed = b">LIM 61 -20.000000 20.000000 -6000.000 6000.000 -40.000000 40.000000 -4000.000 4000.000 50.000000*4C87\n";
    assert_eq!(
        frame(61, &Request::Limits(&bounds)).unwrap(),
        narrowed,
        "longer than a frame of one axis may be"
    );
    let line = b"<DATA 63 7F3A 240117 1.499982 912.250 748401 0x0000 -2.750011 -512.375 -420331 0x0000 IDLE*2457";
    let read = read(line).unwrap();
    let forces: Vec<(f64, f64)> = read
        .axes
        .iter()
        .map(|axis| (axis.displacement, axis.force))
        .collect();
    assert_eq!(forces, [(1.499_982e-3, 912.25), (-2.750_011e-3, -512.375)]);
}

#[test]
fn the_number_of_axes_follows_from_their_fields() {
    let axis = |number: usize| format!("-{number}.000000 {number}.000000 -10.000 10.000");
    let with = |axes: usize, targets: usize| {
        let limits: Vec<String> = (1..=axes).map(axis).collect();
        let targets = vec!["0.500000"; targets].join(" ");
        hello_of(&format!(
            "PSD-BENCH 0042 1.3 {} 120.000000 3 {targets}",
            limits.join(" ")
        ))
    };
    for (axes, metres) in (1..=MOST_AXES).zip((1..=6).map(|axes| f64::from(axes) / 1e3)) {
        let rig = with(axes, axes).unwrap();
        assert_eq!(
            (rig.bounds.axes.len(), rig.last.unwrap().1.len()),
            (axes, axes)
        );
        assert_eq!(rig.bounds.axes[axes - 1].displacement.high, metres);
    }
    assert_eq!(
        (with(2, 1), with(2, 3), with(1, 2), with(0, 0)),
        (None, None, None, None)
    );
    assert_eq!(
        with(MOST_AXES + 1, MOST_AXES + 1),
        None,
        "no reply may be so long"
    );
}

#[test]
fn of_several_axes_the_one_without_a_number_is_known() {
    let acknowledgement = |force: &str| {
        acknowledged(&format!(
            "118203 1.0 2.0 3 0x0000 1.0 {force} 3 0x0000 IDLE"
        ))
    };
    let (sound, none) = (acknowledgement("2.0"), acknowledgement("NaN"));
    assert_eq!(axis_without_number(&sound.words()), None);
    for none in ["NaN", "1e400", "OVL"] {
        let received = acknowledgement(none);
        assert_eq!(
            (
                axis_without_number(&received.words()),
                data(&received.words())
            ),
            (Some(2), None),
            "{none}"
        );
    }
    // A single axis has no missing axis, and an invalid number of words identifies none.
    assert_eq!(axis_without_number(&sound.words()[..6]), None);
    assert_eq!(axis_without_number(&none.words()[..8]), None);
}

/// The table contains the results of the polynomial division, bit by bit.
#[test]
fn the_checksum_is_the_one_of_its_definition() {
    let by_bits = |bytes: &[u8]| {
        bytes.iter().fold(0xffff, |sum: u16, byte| {
            (0..8).fold(sum ^ u16::from(*byte) << 8, |sum, _| {
                if sum & 0x8000 == 0 {
                    sum << 1
                } else {
                    sum << 1 ^ 0x1021
                }
            })
        })
    };
    let all: Vec<u8> = (0..=255).collect();
    for length in 0..=all.len() {
        assert_eq!(checksum(&all[..length]), by_bits(&all[..length]));
        assert_eq!(checksum(&all[length..]), by_bits(&all[length..]));
    }
}
