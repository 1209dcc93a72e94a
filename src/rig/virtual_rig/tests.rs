//! The virtual rig of one degree of freedom: moves, settling, strokes and the readings of its load cell, against numbers
//! calculated by hand.

use super::*;
use psd_plan::Behaviour;

pub(super) const AT_ONCE: Settle = Settle {
    band: 0.0,
    force_rate: 0.0,
    dwell: 0.0,
    timeout: 60.0,
};

pub(super) fn specimen(damping: f64, coulomb: f64) -> Specimen {
    let behaviour = Some(Behaviour::Elastic { stiffness: 1000.0 });
    Specimen {
        damping,
        coulomb,
        ..Specimen::new("spring", 1.0, behaviour)
    }
}

fn rig(link: VirtualLink) -> VirtualRig {
    VirtualRig::new(link, AT_ONCE, Some(&specimen(0.0, 0.0)), 1.0)
}

/// A move that was interrupted when a reading was due is continued: the reading is made again, and it includes the force of a moving
/// damper.
#[test]
fn a_lost_reading_is_repeated_during_the_motion() {
    /// Accepts `most` readings, and is killed at the next one.
    fn up_to(read: &mut Vec<f64>, most: usize) -> impl FnMut(Reading) -> Result<(), RigFault> {
        move |reading| {
            if read.len() == most {
                return Err(RigFault::Device("killed".to_owned()));
            }
            read.push(reading.force[0]);
            Ok(())
        }
    }
    let damped = || {
        VirtualRig::new(
            VirtualLink::default(),
            AT_ONCE,
            Some(&specimen(50.0, 0.25)),
            1.0,
        )
    };
    let (mut whole, mut parts) = (Vec::new(), Vec::new());
    damped()
        .traverse(&[2e-3], 0.01, 4, &mut up_to(&mut whole, 4))
        .unwrap();
    let mut rig = damped();
    assert!(
        rig.traverse(&[2e-3], 0.01, 4, &mut up_to(&mut parts, 2))
            .is_err()
    );
    let cut_off = CutOff {
        from: &[0.0],
        to: &[2e-3],
        samples: 4,
        done: 2,
    };
    rig.traverse_on(&cut_off, 0.01, &mut up_to(&mut parts, 4))
        .unwrap();
    assert_eq!(parts, whole);
}

/// Moves at 10 mm/s and reads: time, displacement, force.
fn go(rig: &mut VirtualRig, target: f64) -> (f64, f64, f64) {
    rig.propose(&[target], Some(0.01)).unwrap();
    rig.execute().unwrap();
    let reading = rig.read().unwrap();
    (reading.time, reading.displacement[0], reading.force[0])
}

#[test]
fn an_ideal_rig_is_at_its_target_after_the_time_of_the_move() {
    let mut rig = rig(VirtualLink::default());
    assert_eq!(go(&mut rig, 0.002), (0.2, 0.002, 2.0));
    rig.pause(1.0).unwrap();
    assert_eq!(rig.time(), 1.2);
    rig.propose(&[0.0], None).unwrap();
    rig.execute().unwrap();
    assert_eq!(rig.time(), 1.2 + 0.002 / OWN_SPEED);
}

#[test]
fn tracking_resolution_and_drift_change_a_reading_as_computed_by_hand() {
    let (_, x, r) = go(
        &mut rig(VirtualLink {
            tracking: 0.1,
            ..VirtualLink::default()
        }),
        0.002,
    );
    assert!((x - 0.0018).abs() < 1e-15 && (r - 1.8).abs() < 1e-12);
    // The cell measures the force at the true position; the resolution applies to the displacement reading.
    let (_, x, r) = go(
        &mut rig(VirtualLink {
            resolution: 5e-4,
            ..VirtualLink::default()
        }),
        0.0013,
    );
    assert!((x - 0.0015).abs() < 1e-15 && (r - 1.3).abs() < 1e-12);
    let (_, _, r) = go(
        &mut rig(VirtualLink {
            force_resolution: 0.5,
            ..VirtualLink::default()
        }),
        0.0013,
    );
    assert_eq!(r, 1.5);
    // 0.2 s at 3 N/s.
    let (_, _, r) = go(
        &mut rig(VirtualLink {
            drift: 3.0,
            ..VirtualLink::default()
        }),
        0.002,
    );
    assert!((r - 2.6).abs() < 1e-12);
}

