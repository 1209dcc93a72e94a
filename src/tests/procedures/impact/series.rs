//! Impact series of increasing energy, run on a virtual rig.

use crate::run::{Inspection, Observer, StepReport};
use crate::tests::testing::{as_of, elastic_plan, every, impact, list, number, run_unwatched};
use crate::verdict::{Verdict, assess};
use psd_plan::formula::Formula;
use psd_plan::formula::Formula::Constant;
use psd_plan::formula::{ProcedureId, ResultPart, ResultReference};
use psd_plan::record::{EscalateHistory, EventKind, History, Outcome, Record};
use psd_plan::{
    Behaviour, Between, Comparison, Condition, Contact, Escalate, Impact, Plan, ProcedureKind,
    Requirement, Test, Unload, Until,
};
use psd_rig::VirtualRig;
use psd_text::units::Dimension;

fn below(limit: f64) -> Condition {
    let value = Formula::Result(ResultReference {
        procedure: ProcedureId(0),
        name: "max_displacement",
        part: ResultPart::Value,
    });
    let test = Test::Compare {
        comparison: Comparison::Less,
        limit: Constant(limit),
    };
    Condition {
        text: format!("max_displacement < {} mm", 1e3 * limit),
        value,
        test,
        dimension: Dimension::LENGTH,
    }
}

fn given_impact() -> Impact {
    Impact {
        stepping: every(2e-4),
        duration: Constant(0.4),
        ..impact(Constant(2e4))
    }
}

fn rising(velocities: &[f64], limit: f64, between: Between) -> Escalate {
    Escalate {
        own: ProcedureId(0),
        impact: given_impact(),
        velocities: velocities.iter().copied().map(Constant).collect(),
        energies: None,
        condition: vec![below(limit)],
        between,
        inspect_between: false,
    }
}

/// K 20 kN/m; yields at 200 N, 10 mm.
fn yielding(procedures: Vec<ProcedureKind>) -> Plan {
    let mut plan = elastic_plan(2e4, procedures);
    plan.specimens[0].behaviour = Some(Behaviour::Bilinear {
        stiffness: 2e4,
        yield_force: 200.0,
        post_yield_ratio: 0.05,
    });
    plan
}

fn history(record: &Record) -> &EscalateHistory {
    match &record.procedures[0].history {
        History::Escalate(history) => history,
        other => panic!("{other:?}"),
    }
}

/// An observation that applies to every impact is reported after the first, with the number of the others at the end. A series of one
/// adds nothing.
#[test]
fn a_remark_on_every_impact_is_made_once() {
    let of = |velocities: &[f64]| {
        let short = Impact {
            duration: Constant(4e-3),
            until: Until::Duration,
            ..given_impact()
        };
        // No requirement on their results: a condition on their peak would end the series with the first.
        let row = Escalate {
            impact: short,
            condition: Vec::new(),
            ..rising(velocities, 1.0, Between::Home)
        };
        let record = run_unwatched(&yielding(vec![ProcedureKind::Escalate(row)]));
        assert_eq!(record.outcome, Outcome::Completed);
        let remarks = record
            .events
            .into_iter()
            .map(|event| event.text)
            .filter(|text| text.contains("not reached within the run"));
        remarks.collect::<Vec<String>>()
    };
    let text =
        "maximum displacement not reached within the run: the structure was still moving outward";
    assert_eq!(of(&[0.1]), [text]);
    assert_eq!(
        of(&[0.1, 0.2]),
        [text.to_owned(), format!("after 1 more impact: {text}")]
    );
    assert_eq!(
        of(&[0.1, 0.2, 0.3, 0.4]),
        [text.to_owned(), format!("after 3 more impacts: {text}")]
    );
}

/// Each impact is the impact that the plan could have written out, one unloading after the other.
#[test]
fn every_impact_of_a_series_equals_a_single_one() {
    let velocities = [0.3, 0.6, 0.9];
    let record = run_unwatched(&yielding(vec![ProcedureKind::Escalate(rising(
        &velocities,
        1.0,
        Between::Unload,
    ))]));
    assert_eq!(record.outcome, Outcome::Completed);
    let unload = ProcedureKind::Unload(Unload {
        specimen: 0,
        stiffness: Some(Constant(2e4)),
        within: None,
        speed: None,
        keep_axial_load: false,
    });
    let mut written = Vec::new();
    for _ in velocities {
        written.extend([ProcedureKind::Impact(given_impact()), unload.clone()]);
    }
    let mut plan = yielding(written);
    for (index, velocity) in velocities.into_iter().enumerate() {
        let striker = psd_plan::Striker {
            velocity,
            ..plan.strikers[0].clone()
        };
        plan.strikers.push(striker);
        if let ProcedureKind::Impact(impact) = &mut plan.procedures[2 * index].kind {
            impact.striker = index + 1;
        }
    }
    let apart = run_unwatched(&plan);
    for (index, impact) in history(&record).impacts.iter().enumerate() {
        assert_eq!(
            impact.results,
            as_of(0, &apart.procedures[2 * index].results),
            "blow {index}"
        );
        let rest = number(&apart, 2 * index + 1, "residual_displacement").0;
        assert_eq!(impact.rest_of_struck().map(|rest| rest.0), rest);
    }
    assert_eq!(list(&record, 0, "velocities"), velocities);
    let peaks = list(&record, 0, "max_displacements");
    assert_eq!(number(&record, 0, "max_displacement").0, Some(peaks[2]));
    assert!(peaks.windows(2).all(|pair| pair[0] < pair[1]));
}

