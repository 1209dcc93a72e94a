//! Transcripts of a drive and of a transmitter: exceptions, noise, silence, late answers, swapped words.

use super::*;
use crate::safety::failpoint::{Guarding, without};
use crate::testing::rig::{Scripted, ScriptedPort, VirtualClock};
use crate::transport::Clock as _;
use psd_plan::Interval;

const T: f64 = 0.2;
const FLOAT: ModbusNumber = ModbusNumber::Float32 {
    high_word_first: true,
};

/// Position 10, force 20, status 30 with bit 0, target 40, speed 50, command 60: 1 starts, 2 stops. In mm, mm/s and N.
const MAP: ModbusMap = ModbusMap {
    unit: 1,
    number: FLOAT,
    target: Some(40),
    speed: Some(50),
    position: Some(10),
    force: Some(20),
    status: Some(30),
    moving_mask: 1,
    command: Some(60),
    start_word: 1,
    stop_word: 2,
    length_unit: 1e-3,
    speed_unit: 1e-3,
    force_unit: 1.0,
};
const CELL: ModbusMap = ModbusMap {
    target: None,
    speed: None,
    position: None,
    status: None,
    command: None,
    ..MAP
};

fn device(map: ModbusMap) -> (Modbus, ScriptedPort, VirtualClock) {
    let clock = VirtualClock::default();
    let port = ScriptedPort::new(&clock);
    let client = LineClient::new(Box::new(port.clone()), Box::new(clock.clone()), T);
    (Modbus::new(client, map, Some(19_200)), port, clock)
}

/// The same after it has read this position \[mm\], no force and no motion: three questions.
fn standing_at(position: f32, map: ModbusMap) -> (Modbus, ScriptedPort, VirtualClock) {
    let (mut device, port, clock) = device(map);
    for reply in [float(position), float(0.0), sealed(&[1, 3, 2, 0, 0])] {
        port.reply(&at_once(reply));
    }
    device.sample().unwrap();
    (device, port, clock)
}

fn sealed(body: &[u8]) -> Vec<u8> {
    let check = modbus::codec::crc(body).to_le_bytes();
    [body, &check].concat()
}

fn float(value: f32) -> Vec<u8> {
    sealed(&[&[1, 3, 4][..], &value.to_bits().to_be_bytes()].concat())
}

fn at_once(bytes: Vec<u8>) -> [Scripted; 1] {
    [Scripted::After(0.01, bytes)]
}

fn frames(port: &ScriptedPort) -> Vec<Vec<u8>> {
    port.sent().into_iter().map(|(_, frame)| frame).collect()
}

