//! Tests of the emulated rig: motion of the actuators, forces on them, effect of faults.

use super::*;
use crate::testing::emulator::elastic_rig;
use psd_plan::Storey;

#[test]
fn it_moves_evenly_and_stops_at_its_target() {
    let mut rig = elastic_rig();
    rig.go(0.005, 0.002);
    rig.advance(1.0);
    assert!((rig.displacement() - 0.002).abs() < 1e-12 && rig.moving());
    assert!((rig.force() - 200.0).abs() < 1e-9);
    assert_eq!(rig.counts(), 1000 - 20_000);
    rig.advance(10.0);
    assert!((rig.displacement() - 0.005).abs() < 1e-12 && !rig.moving());
    rig.go(0.02, 1.0);
    rig.advance(10.1);
    rig.hold();
    rig.advance(20.0);
    assert!(
        (rig.displacement() - 0.006).abs() < 1e-12,
        "no faster than it can"
    );
    assert_eq!((rig.violations(), rig.targets().len()), (&[0.02][..], 2));
    assert_eq!(
        rig.moves()[1],
        SentMove {
            time: 10.0,
            id: None,
            actuators: vec![0],
            targets: vec![0.02],
            speed: 0.01
        }
    );
    rig.refuse(f64::NAN);
    assert_eq!(rig.violations().len(), 2, "what is no number is outside");
}

#[test]
fn friction_stays_at_rest_and_viscous_damping_does_not() {
    let mut rig = elastic_rig().with_friction(3.0);
    assert_eq!(rig.force(), 0.0, "not before the first motion");
    rig.go(0.005, 0.01);
    rig.advance(1.0);
    assert!((rig.force() - 503.0).abs() < 1e-9);
    rig.go(0.004, 0.01);
    rig.advance(2.0);
    assert!(
        (rig.force() - 397.0).abs() < 1e-9,
        "it is against the last motion"
    );
}

/// Sends the emulated rig to 5 mm and reads it a second after `fault` started: displacement in mm, force in N.
fn after(fault: MechanicalFault) -> (f64, f64) {
    let mut rig = elastic_rig();
    rig.strike(0, fault);
    rig.go(0.005, 0.01);
    for tick in 1..=100 {
        rig.advance(f64::from(tick) * 0.01);
    }
    assert!(!rig.moving(), "the controller takes it for done");
    (rig.displacement() * 1e3, rig.force())
}

#[test]
fn each_fault_spoils_what_it_names() {
    let near = |found: (f64, f64), expected: (f64, f64)| {
        assert!(
            (found.0 - expected.0).abs() < 2e-3 && (found.1 - expected.1).abs() < 0.2,
            "{found:?} is not {expected:?}"
        );
    };
    near(after(MechanicalFault::Reach(0.4)), (2.0, 200.0));
    near(after(MechanicalFault::Reach(0.0)), (0.0, 0.0));
    // A ramp of 0.5 s with a lag of 0.2 s is short by v τ (1 − e^(−T/τ)) at its end, times e^(−t/τ) half a second later.
    let short = 10.0 * 0.2 * (1.0 - f64::exp(-2.5)) * f64::exp(-2.5);
    let (lagging, _) = after(MechanicalFault::Lag(0.2));
    assert!((lagging - (5.0 - short)).abs() < 0.01, "{lagging} mm");
    near(after(MechanicalFault::ScaleForce(-1.0)), (5.0, -500.0));
    near(
        after(MechanicalFault::ScaleDisplacement(25.4)),
        (127.0, 500.0),
    );
    near(after(MechanicalFault::ClipForce(350.0)), (5.0, 350.0));
    near(after(MechanicalFault::Drift(3.0)), (5.0, 503.0));
    near(
        after(MechanicalFault::DriftDisplacement(2e-4)),
        (5.2, 500.0),
    );
    near(after(MechanicalFault::Spike(70.0)), (5.0, 570.0));
    near(
        after(MechanicalFault::Fracture {
            displacement: 0.003,
            left: 0.1,
        }),
        (5.0, 50.0),
    );
}

#[test]
fn a_frozen_sensor_stays_and_a_spike_passes() {
    let mut rig = elastic_rig();
    rig.strike(0, MechanicalFault::FreezeForce);
    rig.strike(0, MechanicalFault::Spike(7.0));
    assert_eq!(rig.force(), 7.0);
    rig.go(0.005, 0.01);
    rig.advance(1.0);
    assert_eq!((rig.force(), rig.readings()), (7.0, 2));
    rig.strike(0, MechanicalFault::Number("OVL".to_owned()));
    assert_eq!(rig.shown_force(0, "1.0".to_owned()), "OVL");
    assert_eq!(rig.shown_force(0, "1.0".to_owned()), "1.0");
}

#[test]
fn a_random_fault_occurs_about_as_often_as_specified() {
    let mut rig = elastic_rig();
    rig.strike_by_chance(0, MechanicalFault::Spike(100.0), 0.1);
    let spikes = (0..10_000).filter(|_| rig.force() == 100.0).count();
    assert!(
        (850..1150).contains(&spikes),
        "{spikes} of 10 000, expected 1000 with a deviation of 30"
    );
}