/// An elastic specimen in a plastic impact: X = v Ms/√(K(M + Ms)), so the level that fails can be calculated.
#[test]
fn it_ends_with_the_first_impact_that_fails() {
    let velocities = [0.2, 0.4, 0.6, 0.8, 1.0];
    let mut plan = rising(&velocities, 0.0150, Between::Home);
    let contact = psd_plan::Contact::Restitution {
        coefficient: Constant(0.0),
    };
    plan.impact = Impact {
        contact,
        ..given_impact()
    };
    let record = run_unwatched(&elastic_plan(2e4, vec![ProcedureKind::Escalate(plan)]));
    let predicted = |velocity: f64| velocity * 10.0 / (2e4_f64 * 11.0).sqrt();
    let fails = velocities
        .iter()
        .position(|velocity| predicted(*velocity) >= 0.0150)
        .unwrap();
    assert_eq!(fails, 3);
    for (peak, velocity) in list(&record, 0, "max_displacements").iter().zip(velocities) {
        assert!((peak / predicted(velocity) - 1.0).abs() < 1e-3);
    }
    let energy = |velocity: f64| Some(0.5 * 10.0 * velocity * velocity);
    assert_eq!(
        (
            number(&record, 0, "impacts").0,
            number(&record, 0, "passed").0
        ),
        (Some(4.0), Some(3.0))
    );
    assert_eq!(number(&record, 0, "last_passed_energy").0, energy(0.6));
    assert_eq!(number(&record, 0, "first_failed_energy").0, energy(0.8));
    assert!(
        record
            .events
            .iter()
            .any(|event| event.text == "impact 4 of 3.200 J ends the series: max_displacement < 15 mm is false, the value is 17.06 mm")
    );
}

#[test]
fn the_list_bounds_it() {
    let record = run_unwatched(&elastic_plan(
        2e4,
        vec![ProcedureKind::Escalate(rising(
            &[0.1, 0.2],
            1.0,
            Between::Home,
        ))],
    ));
    assert_eq!(number(&record, 0, "first_failed_energy").0, None);
    assert_eq!(
        (
            number(&record, 0, "impacts").0,
            number(&record, 0, "passed").0
        ),
        (Some(2.0), Some(2.0))
    );
    assert!(record.events.iter().any(|event| event.text
        == "max_displacement < 1000 mm was true after every impact of the series"));
    assert!(number(&record, 0, "final_displacement").0.unwrap().abs() < 1e-15);
    assert!(
        record.procedures[0]
            .result("residual_displacement")
            .is_none(),
        "nothing was unloaded"
    );
}

#[test]
fn the_operator_inspects_between_two_impacts() {
    let plan = Escalate {
        inspect_between: true,
        ..rising(&[0.1, 0.2, 0.3], 1.0, Between::Unload)
    };
    let record = run_unwatched(&elastic_plan(2e4, vec![ProcedureKind::Escalate(plan)]));
    let looks = record
        .events
        .iter()
        .filter(|event| event.kind == EventKind::Inspection);
    let looks: Vec<&str> = looks.map(|event| event.text.as_str()).collect();
    assert_eq!(
        looks,
        ["after impact 1 of 50.00 mJ", "after impact 2 of 200.0 mJ"]
    );
}

#[test]
fn a_limit_in_an_impact_ends_it_and_keeps_the_steps() {
    let mut plan = yielding(vec![ProcedureKind::Escalate(rising(
        &[0.3, 2.0],
        1.0,
        Between::Unload,
    ))]);
    plan.limits.displacement = psd_plan::Interval {
        low: -1.0,
        high: 0.02,
    };
    let record = run_unwatched(&plan);
    assert!(matches!(record.outcome, Outcome::Aborted { .. }));
    let impacts = &history(&record).impacts;
    assert_eq!(
        (impacts.len(), impacts[0].held, impacts[1].held),
        (2, Some(true), None)
    );
    assert_eq!(number(&record, 0, "passed").0, Some(1.0));
}

/// Stores the bound that was reported, and counts the steps.
#[derive(Default)]
struct Counting {
    bound: Option<u64>,
    last: u64,
}

impl Observer for Counting {
    fn procedure_started(&mut self, _: &str, _: &str, steps: Option<u64>) {
        self.bound = steps;
    }
    fn step_done(&mut self, report: &StepReport) {
        self.last = report.step;
    }
    fn inspect(&mut self, _: &str) -> Inspection {
        Inspection::go_on()
    }
}