fn force(sample: &Sample) -> f64 {
    match sample.channels[0].force {
        Some(Force::Newtons(newtons)) => newtons,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_sample_equals_the_registers() {
    let (mut device, port, _) = device(MAP);
    port.reply(&at_once(float(12.5)));
    // In pieces of one byte.
    port.reply(
        &float(-300.0)
            .into_iter()
            .map(|byte| Scripted::After(0.001, vec![byte]))
            .collect::<Vec<_>>(),
    );
    port.reply(&at_once(sealed(&[1, 3, 2, 0, 5])));
    let sample = device.sample().unwrap();
    assert_eq!(sample.channels[0].displacement, Some(0.0125));
    assert_eq!(force(&sample), -300.0);
    assert_eq!(sample.moving, Some(true), "0b101 and mask 1");
    assert_eq!(
        sample.raw,
        [float(12.5), float(-300.0), sealed(&[1, 3, 2, 0, 5])]
    );
    let asked = [
        &[1, 3, 0, 10, 0, 2][..],
        &[1, 3, 0, 20, 0, 2],
        &[1, 3, 0, 30, 0, 1],
    ]
    .map(sealed);
    assert_eq!(frames(&port), asked);
    assert_eq!(device.line_statistics(), LineStatistics::default());
}

#[test]
fn three_and_a_half_characters_of_silence_come_before_every_question() {
    let (mut device, port, _) = device(CELL);
    port.reply(&at_once(float(1.0)));
    port.reply(&at_once(float(2.0)));
    device.sample().unwrap();
    device.sample().unwrap();
    let times: Vec<f64> = port.sent().iter().map(|(time, _)| *time).collect();
    let gap = 38.5 / 19_200.0;
    assert!(
        times[0] >= gap - 1e-9 && times[1] >= times[0] + 0.01 + gap - 1e-9,
        "{times:?}"
    );
}

#[test]
fn a_move_is_speed_target_start_and_its_numbers_are_those_of_its_registers() {
    let (mut device, port, _) = standing_at(12.5, MAP);
    let going = device.encode(&[0.001_3], 0.003).unwrap();
    let short = |value: f32| value.to_bits().to_be_bytes();
    assert_eq!(going.frames[0][7..11], short(3.0));
    assert_eq!(going.frames[1][7..11], short(1.3));
    assert_eq!(going.frames[2], sealed(&[1, 6, 0, 60, 0, 1]));
    assert_eq!(
        going.targets[0],
        f64::from(1.3_f32) * 1e-3,
        "1.3 is no short float"
    );
    assert_eq!(going.speed, 0.003);
    for frame in &going.frames {
        let echo = if frame[1] == 6 {
            frame.clone()
        } else {
            sealed(&frame[..6])
        };
        port.reply(&at_once(echo));
    }
    device.start(&going).unwrap();
    assert_eq!(frames(&port)[3..], going.frames);
}

#[test]
fn no_speed_is_rounded_up_and_no_number_is_clamped() {
    let whole = ModbusMap {
        number: ModbusNumber::Int16,
        length_unit: 1e-5,
        speed_unit: 1e-5,
        ..MAP
    };
    let (mut device, ..) = device(whole);
    let going = device.encode(&[0.012_344], 0.001_239).unwrap();
    assert!(
        (going.targets[0] - 0.012_34).abs() < 1e-15 && (going.speed - 0.001_23).abs() < 1e-15,
        "{going:?}"
    );
    for step in 1..2000 {
        let asked = f64::from(step) * 1e-5;
        let going = device.encode(&[asked], asked).unwrap();
        assert_eq!(
            (going.targets[0], going.speed),
            (asked, asked),
            "the last bit of turning units makes no difference"
        );
    }
    for (target, speed) in [
        (0.4, 1e-3),
        (f64::NAN, 1e-3),
        (0.0, 1e-6),
        (0.0, f64::NAN),
        (0.0, -1.0),
    ] {
        assert!(
            matches!(device.encode(&[target], speed), Err(DeviceFault::Unfit(_))),
            "{target} {speed}"
        );
    }
    let (mut device, ..) = standing_at(12.5, MAP);
    for step in 1..2000 {
        let asked = f64::from(step) * 1.7e-6;
        let encoded = device.encode(&[0.0], asked).unwrap().speed;
        assert!(
            encoded <= asked && encoded > 0.99 * asked,
            "{encoded} {asked}"
        );
    }
}

#[test]
fn an_exception_is_a_refusal_in_words() {
    let (mut device, port, _) = standing_at(12.5, MAP);
    let going = device.encode(&[0.001], 0.001).unwrap();
    port.reply(&at_once(sealed(&[1, 0x90, 3])));
    let refused = DeviceFault::Refused {
        reason: "the value is not allowed (exception 3)".to_owned(),
    };
    assert_eq!(device.start(&going), Err(refused));
    assert_eq!(port.sent().len(), 4, "neither target nor start follow");
}

#[test]
fn noise_and_a_broken_answer_are_waited_out_and_asked_again() {
    let (mut device, port, _) = device(CELL);
    let mut broken = float(7.0);
    broken[4] ^= 0x10;
    port.reply(&at_once(broken));
    port.reply(&at_once(float(8.0)));
    port.reply(&at_once(float(9.0)));
    assert_eq!(force(&device.sample().unwrap()), 9.0);
    assert_eq!(
        device.line_statistics(),
        LineStatistics {
            resent: 1,
            ignored: 1,
            reread: 0
        }
    );
    // Bytes that arrived before the first request are discarded.
    port.send_unasked(&[
        Scripted::After(0.0, vec![0xFF; 700]),
        Scripted::After(0.0, float(1.0)),
    ]);
    port.reply(&at_once(float(2.0)));
    assert_eq!(force(&device.sample().unwrap()), 2.0);
}

/// The first request is answered after 1.2 T, the others immediately.
fn late_answer() -> f64 {
    let (mut device, port, _) = device(CELL);
    // The late reply arrives while the driver waits for silence, or as the reply to the second request.
    port.reply(&[Scripted::After(1.2 * T, float(111.0))]);
    for value in [222.0, 333.0, 444.0] {
        port.reply(&at_once(float(value)));
    }
    force(&device.sample().unwrap())
}

#[test]
fn a_late_answer_is_never_accepted_and_only_the_guard_stops_it() {
    assert_ne!(late_answer(), 111.0);
    assert_eq!(without(Guarding::Sequence, late_answer), 111.0);
}

#[test]
fn an_answer_that_comes_while_the_second_question_is_open_is_one_too_many() {
    let (mut device, port, _) = device(CELL);
    port.reply(&[Scripted::After(2.1 * T, float(111.0))]);
    // In order on the line: the late reply, then the reply to the second request.
    port.reply(&at_once(float(222.0)));
    port.reply(&at_once(float(333.0)));
    port.reply(&at_once(float(444.0)));
    assert_eq!(force(&device.sample().unwrap()), 444.0);
    assert!(device.line_statistics().ignored >= 1);
}

#[test]
fn silence_is_bounded() {
    let (mut device, port, clock) = device(CELL);
    assert!(matches!(device.sample(), Err(DeviceFault::Silent { .. })));
    assert!(clock.now() < 8.0 * T && port.sent().len() == 4);
}

#[test]
fn what_is_no_number_is_no_reading() {
    let (mut device, port, _) = device(CELL);
    for value in [f32::NAN, f32::INFINITY, 1e30, 1e-40] {
        port.reply(&at_once(float(value)));
        assert!(
            matches!(device.sample(), Err(DeviceFault::Impossible { .. })),
            "{value}"
        );
    }
}

#[test]
fn swapped_words_are_noticed_when_it_is_opened() {
    for value in [12.5_f32, 0.1, -3.75, 1234.5] {
        let (mut device, port, _) = device(ModbusMap {
            number: ModbusNumber::Float32 {
                high_word_first: false,
            },
            ..MAP
        });
        for reply in [
            float(value),
            float(0.0),
            sealed(&[1, 3, 2, 0, 0]),
            float(value),
        ] {
            port.reply(&at_once(reply));
        }
        let DeviceFault::Impossible { reason, .. } = device.identify().unwrap_err() else {
            panic!()
        };
        assert!(reason.contains("register order"), "{reason}");
    }
}

/// Words of the number in this frame: unit, function, address, number of words and bytes come before them.
fn words_of(frame: &[u8]) -> Vec<u16> {
    let words = frame[7..11].chunks_exact(2);
    words
        .map(|word| u16::from_be_bytes([word[0], word[1]]))
        .collect()
}

const TURNED: ModbusNumber = ModbusNumber::Float32 {
    high_word_first: false,
};

/// If every reading is exactly 0, the word order cannot be determined.
#[test]
fn a_drive_with_swapped_words_is_sent_no_speed_and_no_target() {
    for speed in [1e-3, 1.1e-3, 0.7e-3, 0.05] {
        let (mut device, ..) = standing_at(0.0, MAP);
        let going = device.encode(&[1e-4], speed).unwrap();
        assert!(device.rounds_first_target());
        // 0.1 mm is 3DCC CCCD: the nearest number without a low word is 3DCD 0000.
        assert_eq!(words_of(&going.frames[1]), [0x3DCD, 0]);
        assert!((going.targets[0] - 1e-4).abs() < 0.004 * 1e-4, "{going:?}");
        let turned = modbus::codec::from_words(TURNED, &words_of(&going.frames[1])).unwrap();
        assert!(turned.abs() < 1e-38, "the target is {turned} mm to it");
        assert!(
            going.speed <= speed && going.speed > 0.99 * speed,
            "{}",
            going.speed
        );
        let turned = modbus::codec::from_words(TURNED, &words_of(&going.frames[0])).unwrap();
        assert!(turned.abs() < 1e-38, "{speed} m/s is {turned} mm/s to it");
    }
}

#[test]
fn a_target_is_exact_once_a_reading_shows_the_order() {
    for (position, rounded) in [(0.0, true), (0.1, false), (-12.5, false)] {
        let (mut device, ..) = standing_at(position, MAP);
        let going = device.encode(&[1e-4], 1e-3).unwrap();
        assert_eq!(device.rounds_first_target(), rounded, "{position}");
        let exact = (going.targets[0] - 1e-4).abs() < 1e-11;
        assert_eq!(exact, !rounded, "{position}: {going:?}");
    }
    // 5.0005 mm is 40A0 0419. In the other order it is 0419 40A0, 1.8e-36 mm: no reading. 40A0 2419 would be 3.4e-17 mm, which is one.
    let ambiguous = f32::from_bits(0x40A0_2419);
    let (mut device, ..) = standing_at(ambiguous, MAP);
    assert!(device.rounds_first_target());
    // 6 mm is 40C0 0000: 2.3e-41 mm in the other order, where the drive would stay. 0.1 mm would be −1.1e8 mm.
    let going = device.encode(&[6e-3], 1e-3).unwrap();
    assert_eq!(words_of(&going.frames[1]), [0x40C0, 0]);
}

/// A drive far outside the limits: 1.4 mm is 3FB3 3333, and in the other order 3333 3FB3, 4.2e-8 mm. No sensor resolves that.
#[test]
fn a_reading_that_no_sensor_resolves_shows_no_order() {
    let displacement = Interval {
        low: -1e-4,
        high: 1e-4,
    };
    let limits = Limits {
        displacement,
        ..Limits::NONE
    };
    let turned = f32::from_bits(0x3333_3FB3);
    for (position, open) in [(turned, true), (0.05, false)] {
        let (mut device, port, _) = device(MAP);
        device.narrow_limits(&[limits]).unwrap();
        for reply in [float(position), float(0.0), sealed(&[1, 3, 2, 0, 0])] {
            port.reply(&at_once(reply));
        }
        device.sample().unwrap();
        assert_eq!(device.rounds_first_target(), open, "{position} mm");
    }
}

/// A whole number has no first target that is small in both orders.
#[test]
fn a_drive_with_whole_numbers_at_zero_is_sent_nothing() {
    let map = ModbusMap {
        number: ModbusNumber::Int32 {
            high_word_first: true,
        },
        length_unit: 1e-6,
        ..MAP
    };
    let standing = |counts: i32| {
        let (mut device, port, _) = device(map);
        let counts = sealed(&[&[1, 3, 4][..], &counts.to_be_bytes()].concat());
        for reply in [counts, float(0.0), sealed(&[1, 3, 2, 0, 0])] {
            port.reply(&at_once(reply));
        }
        let millimetres = |millimetres: f64| 1e-3 * millimetres;
        let displacement = Interval {
            low: millimetres(-2.0),
            high: millimetres(25.0),
        };
        let limits = Limits {
            displacement,
            ..Limits::NONE
        };
        device.narrow_limits(&[limits]).unwrap();
        device.sample().unwrap();
        device
    };
    let refused = standing(0).encode(&[1e-4], 1e-3).unwrap_err();
    assert!(
        refused
            .to_string()
            .contains("in the other order the target 0.1 mm is 6.55 m"),
        "{refused}"
    );
    // −1 is the same number in both orders.
    assert!(standing(-1).encode(&[1e-4], 1e-3).is_err());
    // 4 counts would be 262 mm in the other order, beyond ten times the limits.
    for counts in [4, -5, 100] {
        let going = standing(counts).encode(&[1e-4], 1e-3).unwrap();
        assert_eq!(words_of(&going.frames[1]), [0, 100], "{counts}");
    }
    let (zero, same) = (standing(0).encode(&[0.0], 1e-3), standing(0));
    assert!(zero.is_ok() && same.order.is_open(), "it stays where it is");
    let unguarded = without(Guarding::WordOrder, || standing(0).encode(&[1e-4], 1e-3));
    assert!(unguarded.is_ok(), "nothing else sees it");
}

#[test]
fn a_transmitter_with_input_registers_only_is_found_out() {
    let (mut device, port, _) = device(CELL);
    let input = |value: f32| sealed(&[&[1, 4, 4][..], &value.to_bits().to_be_bytes()].concat());
    for reply in [sealed(&[1, 0x83, 2]), input(5.0), input(5.0), input(6.0)] {
        port.reply(&at_once(reply));
    }
    assert_eq!(device.identify().unwrap().model, "Modbus unit 1");
    assert_eq!(force(&device.sample().unwrap()), 6.0);
    assert_eq!(frames(&port)[3], sealed(&[1, 4, 0, 20, 0, 2]));
    assert!(
        matches!(device.encode(&[0.0], 1.0), Err(DeviceFault::Unfit(_))),
        "it cannot move"
    );
}

#[test]
fn it_holds_by_its_stop_word_or_by_going_where_it_is() {
    let (mut device, port, _) = device(MAP);
    let stop = sealed(&[1, 6, 0, 60, 0, 2]);
    // The first command is lost.
    port.reply(&[]);
    port.reply(&at_once(stop.clone()));
    device.hold().unwrap();
    assert_eq!(frames(&port), [stop.clone(), stop.clone()]);
    assert_eq!(device.emergency(), stop);
    let (mut device, port, _) = self::device(ModbusMap {
        command: None,
        ..MAP
    });
    // The line is one answer behind: the first answer is a force of 111 N.
    port.reply(&at_once(float(111.0)));
    port.reply(&at_once(float(2.5)));
    let target = modbus::codec::write(1, 40, &[0x4020, 0]);
    port.reply(&at_once(sealed(&target[..6])));
    device.hold().unwrap();
    assert_eq!(frames(&port)[2], target, "2.5 mm");
    assert!(device.emergency().is_empty());
}

#[test]
fn a_hangup_is_a_lost_line() {
    let (mut device, port, _) = device(CELL);
    port.reply(&[
        Scripted::After(0.01, float(1.0)[..4].to_vec()),
        Scripted::HangUp,
    ]);
    assert!(matches!(device.sample(), Err(DeviceFault::Lost { .. })));
}
