//! The virtual rig of a frame: forces of the floors from the storey shears, load cells, settling, and smooth paths of all floors
//! together.

use super::tests::{AT_ONCE, step_in_one_call_or_four};
use super::*;
use psd_plan::{Behaviour, Storey};

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

fn rig(link: VirtualLink) -> VirtualRig {
    VirtualRig::of_frame(link, AT_ONCE, &frame(), 1.0)
}

fn go(rig: &mut VirtualRig, targets: [f64; 2]) -> Reading {
    rig.propose(&targets, Some(0.01)).unwrap();
    rig.execute().unwrap();
    rig.read().unwrap()
}

#[test]
fn forces_of_the_floors_are_differences_of_storey_shears() {
    // Drifts 1 mm and 1 mm: shears 3 N and 2 N.
    let reading = go(&mut rig(VirtualLink::default()), [0.001, 0.002]);
    assert_eq!(
        (reading.time, reading.displacement),
        (0.2, vec![0.001, 0.002])
    );
    assert!((reading.force[0] - 1.0).abs() < 1e-12 && (reading.force[1] - 2.0).abs() < 1e-12);
    // A drift of 4 mm yields at 4 N.
    let reading = go(&mut rig(VirtualLink::default()), [0.001, 0.005]);
    assert!((reading.force[0] + 1.0).abs() < 1e-12 && (reading.force[1] - 4.0).abs() < 1e-12);
}

#[test]
fn a_full_matrix_gives_r_as_k_x() {
    let matrix = Frame {
        storeys: Vec::new(),
        ..frame()
    };
    let mut rig = VirtualRig::of_frame(VirtualLink::default(), AT_ONCE, &matrix, -1.0);
    let reading = go(&mut rig, [0.001, 0.005]);
    // K = [5, −2; −2, 2] kN/m.
    assert!(
        (reading.force[0] + 5.0).abs() < 1e-12 && (reading.force[1] - 8.0).abs() < 1e-12,
        "{:?}",
        reading.force
    );
}

#[test]
fn every_load_cell_has_a_noise_of_its_own_that_repeats_by_seed() {
    let forces = |seed| {
        go(
            &mut rig(VirtualLink {
                noise: 1.0,
                seed,
                ..VirtualLink::default()
            }),
            [0.0, 0.0],
        )
        .force
    };
    let (first, again) = (forces(7), forces(7));
    assert_eq!(first, again);
    assert_ne!(first[0], first[1]);
    assert_ne!(first, forces(8));
}

#[test]
fn lag_and_tracking_are_each_axes_own() {
    let reading = go(
        &mut rig(VirtualLink {
            tracking: 0.1,
            ..VirtualLink::default()
        }),
        [0.001, -0.002],
    );
    assert!(
        (reading.displacement[0] - 0.0009).abs() < 1e-15
            && (reading.displacement[1] + 0.0018).abs() < 1e-15
    );
    // 0.2 s of motion: the slower axis lags by half as much.
    let reading = go(
        &mut rig(VirtualLink {
            lag: 0.02,
            ..VirtualLink::default()
        }),
        [0.001, -0.002],
    );
    let behind = 0.01 * 0.02 * (1.0 - (-10.0_f64).exp());
    assert!((reading.displacement[1] + 0.002 - behind).abs() < 1e-15);
    assert!((reading.displacement[0] - 0.001 + 0.5 * behind).abs() < 1e-15);
}

/// A branch of 1 kN/m and 2 s in the upper storey responds to the storey drift: 1 mm in 0.2 s. Strength that increases with speed
/// responds to the velocity of the storey drift while a lagging floor still moves.
#[test]
fn relaxation_and_rate_effects_are_measured_storey_by_storey() {
    let of = || Box::new(Behaviour::Elastic { stiffness: 2000.0 });
    let of_upper = |behaviour| {
        let lower = Storey::new(1.0, 3000.0, Behaviour::Elastic { stiffness: 3000.0 });
        Frame::of_storeys(vec![lower, Storey::new(1.0, 2000.0, behaviour)])
    };
    let relaxing = of_upper(Behaviour::Maxwell {
        of: of(),
        stiffness: 1000.0,
        time_constant: 2.0,
    });
    let mut rig = VirtualRig::of_frame(VirtualLink::default(), AT_ONCE, &relaxing, 1.0);
    let (reading, q) = (
        go(&mut rig, [0.001, 0.002]),
        1000.0 * 0.005 * 2.0 * (1.0 - f64::exp(-0.1)),
    );
    assert!(
        (reading.force[1] - 2.0 - q).abs() < 1e-12 && (reading.force[0] - 1.0 + q).abs() < 1e-12,
        "{reading:?}"
    );
    rig.pause(2.0).unwrap();
    assert!((rig.read().unwrap().force[1] - 2.0 - q / 1f64.exp()).abs() < 1e-12);
    let faster = of_upper(Behaviour::Rate {
        of: of(),
        reference_velocity: 0.01,
        exponent: 0.5,
    });
    let mut rig = VirtualRig::of_frame(
        VirtualLink {
            lag: 0.1,
            ..VirtualLink::default()
        },
        AT_ONCE,
        &faster,
        1.0,
    );
    let reading = go(&mut rig, [0.001, 0.003]);
    // Each floor moves at e/lag; the storey drift is 2 mm minus its lag, after 0.3 s of motion.
    let lagging = |travel: f64| travel / 0.3 * 0.1 * (1.0 - f64::exp(-3.0));
    let (drift, velocity) = (0.002 - lagging(0.002), lagging(0.002) / 0.1);
    let shear = 2000.0 * drift * (1.0 + (velocity / 0.01).sqrt());
    assert!(
        (reading.force[1] - shear).abs() < 1e-12,
        "{} N is not {shear} N",
        reading.force[1]
    );
    rig.pause(5.0).unwrap();
    assert!(
        (rig.read().unwrap().force[1] - 4.0).abs() < 1e-9,
        "at rest nothing of it is left"
    );
}

