//! Runs that end early or pause: limits, a rig that does not settle, an operator.

use super::{constant, link, ramp_steps, ramp_then_sweep, sweep, sweep_steps};
use crate::run::{Inspection, Next, Observer, StepReport, Unwatched, run};
use crate::tests::testing::{elastic_plan, number, ramp, run_unwatched};
use psd_plan::record::{Event, EventKind, History, Outcome};
use psd_plan::{Interval, Move, ProcedureKind, StiffnessRamp, VirtualLink};
use psd_rig::{LimitedQuantity, RigFault, VirtualRig};

#[test]
fn a_violated_limit_holds_the_rig_and_keeps_the_record() {
    let mut plan = ramp_then_sweep();
    plan.limits.displacement = Interval {
        low: -1e-3,
        high: 5.5e-4,
    };
    let mut rig = VirtualRig::of_plan(&plan);
    let record = run(&plan, &mut rig, &mut Unwatched);
    assert!(
        matches!(&record.outcome, Outcome::Aborted { reason } if reason.contains("target displacement")),
        "{:?}",
        record.outcome
    );
    assert_eq!(record.procedures.len(), 1, "later procedures do not run");
    let partial = &record.procedures[0];
    assert!(!partial.complete);
    assert_eq!(ramp_steps(&partial.history).len(), 5);
    assert!((number(&record, 0, "stiffness").0.unwrap() - 3e5).abs() < 1e-3);
    let last = record.events.last().unwrap();
    assert_eq!((last.kind, last.step), (EventKind::LimitBreach, Some(5)));
    // The force limit is detected by reading.
    plan.limits = psd_plan::Limits {
        force: Interval {
            low: -1e3,
            high: 200.0,
        },
        ..psd_plan::Limits::NONE
    };
    let record = run_unwatched(&plan);
    let by_hand = RigFault::LimitBreached {
        quantity: LimitedQuantity::Force,
        value: 213.0,
        low: -1e3,
        high: 200.0,
        axis: None,
    };
    let Outcome::Aborted { reason } = &record.outcome else {
        panic!("{:?}", record.outcome)
    };
    assert_eq!(
        reason.split_whitespace().next(),
        by_hand.to_string().split_whitespace().next()
    );
    // The reading that exceeded the limit is the last row; the specimen reached it.
    let steps = ramp_steps(&record.procedures[0].history);
    assert_eq!((steps.len(), steps[6].command), (7, 7.0 * steps[0].command));
    assert!(
        steps[5].restoring_force < 200.0 && steps[6].restoring_force > 200.0,
        "{:?}",
        steps[6]
    );
    assert_eq!(
        number(&record, 0, "max_force").0,
        Some(steps[6].restoring_force)
    );
    assert_eq!(
        number(&record, 0, "max_displacement").0,
        Some(steps[6].displacement)
    );
}

#[test]
fn a_violated_limit_inside_a_stroke_keeps_the_readings_before_it() {
    let mut plan = ramp_then_sweep();
    // The ramp ends at 303 N; damping raises the pass at 5 mm/s to 305 N.
    plan.limits.force = Interval {
        low: -1e3,
        high: 304.0,
    };
    let record = run_unwatched(&plan);
    assert!(matches!(record.outcome, Outcome::Aborted { .. }));
    let sweep = &record.procedures[1];
    assert!(!sweep.complete && !sweep_steps(&sweep.history).is_empty());
    let (last, before) = sweep_steps(&sweep.history).split_last().unwrap();
    assert!(
        last.restoring_force > 304.0 && before.iter().all(|step| step.restoring_force <= 304.0),
        "{last:?}"
    );
    assert!((number(&record, 1, "damping").0.unwrap() - 400.0).abs() < 1e-6);
}

#[test]
fn a_rig_that_does_not_settle_aborts_the_run() {
    let mut plan = ramp_then_sweep();
    plan.rig.settle = psd_plan::Settle {
        band: 1e-6,
        force_rate: 0.0,
        dwell: 0.1,
        timeout: 5.0,
    };
    link(
        &mut plan,
        VirtualLink {
            tracking: 0.2,
            ..VirtualLink::default()
        },
    );
    assert!(
        matches!(run_unwatched(&plan).outcome, Outcome::Aborted { reason } if reason.contains("settle"))
    );
}

#[test]
fn a_missing_input_is_an_error_of_the_run() {
    let two = StiffnessRamp {
        displacements: vec![constant(1e-4)],
        ..ramp(1e-4)
    };
    let plan = elastic_plan(
        3e5,
        vec![
            ProcedureKind::StiffnessRamp(two),
            ProcedureKind::DampingSweep(sweep(&[1e-3])),
        ],
    );
    let record = run_unwatched(&plan);
    assert!(
        matches!(&record.outcome, Outcome::Blocked { reason } if reason.contains("`stiffness`")),
        "{:?}",
        record.outcome
    );
    assert_eq!(record.procedures.len(), 2);
    assert_eq!(number(&record, 1, "damping"), (None, None));
    assert_eq!(record.events.last().unwrap().kind, EventKind::Fault);
}

