//! The guard on a scripted rig: nothing beyond a limit is proposed, and a reading beyond a limit holds the rig.

use super::*;
use crate::{DeclaredNoise, EachReading, EncodedMove, Identity};

/// Returns scripted readings, and records the calls.
#[derive(Default)]
struct Scripted {
    displacement: f64,
    /// Added to the displacement after a move.
    error: f64,
    force: f64,
    /// Added to a target when it is encoded.
    misspoken: f64,
    proposed: Vec<(f64, Option<f64>)>,
    held: bool,
}

impl Rig for Scripted {
    fn identity(&self) -> Identity {
        let nothing = String::new;
        Identity {
            name: nothing(),
            model: nothing(),
            serial: nothing(),
            firmware: nothing(),
            boot: None,
            simulated: true,
        }
    }
    fn degrees_of_freedom(&self) -> usize {
        1
    }
    fn time(&self) -> f64 {
        0.0
    }
    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<EncodedMove, RigFault> {
        self.proposed.push((targets[0], speed));
        let encoded = targets[0] + self.misspoken;
        Ok(EncodedMove {
            targets: vec![encoded],
            speed: speed.unwrap_or(0.0),
            wire: Vec::new(),
            move_id: None,
            at_the_rig: None,
        })
    }
    fn execute(&mut self) -> Result<(), RigFault> {
        self.displacement = self.proposed.last().unwrap().0 + self.error;
        Ok(())
    }
    fn pause(&mut self, _: f64) -> Result<(), RigFault> {
        Ok(())
    }
    fn read(&mut self) -> Result<Reading, RigFault> {
        Ok(Reading {
            time: 0.0,
            displacement: vec![self.displacement],
            force: vec![self.force],
            raw: Vec::new(),
        })
    }
    fn traverse(
        &mut self,
        _: &[f64],
        _: f64,
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        let force = |sample: usize| if sample < 2 { self.force } else { f64::NAN };
        let reading = |sample| Reading {
            time: 0.0,
            displacement: vec![0.0],
            force: vec![force(sample)],
            raw: Vec::new(),
        };
        (0..samples).map(reading).try_for_each(each)
    }
    fn hold(&mut self) {
        self.held = true;
    }
    fn declared_noise(&self) -> DeclaredNoise {
        DeclaredNoise::NONE
    }
}

const LIMITS: Limits = Limits {
    displacement: Interval {
        low: -0.002,
        high: 0.025,
    },
    force: Interval {
        low: -100.0,
        high: 100.0,
    },
    speed: Interval {
        low: 0.0,
        high: 0.01,
    },
    increment: Interval {
        low: 0.0,
        high: 0.001,
    },
    tracking_error: Interval {
        low: 0.0,
        high: 1e-4,
    },
    energy_error: Interval {
        low: 0.0,
        high: 0.05,
    },
    ..Limits::NONE
};

fn quantity(fault: RigFault) -> LimitedQuantity {
    match fault {
        RigFault::LimitBreached { quantity, .. } => quantity,
        other => panic!("{other:?}"),
    }
}

/// The limit that one move exceeds; the move must not be proposed.
fn refused(target: f64, speed: Option<f64>) -> LimitedQuantity {
    let mut rig = Scripted::default();
    let fault = Guard::new(&mut rig, LIMITS, Vec::new())
        .unwrap()
        .move_to(&[target], speed)
        .unwrap_err();
    assert!(
        rig.proposed.is_empty(),
        "nothing beyond a limit is proposed"
    );
    assert!(rig.held);
    quantity(fault)
}

#[test]
fn targets_increments_and_speeds_beyond_a_limit_are_never_proposed() {
    assert_eq!(refused(-0.003, None), LimitedQuantity::TargetDisplacement);
    assert_eq!(refused(f64::NAN, None), LimitedQuantity::TargetDisplacement);
    assert_eq!(refused(0.0015, None), LimitedQuantity::Increment);
    assert_eq!(refused(0.001, Some(0.02)), LimitedQuantity::Speed);
    assert_eq!(refused(0.001, Some(f64::NAN)), LimitedQuantity::Speed);
}

#[test]
fn the_decoded_targets_are_checked_against_the_limits_too() {
    // 25 mm is allowed; the encoded value would be larger because of rounding.
    let mut rig = Scripted {
        displacement: 0.0248,
        misspoken: 3e-4,
        ..Scripted::default()
    };
    let fault = Guard::new(&mut rig, LIMITS, Vec::new())
        .unwrap()
        .move_to(&[0.0249], None)
        .unwrap_err();
    assert_eq!(quantity(fault), LimitedQuantity::TargetDisplacement);
    assert!(rig.held && rig.displacement == 0.0248, "not carried out");
}

