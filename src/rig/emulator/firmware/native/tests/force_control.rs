//! The second axis of a native rig in force control, on a column of 3 m and 100 kN/m.

use super::*;
use crate::emulator::{ActuatorSettings, MechanicalFault};
use psd_plan::{AxialColumn, Behaviour, Frame, Storey};

const LIMITS: &str = "LIM 2 -10 10 -2000 12000 -1 1 -50000 50000 10";
const FORCE: &str = "FORCE 3 0 0 5000 100";

fn column() -> (Native, EmulatedRig) {
    let settings = elastic_rig().settings().clone();
    let behaviour = Behaviour::Elastic { stiffness: 1e5 };
    let frame = Frame::of_storeys(vec![Storey::new(1.0, 1e5, behaviour)]);
    let actuator = |limit: f64| ActuatorSettings {
        sign: 1.0,
        noise: 0.0,
        resolution: 0.0,
        limits: Interval {
            low: -limit,
            high: limit,
        },
    };
    let axial = AxialColumn {
        tested: 0,
        height: 3.0,
        p_delta: 1.0,
    };
    let emulated = EmulatedRig::of_frame(settings, &frame, &[actuator(0.02)])
        .with_axial(&[(actuator(0.004), axial)]);
    let settings = NativeSettings {
        boot: Some(0x7f3a),
        force_limits: vec![
            Interval {
                low: -80_000.0,
                high: 80_000.0,
            };
            2
        ],
        ..Default::default()
    };
    (Native::new(settings, &emulated), emulated)
}

/// At 10 kN.
fn loaded() -> (Native, EmulatedRig) {
    let mut rig = column();
    for request in ["HELLO 1", LIMITS, FORCE, "MOVE 4 1 0 10000 1"] {
        let answer = ask(&mut rig, request);
        assert!(answer.starts_with("ACK"), "{request}: {answer}");
    }
    pass(&mut rig, 2.5);
    rig
}

fn pass(rig: &mut (Native, EmulatedRig), seconds: f64) {
    let until = rig.1.time() + seconds;
    while rig.1.time() < until {
        rig.1.advance((rig.1.time() + 0.01).min(until));
        rig.0.tick(&mut rig.1);
    }
}

#[test]
fn a_force_grows_at_its_rate_and_leans_on_the_lateral_cell() {
    let mut rig = column();
    ask(&mut rig, "HELLO 1");
    ask(&mut rig, LIMITS);
    assert_eq!(ask(&mut rig, FORCE), "ACK 3 7F3A IDLE");
    assert_eq!(
        ask(&mut rig, "STAT 4"),
        "ACK 4 7F3A IDLE 0x0000",
        "not before a MOVE"
    );
    assert_eq!(ask(&mut rig, "MOVE 5 1 0 10000 1"), "ACK 5 7F3A MOVING");
    pass(&mut rig, 1.0);
    let reading = ask(&mut rig, "MEAS 6 1");
    assert!(
        reading.contains(" 5000.000 ") && reading.ends_with("0x0140 MOVING"),
        "{reading}"
    );
    pass(&mut rig, 1.5);
    assert_eq!(ask(&mut rig, "MOVE 7 2 6 10000 10"), "ACK 7 7F3A MOVING");
    pass(&mut rig, 1.0);
    // 600 N − 10 kN · 6 mm / 3 m = 580 N; (6 mm)² / 6 m = 6 µm.
    let reading = ask(&mut rig, "MEAS 8 1");
    assert!(reading.contains(" 6.000000 580.000 "), "{reading}");
    assert!(
        reading.contains(" 0.006000 10000.000 ") && reading.ends_with("0x0100 IDLE"),
        "{reading}"
    );
}

