//! Whole runs on plans built by hand: what is identified, what a breach leaves, what a seed repeats.

use super::testing::{elastic_plan, number, ramp, result_of, run_unwatched};
use crate::plan::formula::Formula;
use crate::plan::{
    DampingSweep, Interval, Link, Move, Plan, ProcedureKind, StiffnessRamp, VirtualLink,
};
use crate::record::{Event, EventKind, History, Outcome, RampStep, SweepStep};
use crate::rig::{LimitedQuantity, Rig, RigFault, VirtualRig};
use crate::run::{Inspection, Next, Observer, StepReport, Unwatched, run};

fn constant(value: f64) -> Formula {
    Formula::Constant(value)
}

fn sweep(velocities: &[f64]) -> DampingSweep {
    DampingSweep {
        specimen: 0,
        velocities: velocities.iter().copied().map(Formula::Constant).collect(),
        stroke: constant(1e-3),
        about: None,
        stiffness: result_of(0, "stiffness"),
        rate: None,
    }
}

fn ramp_then_sweep() -> Plan {
    let velocities = sweep(&[5e-4, 1e-3, 2e-3, 5e-3, 1e-2]);
    let mut plan = elastic_plan(
        3e5,
        vec![
            ProcedureKind::StiffnessRamp(ramp(1e-4)),
            ProcedureKind::DampingSweep(velocities),
        ],
    );
    plan.specimens[0].mass = 0.5;
    plan.specimens[0].damping = 400.0;
    plan.specimens[0].coulomb = 3.0;
    plan
}

fn link(plan: &mut Plan, link: VirtualLink) {
    plan.rig.link = Link::Virtual(link);
}

fn ramp_steps(history: &History) -> &[RampStep] {
    match history {
        History::Ramp(ramp) => &ramp.steps,
        other => panic!("{other:?}"),
    }
}

fn sweep_steps(history: &History) -> &[SweepStep] {
    match history {
        History::Sweep(sweep) => &sweep.steps,
        other => panic!("{other:?}"),
    }
}

/// ζ = c/(2√(KM)) with nothing uncertain but M: u(ζ) = ζ u(M)/(2M).
#[test]
fn the_mass_of_the_specimen_is_in_its_damping_ratio() {
    let mut plan = ramp_then_sweep();
    plan.specimens[0].mass_uncertainty = 0.04;
    let record = run_unwatched(&plan);
    let (ratio, uncertainty) = number(&record, 1, "damping_ratio");
    let expected = 0.5 * 0.08 * ratio.unwrap();
    assert!(
        (uncertainty.unwrap() / expected - 1.0).abs() < 1e-6,
        "{uncertainty:?} is not {expected}"
    );
    assert!(
        number(&record, 1, "damping").1.unwrap() < 1e-6,
        "c does not hang on it"
    );
}

#[test]
fn an_ideal_ramp_and_sweep_give_back_the_specimen() {
    let record = run_unwatched(&ramp_then_sweep());
    assert_eq!(record.outcome, Outcome::Completed);
    let near = |procedure, name, expected: f64| {
        let value = number(&record, procedure, name).0.unwrap();
        assert!(
            (value - expected).abs() <= 1e-9 * expected.abs().max(1.0),
            "{name}: {value}"
        );
    };
    near(0, "stiffness", 3e5);
    near(0, "intercept_force", 3.0);
    // The first increment is where friction sets in: (30 + 3) N over 0.1 mm.
    near(0, "secant_stiffness", 3.3e5);
    near(0, "max_force", 303.0);
    near(0, "max_displacement", 1e-3);
    near(0, "relaxation", 0.0);
    assert_eq!(number(&record, 0, "loop_energy"), (None, None));
    near(1, "damping", 400.0);
    near(1, "coulomb_force", 3.0);
    near(1, "damping_ratio", 400.0 / (2.0 * (3e5_f64 * 0.5).sqrt()));
    near(1, "max_velocity", 0.01);
    let steps = sweep_steps(&record.procedures[1].history);
    let steady = steps.iter().filter(|step| step.steady).count();
    assert!(steady >= 10 * 50, "{steady}");
    assert_eq!(steps.len() as u64, steps.last().unwrap().step);
    assert!(
        (steps.last().unwrap().displacement).abs() < 1e-15,
        "back where it began"
    );
}

#[test]
fn results_stand_in_the_order_of_the_reference() {
    let record = run_unwatched(&ramp_then_sweep());
    let names = |procedure: usize| -> Vec<_> {
        record.procedures[procedure]
            .results
            .iter()
            .map(|result| result.name)
            .collect()
    };
    let ramp = "stiffness, secant_stiffness, intercept_force, r_squared, max_force, max_displacement, loop_energy, relaxation, \
                tangent_stiffness, yield_force, yield_displacement, hardened_stiffness, hardening, breaks, break_uncertainties, \
                break_forces, break_force_uncertainties, curve_stiffnesses, curve_stiffness_uncertainties, time_constant, \
                relaxed_stiffness, branch_stiffness, remaining_relaxation, needed_pause";
    assert_eq!(names(0).join(", "), ramp);
    assert_eq!(
        names(1).join(", "),
        "damping, coulomb_force, r_squared, damping_ratio, max_velocity"
    );
}

