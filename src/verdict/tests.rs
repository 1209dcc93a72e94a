//! Verdicts at and near their limits, under both decision rules.

use super::*;
use psd_plan::formula::{Formula, ProcedureId, ResultPart, ResultReference, ResultValue};
use psd_plan::record::Identity;
use psd_plan::record::{History, NamedResult, Outcome, ProcedureRecord, Record};
use psd_plan::{Comparison, Condition, DecisionRule, Requirement, Test};
use psd_text::units::Dimension;

pub(super) fn record(outcome: Outcome) -> Record {
    let number = |name, value, uncertainty| NamedResult {
        name,
        value: ResultValue::Number { value, uncertainty },
        dimension: Dimension::LENGTH,
        contributions: Vec::new(),
        withheld: None,
    };
    Record {
        rig: Identity {
            name: String::new(),
            model: String::new(),
            serial: String::new(),
            firmware: String::new(),
            boot: None,
            simulated: true,
        },
        procedures: vec![ProcedureRecord {
            name: "hit".to_owned(),
            kind: "impact",
            complete: true,
            inputs: Vec::new(),
            results: vec![
                number("max_displacement", Some(8.0), Some(0.1)),
                number("stop_time", None, None),
            ],
            history: History::Inspect,
            axial: Vec::new(),
        }],
        events: Vec::new(),
        outcome,
        drift: None,
    }
}

pub(super) fn result(name: &'static str) -> Formula {
    Formula::Result(ResultReference {
        procedure: ProcedureId(0),
        name,
        part: ResultPart::Value,
    })
}

pub(super) fn condition(value: Formula, test: Test) -> Condition {
    Condition {
        text: "as written".to_owned(),
        value,
        test,
        dimension: Dimension::LENGTH,
    }
}

pub(super) fn compare(comparison: Comparison, limit: f64) -> Test {
    Test::Compare {
        comparison,
        limit: Formula::Constant(limit),
    }
}

pub(super) fn outcome_of(test: Test) -> ConditionOutcome {
    assess_condition(
        &condition(result("max_displacement"), test),
        DecisionRule::Simple,
        &record(Outcome::Completed),
    )
}

#[test]
fn a_comparison_passes_or_fails_with_its_margin_and_uncertainty() {
    let met = outcome_of(compare(Comparison::LessEqual, 8.5));
    assert_eq!((met.verdict, met.margin), (Verdict::Pass, Some(0.5)));
    assert!((met.uncertainty.unwrap() - 0.1).abs() < 1e-12);
    let missed = outcome_of(compare(Comparison::Greater, 8.0));
    assert_eq!((missed.verdict, missed.margin), (Verdict::Fail, Some(0.0)));
    let equal = outcome_of(compare(Comparison::Equal, 7.0));
    assert_eq!((equal.verdict, equal.margin), (Verdict::Fail, Some(-1.0)));
}

#[test]
fn a_relative_tolerance_is_of_the_size_of_the_target() {
    let within = |target, tolerance, relative| {
        outcome_of(Test::Within {
            target: Formula::Constant(target),
            tolerance: Formula::Constant(tolerance),
            relative,
        })
    };
    let near = within(10.0, 0.25, true);
    assert_eq!((near.verdict, near.margin), (Verdict::Pass, Some(0.5)));
    assert_eq!(
        near.bound,
        Some(Bound::Within {
            target: 10.0,
            tolerance: 2.5
        })
    );
    assert_eq!(within(10.0, 0.25, false).verdict, Verdict::Fail);
    assert_eq!(within(-10.0, 1.9, true).verdict, Verdict::Pass);
}

/// Three steps of 0.1 mm are 0.30000000000000003 mm, and 15 J of a striker are 14.999999999999998 J after a square root.
#[test]
fn what_is_equal_but_for_rounding_is_equal() {
    use Comparison::{Equal, Greater, GreaterEqual, Less, LessEqual, NotEqual};
    for (value, limit) in [
        (3.0 * 1e-4, 3e-4),
        (14.999_999_999_999_998, 15.0),
        (0.1 + 0.2, 0.3),
    ] {
        for (value, limit) in [(value, limit), (limit, value), (-value, -limit)] {
            let holds = |comparison| Bound::Compare { comparison, limit }.holds(value);
            let held = [LessEqual, GreaterEqual, Equal, Less, Greater, NotEqual].map(holds);
            assert_eq!(
                held,
                [true, true, true, false, false, false],
                "{value} against {limit}"
            );
            assert_eq!(
                Bound::Compare {
                    comparison: LessEqual,
                    limit
                }
                .margin(value),
                0.0
            );
        }
    }
    assert!(
        Bound::Within {
            target: 1.0,
            tolerance: 0.1
        }
        .holds(1.1),
        "1.1 − 1 is more than 0.1 by its rounding"
    );
    for comparison in [LessEqual, Equal] {
        for limit in [1.0 - 2e-12, f64::NEG_INFINITY] {
            assert!(
                !Bound::Compare { comparison, limit }.holds(1.0),
                "different results are distinguished"
            );
        }
    }
    assert!(
        !Bound::Within {
            target: 1.0,
            tolerance: 0.1
        }
        .holds(1.1 + 1e-11)
    );
    assert!(
        !Bound::Within {
            target: f64::INFINITY,
            tolerance: 0.1
        }
        .holds(1.1)
    );
}