#[test]
fn a_hold_a_silent_host_and_hello_keep_the_force() {
    let mut rig = loaded();
    ask(&mut rig, "MOVE 5 2 0 20000 1");
    pass(&mut rig, 1.0);
    assert_eq!(ask(&mut rig, "STOP 6"), "ACK 6 7F3A HELD");
    pass(&mut rig, 60.0);
    let keeps_the_force = |rig: &EmulatedRig| (rig.axial_force(1).unwrap() - 15_000.0).abs() < 1e-6;
    assert!(keeps_the_force(&rig.1));
    assert_eq!(ask(&mut rig, "STAT 7"), "ACK 7 7F3A HELD 0x0180");
    let hello = ask(&mut rig, "HELLO 1");
    assert!(hello.ends_with(" 2 0.000000 20000.000"), "{hello}");
    assert_eq!(ask(&mut rig, "CLR 2"), "ACK 2 7F3A IDLE");
    assert_eq!(ask(&mut rig, "STAT 3"), "ACK 3 7F3A IDLE 0x0100");
    assert!(keeps_the_force(&rig.1));
    // The band of a run stays in force: 1 mm, where the rig has 4 mm.
    rig.1.strike(1, MechanicalFault::DriftDisplacement(1e-3));
    pass(&mut rig, 1.1);
    assert_eq!(ask(&mut rig, "STAT 4"), "ACK 4 7F3A HELD 0x0200");
}

#[test]
fn without_cell_or_outside_the_band_the_displacement_is_held() {
    for (fault, flags) in [
        (MechanicalFault::DriftDisplacement(-5e-3), "0x0200"),
        (MechanicalFault::ScaleForce(0.0), "0x0400"),
        (MechanicalFault::Drift(500.0), "0x0400"),
    ] {
        let mut rig = loaded();
        ask(&mut rig, "MOVE 5 2 9 10000 1");
        rig.1.strike(1, fault);
        pass(&mut rig, 1.0);
        assert_eq!(ask(&mut rig, "STAT 6"), format!("ACK 6 7F3A HELD {flags}"));
        assert!(
            !rig.1.moving() && rig.1.commanded_of(0) < 5e-3,
            "all axes hold"
        );
        assert_eq!(rig.1.axial_force(1), Some(10_000.0));
        assert_eq!(ask(&mut rig, "MOVE 7 3 0 10000 1"), "ERR 7 7F3A HELD");
        assert_eq!(ask(&mut rig, "CLR 8"), "ACK 8 7F3A IDLE");
        assert_eq!(ask(&mut rig, "STAT 9"), "ACK 9 7F3A IDLE 0x0000");
    }
}

#[test]
fn what_it_cannot_do_is_refused() {
    let mut rig = loaded();
    for (number, request, answer) in [
        (5, "FORCE 0 0 0 0", "ERR 5 7F3A ARG 2"),
        (6, "FORCE 0 0 5000", "ERR 6 7F3A ARG"),
        (7, "FORCE 100 1 5000 100", "ERR 7 7F3A ARG 1"),
        (8, "MOVE 9 0 50001 1", "ERR 8 7F3A LIMIT 2"),
        (9, "GLIDE 9 0 0 10000 0 100", "ERR 9 7F3A VERB"),
        (10, "FORCE 0 0 2500 50", "ACK 10 7F3A IDLE"),
    ] {
        let (verb, words) = request.split_once(' ').unwrap();
        assert_eq!(ask(&mut rig, &format!("{verb} {number} {words}")), answer);
    }
    // After power-up its column holds it where it is.
    rig.0.reboot(&mut rig.1);
    ask(&mut rig, "HELLO 1");
    ask(&mut rig, "REF 2 A-Tester");
    let moved = ask(&mut rig, "MOVE 3 1 0 0.5 1");
    assert!(moved.ends_with("LIMIT 2"), "{moved}");
    let moved = ask(&mut rig, "MOVE 4 1 1 0 1");
    assert!(moved.ends_with("MOVING"), "{moved}");
    assert_eq!(rig.1.axial_force(1), Some(10_000.0));
}
