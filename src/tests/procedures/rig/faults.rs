//! Runs on a rig that fails during the run: no invalid number passes, and the record before the fault is kept.

use crate::run::{Unwatched, run};
use crate::tests::testing::{elastic_plan, number, ramp};
use psd_plan::record::{EventKind, History, Outcome, Record};
use psd_plan::{Plan, ProcedureKind};
use psd_rig::{EncodedMove, Reading, Rig, RigFault, VirtualRig};
use psd_testing::forwarded;

/// The reading that follows some valid readings.
#[derive(Clone, Copy)]
enum Then {
    NotANumber,
    Lost,
}

/// A virtual rig that fails.
struct Failing {
    rig: VirtualRig,
    good_readings: u32,
    then: Then,
    axes: usize,
    moves_after_hold: Option<u32>,
}

impl Rig for Failing {
    forwarded!(rig: identity, time, execute, pause, traverse, declared_noise);

    fn degrees_of_freedom(&self) -> usize {
        self.axes
    }
    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<EncodedMove, RigFault> {
        self.moves_after_hold = self.moves_after_hold.map(|moves| moves + 1);
        self.rig.propose(targets, speed)
    }
    fn read(&mut self) -> Result<Reading, RigFault> {
        let reading = self.rig.read()?;
        if self.good_readings > 0 {
            self.good_readings -= 1;
            return Ok(reading);
        }
        match self.then {
            Then::NotANumber => Ok(Reading {
                force: vec![f64::NAN],
                ..reading
            }),
            Then::Lost => Err(RigFault::Device("the line is dead".to_owned())),
        }
    }
    fn hold(&mut self) {
        self.moves_after_hold.get_or_insert(0);
        self.rig.hold();
    }
}

/// Two ramps; a ramp reads once at its start and twice at each step, the guard once before all.
fn run_failing(good_readings: u32, then: Then, axes: usize) -> Record {
    let ramps = vec![
        ProcedureKind::StiffnessRamp(ramp(1e-4)),
        ProcedureKind::StiffnessRamp(ramp(1e-4)),
    ];
    let plan: Plan = elastic_plan(3e5, ramps);
    let mut rig = Failing {
        rig: VirtualRig::of_plan(&plan),
        good_readings,
        then,
        axes,
        moves_after_hold: None,
    };
    let record = run(&plan, &mut rig, &mut Unwatched);
    assert_eq!(rig.moves_after_hold, Some(0), "held, and not moved again");
    record
}

#[test]
fn a_reading_that_is_no_number_aborts_and_keeps_what_came_before() {
    let record = run_failing(2 + 2 * 4, Then::NotANumber, 1);
    assert!(
        matches!(&record.outcome, Outcome::Aborted { reason } if reason.contains("force NaN")),
        "{:?}",
        record.outcome
    );
    let History::StiffnessRamp(history) = &record.procedures[0].history else {
        panic!("a ramp")
    };
    assert_eq!((record.procedures.len(), history.steps.len()), (1, 4));
    assert!((number(&record, 0, "stiffness").0.unwrap() - 3e5).abs() < 1e-3);
    assert_eq!(record.events.last().unwrap().kind, EventKind::LimitBreach);
}

#[test]
fn a_lost_rig_is_a_fault_and_the_procedure_before_it_is_whole() {
    let record = run_failing(2 + 2 * 10 + 1 + 2 * 3, Then::Lost, 1);
    assert_eq!(
        record.outcome,
        Outcome::Faulted {
            reason: "the line is dead".to_owned()
        }
    );
    assert_eq!(
        record
            .procedures
            .iter()
            .map(|procedure| procedure.complete)
            .collect::<Vec<_>>(),
        [true, false]
    );
    assert_eq!(record.events.last().unwrap().kind, EventKind::Fault);
}

#[test]
fn a_rig_that_cannot_be_used_from_the_start_runs_nothing() {
    let blind = run_failing(0, Then::NotANumber, 1);
    assert!(matches!(blind.outcome, Outcome::Aborted { .. }) && blind.procedures.is_empty());
    let two_axes = run_failing(100, Then::Lost, 2);
    assert!(matches!(&two_axes.outcome, Outcome::Faulted { reason } if reason.contains("degree")));
    assert_eq!(two_axes.events.len(), 1);
}