const ACTUATOR: ActuatorSettings = ActuatorSettings {
    sign: 1.0,
    noise: 0.0,
    resolution: 0.0,
    limits: Interval {
        low: -0.01,
        high: 0.01,
    },
};

/// Storeys of 3 kN/m and 2 kN/m, the upper one yielding at 4 N.
fn frame() -> Frame {
    let yielding = Behaviour::Bilinear {
        stiffness: 2000.0,
        yield_force: 4.0,
        post_yield_ratio: 0.0,
    };
    Frame::of_storeys(vec![
        Storey::new(1.0, 3000.0, Behaviour::Elastic { stiffness: 3000.0 }),
        Storey::new(1.0, 2000.0, yielding),
    ])
}

#[test]
fn actuators_of_a_frame_arrive_together_and_measure_differences_of_storey_shears() {
    let settings = elastic_rig().settings().clone();
    let mut rig = EmulatedRig::of_frame(settings.clone(), &frame(), &[ACTUATOR, ACTUATOR]);
    rig.go_as(Some(1), &[0.001, 0.002], 0.01);
    rig.advance(0.1);
    // Half of the move: storey drifts of half a millimetre, shears 1.5 N and 1 N.
    assert!(
        (rig.commanded_of(0) - 0.0005).abs() < 1e-15 && (rig.commanded_of(1) - 0.001).abs() < 1e-15
    );
    assert!((rig.force_of(0) - 0.5).abs() < 1e-12 && (rig.force_of(1) - 1.0).abs() < 1e-12);
    rig.advance(0.21);
    assert!(!rig.moving());
    // A storey drift of 4 mm yields at 4 N.
    rig.go_as(Some(2), &[0.001, 0.005], 0.01);
    rig.advance(1.0);
    assert!((rig.force_of(0) + 1.0).abs() < 1e-12 && (rig.force_of(1) - 4.0).abs() < 1e-12);
    assert_eq!(
        (rig.readings(), rig.targets().len()),
        (2, 4),
        "readings of the first ram"
    );
    rig.go_as(Some(3), &[0.0, 0.02], 0.01);
    assert_eq!(rig.violations(), [0.02]);
    let turned = ActuatorSettings {
        sign: -1.0,
        ..ACTUATOR
    };
    let matrix = Frame {
        storeys: Vec::new(),
        ..frame()
    };
    let mut rig = EmulatedRig::of_frame(settings, &matrix, &[ACTUATOR, turned]);
    rig.go_as(None, &[0.001, -0.005], 0.01);
    rig.advance(1.0);
    // K = [5, −2; −2, 2] kN/m at (1, 5) mm. The second actuator has the opposite polarity.
    assert!((rig.force_of(0) + 5.0).abs() < 1e-12 && (rig.force_of(1) + 8.0).abs() < 1e-12);
}

/// A target on the line is a rounded number: an actuator that stays can have one that differs by the last digit.
#[test]
fn a_distance_within_the_rounding_of_a_position_is_no_move() {
    let start = 0.000_300_000_000_000_000_03;
    let mut rig = EmulatedRig::of_frame(
        elastic_rig().settings().clone(),
        &frame(),
        &[ACTUATOR, ACTUATOR],
    )
    .resting_at(&[0.0, start]);
    assert_ne!(start, 0.0003);
    rig.go_as(None, &[0.001, 0.0003], 0.01);
    for step in 1..=20 {
        rig.advance(0.01 * f64::from(step));
    }
    assert!(!rig.moving());
    assert_eq!((rig.commanded_of(0), rig.commanded_of(1)), (0.001, 0.0003));
}

#[test]
fn each_actuator_has_its_own_faults_and_noise() {
    let noisy = ActuatorSettings {
        noise: 1.0,
        ..ACTUATOR
    };
    let mut rig =
        EmulatedRig::of_frame(elastic_rig().settings().clone(), &frame(), &[noisy, noisy]);
    assert_ne!(rig.force_of(0), rig.force_of(1));
    rig.strike(1, MechanicalFault::FreezeForce);
    let frozen = rig.force_of(1);
    assert!(rig.force_of(1) == frozen && rig.force_of(0) != rig.force_of(0));
}

/// 100 kN/m at 1 mm, in parallel with 50 kN/m of 2 s, after 0.1 s at 10 mm/s: as in a simulated rig, whatever the time steps.
#[test]
fn relaxation_beside_a_specimen_is_measured_also_at_rest() {
    let of = Box::new(Behaviour::Elastic { stiffness: 1e5 });
    let behaviour = Behaviour::Maxwell {
        of,
        stiffness: 5e4,
        time_constant: 2.0,
    };
    let mut relaxing = EmulatedRig::new(EmulatedRigSettings {
        behaviour,
        noise: 0.0,
        damping: 0.0,
        ..elastic_rig().settings().clone()
    });
    relaxing.go(0.001, 0.01);
    for tick in 1..=40 {
        relaxing.advance(f64::from(tick) * 0.025);
    }
    let held = 5e4 * 0.01 * 2.0 * (1.0 - f64::exp(-0.05)) * f64::exp(-0.45);
    assert!(
        (relaxing.force() - 100.0 - held).abs() < 1e-9,
        "{} N",
        relaxing.force()
    );
}
