//! Several impacts on one specimen that keeps its damage.

use crate::tests::testing::{elastic_plan, every, impact, number, run_unwatched};
use psd_plan::formula::Formula;
use psd_plan::formula::Formula::Constant;
use psd_plan::record::{History, ImpactStep, Record, StepState};
use psd_plan::{Behaviour, Contact, Impact, Plan, ProcedureKind, Unload, Until};

/// K 20 kN/m; yields at 200 N, 10 mm, without post-yield stiffness.
fn perfectly_plastic(procedures: Vec<ProcedureKind>) -> Plan {
    let mut plan = elastic_plan(2e4, procedures);
    plan.specimens[0].behaviour = Some(Behaviour::Bilinear {
        stiffness: 2e4,
        yield_force: 200.0,
        post_yield_ratio: 0.0,
    });
    plan
}

fn given_impact() -> Impact {
    Impact {
        stepping: every(2e-4),
        duration: Constant(0.4),
        ..impact(Constant(2e4))
    }
}

fn unload() -> ProcedureKind {
    ProcedureKind::Unload(Unload {
        specimen: 0,
        stiffness: Some(Constant(2e4)),
        within: None,
        speed: None,
        keep_axial_load: false,
    })
}

fn steps(record: &Record, procedure: usize) -> Vec<ImpactStep> {
    match &record.procedures[procedure].history {
        History::Impact(impact) => impact.steps.iter().collect(),
        other => panic!("{other:?}"),
    }
}

fn value(record: &Record, procedure: usize, name: &str) -> f64 {
    number(record, procedure, name).0.unwrap()
}

/// Without post-yield stiffness, an unloaded specimen equals a new one at a different position. The second impact equals the first,
/// shifted by the residual displacement.
#[test]
fn the_second_impact_begins_where_the_first_left_the_specimen() {
    let kind = ProcedureKind::Impact(given_impact());
    let record = run_unwatched(&perfectly_plastic(vec![kind.clone(), unload(), kind]));
    let first = value(&record, 0, "max_displacement");
    assert!(first > 0.02, "it yields: {first} m");
    let rest = value(&record, 1, "residual_displacement");
    assert!(
        (rest - (first - 0.01)).abs() < 1e-5 * first,
        "{rest} m is not {first} m less what springs back"
    );
    assert!(value(&record, 1, "residual_force").abs() < 0.2 + 1e-12);
    // X counts from the initial position of the specimen, and the striker touches the surface at its present position.
    let start = steps(&record, 2)[0];
    assert_eq!(
        (start.command, start.striker_displacement),
        (steps(&record, 2)[0].command, start.command)
    );
    assert!((start.command - rest).abs() < 1e-12);
    let second = value(&record, 2, "max_displacement");
    assert!(
        (second - rest - first).abs() < 1e-4 * first,
        "{second} m is not {rest} m + {first} m"
    );
    assert!(
        (value(&record, 2, "absorbed_energy") / value(&record, 0, "absorbed_energy") - 1.0).abs()
            < 1e-4
    );
}

/// A gap is measured from the present position of the surface: the same gap takes the same time.
#[test]
fn a_gap_is_measured_from_where_the_surface_now_is() {
    let kind = ProcedureKind::Impact(given_impact());
    let mut plan = perfectly_plastic(vec![kind.clone(), unload(), kind]);
    plan.strikers[0].gap = 0.0051;
    let record = run_unwatched(&plan);
    let touched = |procedure| {
        steps(&record, procedure)
            .iter()
            .find(|step| step.state == StepState::Contact)
            .unwrap()
            .time
    };
    assert!((touched(0) - touched(2)).abs() < 1e-12 && (touched(0) - 0.0051).abs() <= 4.1e-4);
    let start = steps(&record, 2)[0];
    assert!((start.command - start.striker_displacement - 0.0051).abs() < 1e-15);
}

#[test]
fn a_specimen_without_load_is_not_moved() {
    let record = run_unwatched(&perfectly_plastic(vec![unload()]));
    let History::Unload(moved) = &record.procedures[0].history else {
        panic!()
    };
    assert!(moved.steps.is_empty());
    assert_eq!(number(&record, 0, "residual_displacement").0, Some(0.0));
}

/// After the end no further contact occurs, however long the run continues.
#[test]
fn a_rebound_ends_the_run_when_the_two_are_apart_for_good() {
    let of = |until, striker_mass: f64, contact: Contact| {
        let struck = Impact {
            until,
            contact,
            duration: Constant(3.0),
            ..given_impact()
        };
        let mut plan = elastic_plan(2e4, vec![ProcedureKind::Impact(struck)]);
        plan.strikers[0].mass = striker_mass;
        run_unwatched(&plan)
    };
    for striker_mass in [0.5, 2.0, 10.0, 40.0] {
        for contact in [
            Contact::Rigid,
            Contact::Restitution {
                coefficient: Formula::Constant(0.5),
            },
        ] {
            let short = of(Until::Rebound, striker_mass, contact.clone());
            let long = of(Until::Duration, striker_mass, contact);
            let (short, long) = (steps(&short, 0), steps(&long, 0));
            let end = short.last().unwrap();
            assert!(
                short.len() < long.len() / 4,
                "{striker_mass} kg: {} s",
                end.time
            );
            assert!(end.striker_velocity < 0.0 && end.striker_displacement < end.command);
            let again = long[short.len()..]
                .iter()
                .find(|step| step.state != StepState::Free);
            assert!(
                again.is_none(),
                "{striker_mass} kg: left at {} s, {again:?}",
                end.time
            );
            // And not a whole vibration cycle later than necessary.
            let last_touch = long
                .iter()
                .rev()
                .find(|step| step.state != StepState::Free)
                .unwrap()
                .time;
            assert!(
                end.time - last_touch < 0.1,
                "{striker_mass} kg: {} s after {last_touch} s",
                end.time
            );
        }
    }
}