#[test]
fn a_missing_result_is_reported_as_inconclusive() {
    let outcome = assess_condition(
        &condition(result("stop_time"), compare(Comparison::Less, 1.0)),
        DecisionRule::Guarded,
        &record(Outcome::Completed),
    );
    assert_eq!(
        (outcome.verdict, outcome.value, outcome.margin),
        (Verdict::Inconclusive, None, None)
    );
    assert!(outcome.reason.unwrap().contains("stop_time"));
    assert_eq!(
        outcome.bound,
        Some(Bound::Compare {
            comparison: Comparison::Less,
            limit: 1.0
        })
    );
}

#[test]
fn the_whole_takes_its_worst_part_and_the_end_of_the_run() {
    let mut plan = crate::tests::testing::empty_plan();
    let requirement = |limit| Requirement {
        label: "travel".to_owned(),
        conditions: vec![condition(
            result("max_displacement"),
            compare(Comparison::Less, limit),
        )],
    };
    assert_eq!(
        assess(&plan, &record(Outcome::Completed)).verdict,
        Verdict::Completed,
        "nothing was required"
    );
    plan.requirements = vec![requirement(9.0)];
    assert_eq!(
        assess(&plan, &record(Outcome::Completed)).verdict,
        Verdict::Pass
    );
    let blocked = record(Outcome::Blocked {
        reason: String::new(),
    });
    assert_eq!(assess(&plan, &blocked).verdict, Verdict::Inconclusive);
    plan.requirements.push(requirement(7.0));
    assert_eq!(assess(&plan, &blocked).verdict, Verdict::Fail);
    let assessed = assess(&plan, &record(Outcome::Completed));
    assert_eq!(assessed.verdict, Verdict::Fail);
    assert_eq!(assessed.requirements[0].verdict, Verdict::Pass);
    let stopped = assess(
        &plan,
        &record(Outcome::Aborted {
            reason: String::new(),
        }),
    );
    assert_eq!(
        (stopped.verdict, stopped.requirements[1].verdict),
        (Verdict::Aborted, Verdict::Fail)
    );
    assert_eq!(
        assess(
            &plan,
            &record(Outcome::Faulted {
                reason: String::new()
            })
        )
        .verdict,
        Verdict::Error
    );
}

/// If the energy balance error exceeds half of the input, results of the motion are not conclusive; the balance itself is.
#[test]
fn what_a_scheme_made_of_its_energy_decides_nothing() {
    let with = |name, error: ResultValue| {
        let mut record = record(Outcome::Completed);
        let error = NamedResult {
            name,
            value: error,
            dimension: Dimension::NUMBER,
            contributions: Vec::new(),
            withheld: None,
        };
        record.procedures[0].results.push(error);
        record
    };
    let verdict = |record: &Record, name| {
        let wanted = Requirement {
            label: String::new(),
            conditions: vec![condition(result(name), compare(Comparison::LessEqual, 8.5))],
        };
        assess_requirement(&wanted, DecisionRule::Simple, record, record)
    };
    let number = |value| ResultValue::Number {
        value: Some(value),
        uncertainty: None,
    };
    for (error, expected) in [
        (0.49, Verdict::Pass),
        (-0.49, Verdict::Pass),
        (0.51, Verdict::Inconclusive),
        (-94.0, Verdict::Inconclusive),
    ] {
        let record = with("energy_error", number(error));
        let found = verdict(&record, "max_displacement");
        assert_eq!(found.verdict, expected, "{error}");
        assert_eq!(
            found.conditions[0].reason.is_some(),
            expected == Verdict::Inconclusive
        );
        assert_eq!(verdict(&record, "energy_error").verdict, Verdict::Pass);
    }
    assert_eq!(
        verdict(&with("energy_error", number(f64::NAN)), "max_displacement").verdict,
        Verdict::Inconclusive
    );
    let impacts = with("energy_errors", ResultValue::List(vec![0.01, -0.7]));
    assert_eq!(
        verdict(&impacts, "max_displacement").verdict,
        Verdict::Inconclusive
    );
}