#[test]
fn a_way_back_closes_the_loop_and_friction_is_its_energy() {
    let back = StiffnessRamp {
        return_path: true,
        repeats: 2,
        ..ramp(1e-4)
    };
    let mut plan = elastic_plan(1000.0, vec![ProcedureKind::StiffnessRamp(back)]);
    plan.specimens[0].coulomb = 0.5;
    let record = run_unwatched(&plan);
    let steps = ramp_steps(&record.procedures[0].history);
    assert_eq!(steps.len(), 2 * 20);
    assert_eq!(steps.iter().filter(|step| step.returning).count(), 20);
    assert_eq!(steps[19].command, 0.0);
    // Trapezoids through the readings, by hand. Out and back of 1 mm with ±0.5 N is 1 mJ, less the corners: half an
    // increment at the start (from 0 N, or from −0.5 N the second time) and a whole one at the turn.
    let first: f64 = 0.5 * 1e-3 * 2.0 - 0.5 * 0.5 * 1e-4 - 0.5 * 1e-4;
    let second = first - 0.5 * 0.5 * 1e-4;
    let energy = number(&record, 0, "loop_energy").0.unwrap();
    assert!((energy - 0.5 * (first + second)).abs() < 1e-12, "{energy}");
    assert!((number(&record, 0, "stiffness").0.unwrap() - 1000.0).abs() < 1e-6);
}

#[test]
fn relaxation_is_the_first_reading_less_the_mean_after_the_pause() {
    let paused = StiffnessRamp {
        pause: constant(2.0),
        ..ramp(1e-4)
    };
    let mut plan = elastic_plan(1000.0, vec![ProcedureKind::StiffnessRamp(paused)]);
    link(
        &mut plan,
        VirtualLink {
            drift: -0.25,
            ..VirtualLink::default()
        },
    );
    let record = run_unwatched(&plan);
    assert!((number(&record, 0, "relaxation").0.unwrap() - 0.5).abs() < 1e-12);
}

#[test]
fn identification_finds_the_specimen_within_honest_standard_errors_over_many_seeds() {
    let truth = [
        (0, "stiffness", 3e5),
        (1, "damping", 400.0),
        (1, "coulomb_force", 3.0),
    ];
    let mut plan = ramp_then_sweep();
    let mut within = [[0_u32; 3]; 3];
    for seed in 0..500 {
        link(
            &mut plan,
            VirtualLink {
                noise: 2.0,
                seed,
                ..VirtualLink::default()
            },
        );
        let record = run_unwatched(&plan);
        for ((procedure, name, truth), within) in truth.into_iter().zip(&mut within) {
            let (Some(value), Some(error)) = number(&record, procedure, name) else {
                panic!("{name} has no error")
            };
            let deviations = (value - truth).abs() / error;
            for (errors, count) in [1.0, 2.0, 3.0].into_iter().zip(within) {
                *count += u32::from(deviations <= errors);
            }
        }
    }
    // Of 500, Student's t with 8 degrees of freedom (the ramp) expects 327, 460, 491; the normal one (the sweep, with
    // some 250 pairs of readings) 341, 477, 499. Four standard deviations of a count are 42, 21 and 10 or fewer.
    for (expected, found) in [[327, 460, 491], [341, 477, 499], [341, 477, 499]]
        .into_iter()
        .zip(within)
    {
        for ((expected, found), spread) in expected.into_iter().zip(found).zip([42, 21, 10]) {
            assert!(found.abs_diff(expected) <= spread, "{within:?}");
        }
    }
}

#[test]
fn a_lagging_actuator_does_not_bias_the_damping() {
    let mut plan = ramp_then_sweep();
    link(
        &mut plan,
        VirtualLink {
            lag: 2e-3,
            ..VirtualLink::default()
        },
    );
    plan.rig.settle.band = 1e-9;
    let record = run_unwatched(&plan);
    let damping = number(&record, 1, "damping").0.unwrap();
    assert!((damping / 400.0 - 1.0).abs() < 0.005, "{damping}");
}

/// At 10 mm/s and a lag of 20 ms the piston trails by 0.2 mm where a stroke ends: it must come to rest before what follows.
#[test]
fn a_sweep_leaves_the_rig_at_rest_where_it_began() {
    let mut plan = ramp_then_sweep();
    link(
        &mut plan,
        VirtualLink {
            lag: 20e-3,
            ..VirtualLink::default()
        },
    );
    plan.rig.settle.band = 1e-7;
    let mut rig = VirtualRig::of_plan(&plan);
    let record = run(&plan, &mut rig, &mut Unwatched);
    assert_eq!(record.outcome, Outcome::Completed);
    let left = rig.read().unwrap().displacement[0];
    // The settling time is solved for, so that the piston ends on the edge of the band, to rounding.
    assert!(left.abs() <= 1e-7 * (1.0 + 1e-9), "left at {left} m");
}

#[test]
fn a_breach_holds_the_rig_and_keeps_what_was_recorded() {
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
    // The force limit is found out by reading.
    plan.limits = crate::plan::Limits {
        force: Interval {
            low: -1e3,
            high: 200.0,
        },
        ..crate::plan::Limits::NONE
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
    // The reading that broke it is the last row, and what the specimen was taken to.
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
fn a_breach_inside_a_stroke_keeps_the_readings_before_it() {
    let mut plan = ramp_then_sweep();
    // The ramp ends at 303 N; damping lifts the stroke at 5 mm/s to 305 N.
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
    plan.rig.settle = crate::plan::Settle {
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
fn an_input_that_does_not_exist_is_a_fault_of_the_run() {
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
fn a_seed_repeats_every_reading_and_another_does_not() {
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
struct Person {
    steps_left: u32,
    stops_at_inspection: bool,
}

impl Observer for Person {
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
fn a_person_can_stop_after_any_step_and_at_an_inspection() {
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
        let mut person = Person {
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

/// Pauses after the second step, and says something when asked again.
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
fn a_pause_changes_nothing_but_what_was_said() {
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