#[test]
fn what_was_refused_or_carried_out_is_not_carried_out_again() {
    let mut rig = Scripted::default();
    let mut guard = Guard::new(&mut rig, LIMITS, Vec::new()).unwrap();
    assert!(guard.execute().is_err(), "nothing was proposed");
    guard.propose(&[0.0005], None).unwrap();
    assert_eq!(guard.commanded(), [0.0], "nothing moved yet");
    assert!(guard.propose(&[0.03], None).is_err());
    assert!(
        guard.execute().is_err(),
        "the proposal before it is forgotten"
    );
    guard.propose(&[0.0005], None).unwrap();
    guard.hold();
    assert!(guard.execute().is_err(), "held in between");
    guard.propose(&[0.0005], None).unwrap();
    guard.execute().unwrap();
    assert_eq!(guard.commanded(), [0.0005]);
    assert!(guard.execute().is_err());
    assert_eq!(rig.displacement, 0.0005);
}

#[test]
fn without_limits_a_target_that_is_no_number_still_never_passes() {
    for target in [f64::NAN, f64::INFINITY] {
        let mut rig = Scripted::default();
        assert!(
            Guard::new(&mut rig, Limits::NONE, Vec::new())
                .unwrap()
                .move_to(&[target], None)
                .is_err()
        );
        assert!(rig.held && rig.proposed.is_empty());
    }
}

#[test]
fn a_reading_that_is_no_number_or_beyond_a_limit_holds_the_rig() {
    for (force, error, expected) in [
        (f64::NAN, 0.0, LimitedQuantity::Force),
        (101.0, 0.0, LimitedQuantity::Force),
        (0.0, f64::NAN, LimitedQuantity::MeasuredDisplacement),
        (0.0, 2e-4, LimitedQuantity::TrackingError),
    ] {
        let mut rig = Scripted {
            error,
            ..Scripted::default()
        };
        let mut guard = Guard::new(&mut rig, LIMITS, Vec::new()).unwrap();
        guard.move_to(&[0.001], None).unwrap();
        rig.force = force;
        let (commanded, own, going, holds, speed) =
            (vec![0.001], Vec::new(), Vec::new(), None, None);
        let (settled, proposed, last_contact, found) = (true, None, 0.0, (Vec::new(), Vec::new()));
        let mut guard = Guard {
            rig: &mut rig,
            limits: LIMITS,
            own,
            commanded,
            going,
            settled,
            proposed,
            speed,
            last_contact,
            holds,
            found,
            broken: None,
            axial: AxialAxes::default(),
        };
        assert_eq!(quantity(guard.read().unwrap_err()), expected);
        assert!(rig.held);
    }
    let mut rig = Scripted {
        force: f64::NAN,
        ..Scripted::default()
    };
    assert!(Guard::new(&mut rig, Limits::NONE, Vec::new()).is_err());
}

#[test]
fn the_bound_itself_is_inside_and_rounding_of_an_increment_is_not_held_against_it() {
    let mut rig = Scripted::default();
    let mut guard = Guard::new(&mut rig, LIMITS, Vec::new()).unwrap();
    for step in 1..=25 {
        guard
            .move_to(&[f64::from(step) * 0.001], Some(0.01))
            .unwrap();
    }
    assert_eq!(guard.commanded(), [0.025]);
    assert_eq!(guard.increments_to(&[0.0]).len(), 25);
    for target in guard.increments_to(&[0.0]) {
        guard.move_to(&target, None).unwrap();
    }
    assert_eq!(
        rig.proposed.last(),
        Some(&(0.0, Some(0.01))),
        "the limit is the speed where none is asked"
    );
}

#[test]
fn a_traverse_keeps_what_was_read_before_a_bad_reading() {
    let mut rig = Scripted::default();
    let mut guard = Guard::new(&mut rig, LIMITS, Vec::new()).unwrap();
    let traversed = guard.traverse(&[0.01], 0.01, 5);
    assert_eq!(traversed.readings.len(), 2);
    assert_eq!(quantity(traversed.fault.unwrap()), LimitedQuantity::Force);
    assert_eq!(
        quantity(guard.traverse(&[0.01], -0.02, 5).fault.unwrap()),
        LimitedQuantity::Speed
    );
    assert!(guard.check_energy_error(-0.05).is_ok());
    assert_eq!(
        quantity(guard.check_energy_error(f64::NAN).unwrap_err()),
        LimitedQuantity::EnergyError
    );
    assert!(rig.held);
}
