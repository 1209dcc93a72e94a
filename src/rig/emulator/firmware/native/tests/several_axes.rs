//! The native firmware with two axes, and its smooth moves.

use super::*;
use crate::emulator::ActuatorSettings;
use psd_plan::{Behaviour, Frame, Storey};

/// Two actuators on storeys of 3 and 2 kN/m.
fn of_two() -> (Native, EmulatedRig) {
    let limits = |size: f64| ActuatorSettings {
        sign: 1.0,
        noise: 0.0,
        resolution: 0.0,
        limits: Interval {
            low: -size,
            high: size,
        },
    };
    let frame = Frame::of_storeys(vec![storey(3000.0), storey(2000.0)]);
    let emulated = EmulatedRig::of_frame(
        elastic_rig().settings().clone(),
        &frame,
        &[limits(0.005), limits(0.01)],
    );
    let force = |size: f64| Interval {
        low: -size,
        high: size,
    };
    let settings = NativeSettings {
        boot: Some(0x7f3a),
        force_limits: vec![force(100.0), force(50.0)],
        ..Default::default()
    };
    (Native::new(settings, &emulated), emulated)
}

fn storey(stiffness: f64) -> Storey {
    Storey::new(1.0, stiffness, Behaviour::Elastic { stiffness })
}

#[test]
fn two_axes_are_moved_by_one_request_and_read_by_one() {
    let mut rig = of_two();
    let bounds =
        "-5.000000 5.000000 -100.000 100.000 -10.000000 10.000000 -50.000 50.000 10.000000";
    assert_eq!(
        ask(&mut rig, "HELLO 1"),
        format!("ACK 1 7F3A PSD-SIM 0042 1.3 {bounds} 0 0.000000 0.000000")
    );
    assert_eq!(
        ask(&mut rig, "MOVE 2 1 1.000000 2.000000 1.000000"),
        "ACK 2 7F3A MOVING"
    );
    rig.1.advance(1.0);
    // Half of both moves: storey drifts of half a millimetre.
    let reading = ask(&mut rig, "MEAS 3 1");
    assert!(
        reading.contains(" 0.500000 0.500 ") && reading.contains(" 1.000000 1.000 "),
        "{reading}"
    );
    assert!(
        reading.contains(" 0x0040 ") && reading.ends_with(" MOVING"),
        "{reading}"
    );
    rig.1.advance(2.1);
    let reading = ask(&mut rig, "MEAS 4 3");
    assert!(
        reading.contains(" 1.000000 1.000 ")
            && reading.contains(" 2.000000 2.000 ")
            && reading.ends_with(" IDLE"),
        "{reading}"
    );
    assert_eq!(
        ask(&mut rig, "MOVE 5 1 1.000000 2.000000 1.000000"),
        "ACK 5 7F3A IDLE",
        "the same move again"
    );
    assert_eq!(
        ask(&mut rig, "MOVE 6 1 1.000000 2.100000 1.000000"),
        "ERR 6 7F3A ID"
    );
    assert_eq!(rig.1.moves().len(), 1);
    assert!(ask(&mut rig, "HELLO 1").ends_with(" 1 1.000000 2.000000"));
}

#[test]
fn of_two_axes_both_move_or_neither_and_one_hold_is_for_both() {
    let mut rig = of_two();
    ask(&mut rig, "HELLO 1");
    for (sequence, request, code) in [
        (2, "MOVE 2 1 1.000000 10.500000 1.000000", "LIMIT 2"),
        (3, "MOVE 3 1 -6.000000 1.000000 1.000000", "LIMIT 1"),
        (4, "MOVE 4 1 1.000000 1.000000", "ARG"),
        (
            5,
            "LIM 5 -1.000000 1.000000 -10.000 10.000 -11.000000 1.000000 -10.000 10.000 1.000000",
            "LIMIT 2",
        ),
        (6, "LIM 6 -1.000000 1.000000 -10.000 10.000 1.000000", "ARG"),
    ] {
        assert_eq!(
            ask(&mut rig, request),
            format!("ERR {sequence} 7F3A {code}"),
            "{request}"
        );
    }
    assert!(rig.1.moves().is_empty() && rig.1.violations() == [0.0105, -0.006]);
    ask(&mut rig, "MOVE 7 1 4.000000 -8.000000 1.000000");
    rig.1.advance(1.0);
    assert!(rig.0.receive(b"!", &mut rig.1).is_empty() && !rig.1.moving());
    assert_eq!(
        (rig.1.commanded_of(0), rig.1.commanded_of(1)),
        (0.0005, -0.001)
    );
    assert_eq!(ask(&mut rig, "STAT 8"), "ACK 8 7F3A HELD 0x0000");
}