#[test]
fn refuses_what_it_cannot_do() {
    let mut rig = rig(VirtualLink::default());
    assert!(rig.propose(&[0.0], None).is_err());
    assert!(rig.propose(&[0.0, f64::NAN], None).is_err());
    assert!(rig.propose(&[0.0, 0.0], Some(0.0)).is_err());
    assert!(rig.execute().is_err(), "nothing was proposed");
    assert!(rig.traverse(&[0.0, 0.1], 0.01, 4, &mut |_| Ok(())).is_err());
}

/// Storeys of 3 kN/m and 2 kN/m, each in parallel with 1 kN/m that relaxes with 2 s. With the same drift of 1 mm in both, the force of
/// the lower floor is constant from the start, but each shear decreases by 0.5 N/s at first. The rate of both together decreases to 0.02
/// N/s after 2 ln 50 s.
#[test]
fn settles_when_every_storey_has_nearly_relaxed() {
    let relaxing = |stiffness| {
        let of = Box::new(Behaviour::Elastic { stiffness });
        Storey::new(
            1.0,
            stiffness,
            Behaviour::Maxwell {
                of,
                stiffness: 1000.0,
                time_constant: 2.0,
            },
        )
    };
    let frame = Frame::of_storeys(vec![relaxing(3000.0), relaxing(2000.0)]);
    let settle = Settle {
        band: 1e-6,
        force_rate: 0.02,
        dwell: 0.5,
        timeout: 60.0,
    };
    let waited = |settle: Settle| {
        let mut rig = VirtualRig::of_frame(VirtualLink::default(), settle, &frame, 1.0);
        // Fast, so that nothing relaxes during the motion.
        rig.propose(&[0.001, 0.002], Some(1e3)).unwrap();
        rig.execute().map(|()| rig.time())
    };
    let by_hand = 2.0 * (2.0 * 0.5_f64 / 0.02).ln() + settle.dwell;
    let found = waited(settle).unwrap();
    assert!(
        (found - by_hand).abs() < 1e-4,
        "{found} s, by hand {by_hand} s"
    );
    assert!(
        waited(Settle {
            force_rate: 0.0,
            ..settle
        })
        .unwrap()
            < 0.51,
        "a band alone does not ask"
    );
    assert_eq!(
        waited(Settle {
            timeout: 5.0,
            ..settle
        }),
        Err(RigFault::NotSettled {
            timeout: 5.0,
            axis: None
        })
    );
}

/// 3 kN/m with 50 N·s/m and this friction \[N\]; 2 kN/m with 20 N·s/m.
fn damped_rig(link: VirtualLink, friction: f64) -> VirtualRig {
    let storey = |stiffness, damping, coulomb| Storey {
        damping,
        coulomb,
        ..Storey::new(1.0, stiffness, Behaviour::Elastic { stiffness })
    };
    let frame = Frame::of_storeys(vec![
        storey(3000.0, 50.0, friction),
        storey(2000.0, 20.0, 0.0),
    ]);
    VirtualRig::of_frame(link, AT_ONCE, &frame, 1.0)
}

const LOWER: Path = Path {
    from: 0.0,
    to: 2e-3,
    start_velocity: 0.0,
    end_velocity: 0.03,
    seconds: 0.1,
};
const UPPER: Path = Path {
    from: 0.0,
    to: 1e-3,
    start_velocity: 0.0,
    end_velocity: -0.01,
    seconds: 0.1,
};