#[test]
fn lag_is_v_tau_behind_at_the_end_of_a_move_and_a_pause_lets_it_in() {
    let mut rig = rig(VirtualLink {
        lag: 0.02,
        ..VirtualLink::default()
    });
    let behind = 0.01 * 0.02 * (1.0 - (-10.0_f64).exp());
    let (_, x, r) = go(&mut rig, 0.002);
    assert!((x - (0.002 - behind)).abs() < 1e-15 && (r - 1000.0 * x).abs() < 1e-12);
    rig.pause(0.04).unwrap();
    let x = rig.read().unwrap().displacement[0];
    assert!((x - (0.002 - behind * (-2.0_f64).exp())).abs() < 1e-15);
}

#[test]
fn settling_takes_rig_time_and_a_rig_that_cannot_settle_holds() {
    let settle = Settle {
        band: 1e-5,
        force_rate: 0.0,
        dwell: 0.3,
        timeout: 10.0,
    };
    let link = VirtualLink {
        lag: 0.02,
        ..VirtualLink::default()
    };
    let mut settling = VirtualRig::new(link, settle, Some(&specimen(0.0, 0.0)), 1.0);
    let (time, x, _) = go(&mut settling, 0.002);
    let behind = 0.01 * 0.02 * (1.0 - (-10.0_f64).exp());
    assert!((time - (0.2 + 0.02 * (behind / 1e-5).ln() + 0.3)).abs() < 1e-12);
    assert!((0.002 - x) < 1e-5);
    // 10 % of 2 mm is 0.2 mm: permanently outside 0.01 mm.
    let link = VirtualLink {
        tracking: 0.1,
        ..VirtualLink::default()
    };
    let mut never = VirtualRig::new(link, settle, Some(&specimen(0.0, 0.0)), 1.0);
    never.propose(&[0.002], Some(0.01)).unwrap();
    assert_eq!(
        never.execute(),
        Err(RigFault::NotSettled {
            timeout: 10.0,
            axis: None
        })
    );
    assert!((never.time() - 10.18).abs() < 1e-12);
}

#[test]
fn damping_shows_while_moving_and_friction_stays_through_a_pause() {
    let mut rig = VirtualRig::new(
        VirtualLink::default(),
        AT_ONCE,
        Some(&specimen(50.0, 0.25)),
        1.0,
    );
    assert_eq!(rig.read().unwrap().force, [0.0]);
    let mut readings = Vec::new();
    rig.traverse(&[0.002], 0.01, 4, &mut |reading| {
        readings.push(reading);
        Ok(())
    })
    .unwrap();
    let forces: Vec<f64> = readings.iter().map(|reading| reading.force[0]).collect();
    for (force, by_hand) in forces.iter().zip([0.5, 1.0, 1.5, 2.0]) {
        assert!(
            (force - (by_hand + 50.0 * 0.01 + 0.25)).abs() < 1e-12,
            "{forces:?}"
        );
    }
    assert!((readings[1].time - 0.1).abs() < 1e-15);
    rig.pause(5.0).unwrap();
    assert!((rig.read().unwrap().force[0] - 2.25).abs() < 1e-12);
    assert!((go(&mut rig, 0.001).2 - 0.75).abs() < 1e-12);
    assert!(
        rig.traverse(&[0.002], -0.01, 4, &mut |_| Ok(())).is_err(),
        "away from the target"
    );
}