#[test]
fn a_seed_repeats_every_reading() {
    let mut plan = ramp_then_sweep();
    let mut steps = |seed| {
        link(
            &mut plan,
            VirtualLink {
                noise: 2.0,
                seed,
                lag: 1e-3,
                ..VirtualLink::default()
            },
        );
        let record = run_unwatched(&plan);
        (
            ramp_steps(&record.procedures[0].history).to_vec(),
            sweep_steps(&record.procedures[1].history).to_vec(),
        )
    };
    let first = steps(7);
    assert_eq!(first, steps(7));
    assert_ne!(first, steps(8));
}

/// Stops after some steps, or at the first inspection.
struct Operator {
    steps_left: u32,
    stops_at_inspection: bool,
}

impl Observer for Operator {
    fn step_done(&mut self, _: &StepReport) {
        self.steps_left -= 1;
    }
    fn stop_requested(&self) -> bool {
        self.steps_left == 0
    }
    fn inspect(&mut self, _: &str) -> Inspection {
        if self.stops_at_inspection {
            Inspection::Stop {
                reason: "a crack".to_owned(),
                by: None,
            }
        } else {
            Inspection::GoOn {
                note: Some("nothing to see".to_owned()),
                by: Some("A. Engineer".to_owned()),
            }
        }
    }
}

#[test]
fn an_operator_can_stop_after_any_step_and_at_an_inspection() {
    let to = Move {
        to: constant(2.5e-4),
        speed: Some(constant(1e-3)),
    };
    let inspect = ProcedureKind::Inspect {
        note: "look at the bearing".to_owned(),
    };
    let mut plan = elastic_plan(
        3e5,
        vec![
            ProcedureKind::Move(to),
            inspect,
            ProcedureKind::StiffnessRamp(ramp(1e-4)),
        ],
    );
    plan.limits.increment = Interval {
        low: 0.0,
        high: 1.6e-4,
    };
    let attend = |steps_left, stops_at_inspection| {
        let mut person = Operator {
            steps_left,
            stops_at_inspection,
        };
        run(&plan, &mut VirtualRig::of_plan(&plan), &mut person)
    };
    let stopped = attend(2 + 4, false);
    assert_eq!(
        stopped.outcome,
        Outcome::Aborted {
            reason: "stopped on request".to_owned()
        }
    );
    assert_eq!(ramp_steps(&stopped.procedures[2].history).len(), 4);
    assert!(matches!(&stopped.procedures[0].history, History::Move(steps) if steps.len() == 2));
    assert_eq!(
        stopped.events[0].text,
        "look at the bearing: nothing to see (A. Engineer)"
    );
    let at_inspection = attend(100, true);
    assert_eq!(
        at_inspection.outcome,
        Outcome::Aborted {
            reason: "a crack".to_owned()
        }
    );
    assert_eq!(at_inspection.procedures.len(), 2);
}

/// Pauses after the second step, and adds a comment at the next inspection.
#[derive(Default)]
struct Pausing {
    steps: u64,
    looks: u32,
    heard: Vec<String>,
}

impl Observer for Pausing {
    fn step_done(&mut self, report: &StepReport) {
        self.steps = report.step;
    }
    fn inspect(&mut self, _: &str) -> Inspection {
        self.looks += 1;
        if self.looks.is_multiple_of(3) {
            Inspection::go_on()
        } else {
            Inspection::Wait
        }
    }
    fn next(&mut self) -> Next {
        if self.steps != 2 || self.looks > 2 {
            return Next::GoOn;
        }
        self.looks += 1;
        if self.looks == 1 {
            Next::Record("paused".to_owned())
        } else {
            Next::Wait
        }
    }
    fn event(&mut self, event: &Event) {
        self.heard.push(event.text.clone());
    }
}

#[test]
fn a_pause_changes_nothing_but_the_events() {
    let inspect = ProcedureKind::Inspect {
        note: "look".to_owned(),
    };
    let plan = elastic_plan(3e5, vec![ProcedureKind::StiffnessRamp(ramp(1e-4)), inspect]);
    let mut pausing = Pausing::default();
    let record = run(&plan, &mut VirtualRig::of_plan(&plan), &mut pausing);
    let unwatched = run_unwatched(&plan);
    assert_eq!(
        ramp_steps(&record.procedures[0].history),
        ramp_steps(&unwatched.procedures[0].history)
    );
    assert_eq!(
        (record.events[0].kind, record.events[0].step),
        (EventKind::Note, Some(2))
    );
    assert_eq!(
        pausing.heard,
        ["paused", "look"],
        "who watches hears every event"
    );
}