fn readings(link: VirtualLink, samples: usize) -> Vec<crate::Reading> {
    let (mut rig, mut readings) = (damped_rig(link, 0.25), Vec::new());
    rig.follow_paths_after(&[LOWER, UPPER], samples, 0, &mut |reading| {
        readings.push(reading);
        Ok(())
    })
    .unwrap();
    readings
}

/// Each storey resists its drift and drift velocity: k d + c ḋ + F_c sign ḋ. The force of a floor is that of its storey minus that of the
/// storey above.
#[test]
fn storeys_are_damped_at_the_velocity_of_their_drifts() {
    for reading in readings(VirtualLink::default(), 4) {
        let time = reading.time;
        let (x, y) = (LOWER.position(time), UPPER.position(time));
        let (v, w) = (LOWER.rate(time).velocity, UPPER.rate(time).velocity);
        assert!(
            (reading.displacement[0] - x).abs() < 1e-15
                && (reading.displacement[1] - y).abs() < 1e-15
        );
        let (first, second) = (
            3000.0 * x + 50.0 * v + 0.25 * v.signum(),
            2000.0 * (y - x) + 20.0 * (w - v),
        );
        assert!(
            (reading.force[0] - (first - second)).abs() < 1e-12,
            "{time} s: {reading:?}"
        );
        assert!(
            (reading.force[1] - second).abs() < 1e-12,
            "{time} s: {reading:?}"
        );
    }
}

/// Its dampers have no force at rest; the next stroke measures them.
#[test]
fn a_damped_frame_without_friction_is_ideal() {
    let ideal = VirtualLink::default();
    assert!(!damped_rig(ideal, 0.25).is_ideal());
    let (mut once, mut stepwise) = (damped_rig(ideal, 0.0), damped_rig(ideal, 0.0));
    for targets in [[1e-3, 3e-3], [-2e-3, 1e-3], [-2e-3, 1e-3], [2e-3, 2e-3]] {
        let reading = step_in_one_call_or_four(&mut once, &mut stepwise, &targets);
        let [lower, upper] = [3000.0 * targets[0], 2000.0 * (targets[1] - targets[0])];
        assert!(
            (reading.force[0] - (lower - upper)).abs() < 1e-12,
            "{reading:?}"
        );
        assert!((reading.force[1] - upper).abs() < 1e-12, "{reading:?}");
    }
    let paths = [LOWER, UPPER].map(|path| Path {
        from: 2e-3,
        to: path.to + 2e-3,
        ..path
    });
    let stroke = |rig: &mut VirtualRig| {
        let mut forces = Vec::new();
        rig.follow_paths_after(&paths, 1, 0, &mut |reading| {
            forces.push(reading.force);
            Ok(())
        })
        .unwrap();
        forces
    };
    let forces = stroke(&mut once);
    // Drifts of 4 mm and −1 mm, at 30 mm/s and −40 mm/s.
    let upper = -2.0 - 0.8;
    assert!(
        (forces[0][0] - (12.0 + 1.5 - upper)).abs() < 1e-12,
        "{forces:?}"
    );
    assert_eq!(forces, stroke(&mut stepwise));
}

#[test]
fn the_number_of_readings_is_of_no_account_to_a_lag() {
    let link = VirtualLink {
        lag: 0.02,
        tracking: 0.05,
        ..VirtualLink::default()
    };
    let (few, many) = (readings(link, 1), readings(link, 50));
    for axis in 0..2 {
        assert!((few[0].displacement[axis] - many[49].displacement[axis]).abs() < 1e-15);
        assert!((few[0].force[axis] - many[49].force[axis]).abs() < 1e-12);
    }
}

/// At rest the damper force is zero, and friction keeps the direction of the last motion.
#[test]
fn friction_stays_through_a_pause() {
    let mut rig = damped_rig(VirtualLink::default(), 0.25);
    rig.propose(&[1e-3, 1e-3], Some(0.01)).unwrap();
    rig.execute().unwrap();
    rig.pause(1.0).unwrap();
    assert!((rig.read().unwrap().force[0] - (3.0 + 0.25)).abs() < 1e-12);
    rig.propose(&[0.0, 0.0], Some(0.01)).unwrap();
    rig.execute().unwrap();
    assert!((rig.read().unwrap().force[0] + 0.25).abs() < 1e-12);
}

#[test]
fn paths_that_are_not_of_one_length_lead_nowhere() {
    let short = Path {
        seconds: 0.05,
        ..UPPER
    };
    assert!(
        damped_rig(VirtualLink::default(), 0.25)
            .follow_paths_after(&[LOWER, short], 4, 0, &mut |_| Ok(()))
            .is_err()
    );
    assert!(
        damped_rig(VirtualLink::default(), 0.25)
            .follow_paths_after(&[LOWER], 4, 0, &mut |_| Ok(()))
            .is_err()
    );
}