#[test]
fn a_negative_sign_turns_displacement_and_force_between_plan_and_rig() {
    let link = VirtualLink {
        drift: 3.0,
        ..VirtualLink::default()
    };
    let mut turned = VirtualRig::new(link, AT_ONCE, Some(&specimen(0.0, 0.0)), -1.0);
    let (_, x, r) = go(&mut turned, 0.002);
    // Only the errors that the rig itself adds show its polarity.
    assert!(x == 0.002 && (r - (2.0 - 0.6)).abs() < 1e-12);
}

#[test]
fn refuses_what_it_cannot_do() {
    let mut rig = rig(VirtualLink::default());
    assert!(rig.propose(&[0.0, 0.0], None).is_err());
    assert!(rig.propose(&[f64::NAN], None).is_err());
    assert!(rig.propose(&[0.001], Some(0.0)).is_err());
    assert!(rig.execute().is_err(), "nothing was proposed");
}

/// In one call or in four, an ideal rig is at the same place at the same time with the same force: its reading.
pub(super) fn step_in_one_call_or_four(
    once: &mut VirtualRig,
    stepwise: &mut VirtualRig,
    targets: &[f64],
) -> Reading {
    assert!(once.is_ideal());
    let mut reading = once.read().unwrap();
    let whole = once.at_once().expect("an ideal rig");
    whole.step(targets, Some(0.01), 0.5, &mut reading).unwrap();
    stepwise.propose(targets, Some(0.01)).unwrap();
    stepwise.execute().unwrap();
    stepwise.pause(0.5).unwrap();
    assert_eq!(reading, stepwise.read().unwrap());
    assert_eq!(once.read_moved().unwrap(), stepwise.read_moved().unwrap());
    reading
}

/// A damper has no force at rest; the next stroke measures it.
#[test]
fn an_ideal_rig_reads_its_targets_and_the_forces_there() {
    let rate = Behaviour::Rate {
        of: Box::new(Behaviour::Elastic { stiffness: 1000.0 }),
        reference_velocity: 0.01,
        exponent: 1.0,
    };
    let faster = Specimen {
        behaviour: Some(rate),
        ..specimen(0.0, 0.0)
    };
    // The force at 1 mm, reached at 10 mm/s.
    for (specimen, moving) in [
        (specimen(0.0, 0.0), 1.0),
        (specimen(50.0, 0.0), 1.5),
        (faster, 2.0),
    ] {
        let ideal = || VirtualRig::new(VirtualLink::default(), AT_ONCE, Some(&specimen), 1.0);
        let (mut once, mut stepwise) = (ideal(), ideal());
        for target in [1e-3, -2e-3, -2e-3, 0.5e-3] {
            let reading = step_in_one_call_or_four(&mut once, &mut stepwise, &[target]);
            assert_eq!(
                (reading.displacement[0], reading.force[0]),
                (target, 1000.0 * target)
            );
        }
        for rig in [&mut once, &mut stepwise] {
            rig.traverse(&[1e-3], 0.01, 1, &mut |reading| {
                assert!((reading.force[0] - moving).abs() < 1e-12);
                Ok(())
            })
            .unwrap();
        }
    }
}

/// An error, a lag, friction or a turned polarity makes a rig one that is not ideal.
#[test]
fn a_rig_with_errors_is_not_ideal() {
    let ideal = VirtualLink::default();
    let links = [
        VirtualLink {
            noise: 1.0,
            ..ideal
        },
        VirtualLink {
            resolution: 1e-6,
            ..ideal
        },
        VirtualLink {
            force_resolution: 0.1,
            ..ideal
        },
        VirtualLink {
            drift: 0.1,
            ..ideal
        },
        VirtualLink { lag: 0.1, ..ideal },
        VirtualLink {
            tracking: 0.1,
            ..ideal
        },
    ];
    for link in links {
        assert!(!rig(link).is_ideal(), "{link:?}");
    }
    let others = [(specimen(0.0, 5.0), 1.0), (specimen(0.0, 0.0), -1.0)];
    for (specimen, sign) in others {
        let mut rig = VirtualRig::new(ideal, AT_ONCE, Some(&specimen), sign);
        assert!(!rig.is_ideal());
    }
}