/// The moves between impacts are steps too. If the impacts continue to their duration, the bound is reached and never exceeded.
#[test]
fn no_more_steps_come_than_were_predicted() {
    for (between, exact) in [
        (Between::Home, true),
        (Between::Unload, false),
        (Between::Stay, true),
    ] {
        let mut rising = rising(&[0.1, 0.2, 0.3], 1.0, between);
        rising.impact = Impact {
            contact: Contact::Restitution {
                coefficient: Constant(0.5),
            },
            until: Until::Duration,
            duration: Constant(0.1),
            ..given_impact()
        };
        let plan = yielding(vec![ProcedureKind::Escalate(rising)]);
        let mut counting = Counting::default();
        let record = crate::run::run(&plan, &mut VirtualRig::of_plan(&plan), &mut counting);
        assert_eq!(record.outcome, Outcome::Completed);
        let bound = counting.bound.unwrap();
        assert!(
            counting.last <= bound && (!exact || counting.last == bound),
            "{between:?}: {} of {bound}",
            counting.last
        );
        assert!(counting.last >= 300);
    }
}

/// However early its impacts end, a series neither confirms nor rejects a result that complete impacts do not. K 20 kN/m and 11 kg
/// reverse after some 37 ms. With complete impacts the third is the first beyond 20 mm.
#[test]
fn a_series_of_truncated_impacts_concludes_nothing_that_complete_ones_do_not() {
    let requirement = |energy: f64| {
        let value = Formula::Result(ResultReference {
            procedure: ProcedureId(0),
            name: "last_passed_energy",
            part: ResultPart::Value,
        });
        let test = Test::Compare {
            comparison: Comparison::GreaterEqual,
            limit: Constant(energy),
        };
        let condition = Condition {
            text: String::new(),
            value,
            test,
            dimension: Dimension::ENERGY,
        };
        Requirement {
            label: format!("{energy}"),
            conditions: vec![condition],
        }
    };
    let of = |duration: f64| {
        let mut row = rising(&[0.3, 0.6, 0.9, 1.2], 0.02, Between::Unload);
        row.impact = Impact {
            duration: Constant(duration),
            ..given_impact()
        };
        let mut plan = yielding(vec![ProcedureKind::Escalate(row)]);
        plan.requirements = [0.45, 1.8, 4.05].map(requirement).to_vec();
        let record = run_unwatched(&plan);
        let verdicts = assess(&plan, &record)
            .requirements
            .iter()
            .map(|one| one.verdict)
            .collect::<Vec<_>>();
        (
            verdicts,
            number(&record, 0, "passed").0,
            history(&record).impacts.last().unwrap().held,
        )
    };
    let whole = of(0.4);
    assert_eq!(
        whole,
        (
            vec![Verdict::Pass, Verdict::Pass, Verdict::Fail],
            Some(2.0),
            Some(false)
        )
    );
    let mut undecided = 0;
    for duration in [1e-3, 5e-3, 0.02, 0.03, 0.035, 0.045, 0.06, 0.1] {
        let (verdicts, passed, held) = of(duration);
        for (cut, whole) in verdicts.iter().zip(&whole.0) {
            assert!(
                cut == whole || *cut == Verdict::Inconclusive,
                "{duration}: {verdicts:?}"
            );
        }
        undecided += usize::from(held.is_none());
        assert!(
            held.is_some() || verdicts[2] == Verdict::Inconclusive,
            "{duration}: what is open is not refuted"
        );
        assert!(passed <= whole.1);
    }
    assert!((3..8).contains(&undecided), "{undecided} were cut");
}

/// In `while` and in the results, the unloaded position is the position after unloading: a specimen that springs back continues the
/// series.
#[test]
fn a_row_goes_by_where_the_specimen_rests() {
    let mut row = rising(&[0.1, 0.2], 1e-4, Between::Unload);
    let read = |condition: &mut Condition| {
        condition.value = Formula::Result(ResultReference {
            procedure: ProcedureId(0),
            name: "residual_displacement",
            part: ResultPart::Value,
        });
    };
    row.condition.iter_mut().for_each(read);
    // At the end of each impact it is at some 2 mm and 4 mm.
    let record = run_unwatched(&elastic_plan(2e4, vec![ProcedureKind::Escalate(row)]));
    assert!(
        history(&record)
            .impacts
            .iter()
            .all(|impact| impact.number("final_displacement").unwrap() > 1e-3)
    );
    assert_eq!(number(&record, 0, "passed").0, Some(2.0));
}

#[test]
fn a_row_that_fails_at_once_has_withstood_nothing() {
    let record = run_unwatched(&elastic_plan(
        2e4,
        vec![ProcedureKind::Escalate(rising(
            &[0.6, 0.8],
            1e-3,
            Between::Home,
        ))],
    ));
    assert_eq!(
        (
            number(&record, 0, "impacts").0,
            number(&record, 0, "passed").0
        ),
        (Some(1.0), Some(0.0))
    );
    assert_eq!(number(&record, 0, "last_passed_energy").0, Some(0.0));
}