#[test]
fn a_glide_is_passed_and_gone_on_from_until_the_next_one_or_the_hold() {
    let mut rig = of_two();
    ask(&mut rig, "HELLO 1");
    assert_eq!(
        ask(
            &mut rig,
            "GLIDE 2 1 1.000000 2.000000 -2.000000 -4.000000 1000.000"
        ),
        "ACK 2 7F3A MOVING 1000.000"
    );
    rig.1.advance(0.25);
    assert_eq!(
        ask(
            &mut rig,
            "GLIDE 3 2 2.000000 0.000000 -3.000000 0.000000 500.000"
        ),
        "ACK 3 7F3A MOVING 1250.000"
    );
    assert_eq!(
        ask(
            &mut rig,
            "GLIDE 4 3 2.000000 0.000000 -3.000000 0.000000 500.000"
        ),
        "ERR 4 7F3A BUSY"
    );
    assert_eq!(
        ask(&mut rig, "MOVE 5 3 2.000000 -3.000000 1.000000"),
        "ERR 5 7F3A BUSY"
    );
    rig.1.advance(1.0);
    assert!(
        (rig.1.commanded_of(0) - 1e-3).abs() < 1e-12
            && (rig.1.commanded_of(1) + 2e-3).abs() < 1e-12
    );
    rig.1.advance(1.5);
    assert_eq!(
        ask(&mut rig, "STAT 6"),
        "ACK 6 7F3A IDLE 0x0000",
        "it ended at rest"
    );
    assert_eq!(
        ask(
            &mut rig,
            "GLIDE 7 3 2.100000 0.500000 -3.000000 0.000000 200.000"
        ),
        "ACK 7 7F3A MOVING 200.000"
    );
    rig.1.advance(1.8);
    assert!(
        (rig.1.commanded_of(0) - 2.15e-3).abs() < 1e-12,
        "0.1 s behind its end, as fast as there"
    );
    assert_eq!(
        ask(
            &mut rig,
            "GLIDE 8 4 2.300000 0.500000 -3.000000 0.000000 50.000"
        ),
        "ERR 8 7F3A LATE"
    );
    assert_eq!(
        ask(
            &mut rig,
            "GLIDE 9 4 2.200000 0.500000 -3.000000 0.000000 200.000"
        ),
        "ACK 9 7F3A MOVING 100.000"
    );
    rig.1.advance(2.2);
    rig.0.tick(&mut rig.1);
    assert_eq!(
        ask(&mut rig, "STAT 10"),
        "ACK 10 7F3A HELD 0x0000",
        "no controller knows where to continue"
    );
    assert_eq!(
        ask(
            &mut rig,
            "GLIDE 11 5 2.200000 0.500000 -3.000000 0.000000 200.000"
        ),
        "ERR 11 7F3A HELD"
    );
    assert!(ask(&mut rig, "HELLO 1").ends_with(" 4 2.200000 -3.000000"));
}

#[test]
fn a_glide_is_checked_on_its_whole_path() {
    let mut rig = of_two();
    ask(&mut rig, "HELLO 1");
    // To 5.12 mm and back to 4 mm: one axis is limited to 5 mm, the other to 10 mm.
    for (sequence, request, answer) in [
        (
            2,
            "1 4.000000 -4.000000 0.000000 0.000000 3000.000",
            "ERR 2 7F3A LIMIT 1",
        ),
        (
            3,
            "1 0.000000 0.000000 4.000000 -4.000000 300.000",
            "ERR 3 7F3A RATE",
        ),
        (
            4,
            "1 0.000000 0.000000 4.000000 -4.000000",
            "ERR 4 7F3A ARG",
        ),
        (
            5,
            "1 0.000000 0.000000 4.000000 -4.000000 3000.000",
            "ACK 5 7F3A MOVING 3000.000",
        ),
        // After that one, where the other axis is at rest.
        (
            6,
            "1 0.000000 0.000000 4.000000 0.000000 3000.000",
            "ERR 6 7F3A ID",
        ),
        (
            7,
            "2 4.000000 -4.000000 4.000000 0.000000 3000.000",
            "ERR 7 7F3A LIMIT 1",
        ),
        (
            8,
            "2 0.000000 0.000000 4.000000 0.000000 3000.000",
            "ACK 8 7F3A MOVING 6000.000",
        ),
    ] {
        assert_eq!(
            ask(&mut rig, &format!("GLIDE {sequence} {request}")),
            answer
        );
    }
    assert_eq!(
        rig.1.violations().len(),
        2,
        "whoever asked for it is found out"
    );
}
