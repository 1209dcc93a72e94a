//! Guard bands and probabilities of conformity, under both decision rules.

use super::tests::{compare, condition, outcome_of, record, result};
use super::*;
use psd_plan::formula::{Formula, ResultValue};
use psd_plan::record::{NamedResult, Outcome, Record};
use psd_plan::{Comparison, DecisionRule, Requirement, Test};
use psd_text::units::Dimension;

/// A condition on 8.0 with u = 0.125: w = 0.25, and every number here is exact in binary.
fn guarded(test: Test) -> ConditionOutcome {
    let mut record = record(Outcome::Completed);
    record.procedures[0].results[0].value = ResultValue::Number {
        value: Some(8.0),
        uncertainty: Some(0.125),
    };
    assess_condition(
        &condition(result("max_displacement"), test),
        DecisionRule::Guarded,
        &record,
    )
}

#[test]
fn between_pass_and_fail_lies_a_guard_band_of_two_standard_uncertainties() {
    use Comparison::{Equal, Greater, GreaterEqual, Less, LessEqual, NotEqual};
    use Verdict::{Fail, Inconclusive, Pass};
    let cases = [
        // At least w inside: pass. At exactly w only if the limit itself would be accepted.
        (LessEqual, 8.25, Pass),
        (Less, 8.25, Inconclusive),
        (Less, 8.375, Pass),
        (LessEqual, 8.125, Inconclusive),
        (LessEqual, 8.0, Inconclusive),
        // Outside by exactly w is not more than w.
        (LessEqual, 7.75, Inconclusive),
        (LessEqual, 7.625, Fail),
        (GreaterEqual, 7.75, Pass),
        (Greater, 7.75, Inconclusive),
        (Greater, 7.625, Pass),
        (GreaterEqual, 8.25, Inconclusive),
        (GreaterEqual, 8.375, Fail),
        // An uncertain value cannot be shown to be equal, and only values farther apart are shown to be unequal.
        (Equal, 8.0, Inconclusive),
        (Equal, 8.375, Fail),
        (NotEqual, 8.25, Inconclusive),
        (NotEqual, 8.375, Pass),
    ];
    for (comparison, limit, verdict) in cases {
        let outcome = guarded(compare(comparison, limit));
        assert_eq!(
            (outcome.verdict, outcome.guard_band),
            (verdict, Some(0.25)),
            "8 {comparison:?} {limit}"
        );
        assert_eq!(outcome.reason.is_some(), verdict == Inconclusive);
    }
}

#[test]
fn a_tolerance_narrower_than_the_band_is_never_kept() {
    let within = |target, tolerance, relative| {
        let test = Test::Within {
            target: Formula::Constant(target),
            tolerance: Formula::Constant(tolerance),
            relative,
        };
        guarded(test).verdict
    };
    assert_eq!(within(8.0, 0.25, false), Verdict::Pass);
    assert_eq!(within(8.0, 0.125, false), Verdict::Inconclusive);
    assert_eq!(
        [8.5, 7.5].map(|target| within(target, 0.75, false)),
        [Verdict::Pass; 2]
    );
    assert_eq!(
        [8.5, 7.5].map(|target| within(target, 0.25, false)),
        [Verdict::Inconclusive; 2]
    );
    assert_eq!(
        [8.5, 7.5].map(|target| within(target, 0.125, false)),
        [Verdict::Fail; 2]
    );
    assert_eq!(within(10.0, 0.225, true), Verdict::Pass);
    assert_eq!(within(10.0, 0.2, true), Verdict::Inconclusive);
}

/// If the uncertainty is known to be zero, or the result is exact by definition, the value alone is compared. If the uncertainty is
/// unknown, the condition is inconclusive, far from the limit as well as near it.
#[test]
fn a_guard_band_needs_an_uncertainty_that_is_known() {
    let mut record = record(Outcome::Completed);
    let exact = |name, value| NamedResult {
        name,
        value: ResultValue::Number {
            value: Some(value),
            uncertainty: None,
        },
        dimension: Dimension::NUMBER,
        contributions: Vec::new(),
        withheld: None,
    };
    record.procedures[0]
        .results
        .extend([exact("steps", 20.0), exact("energy_error", 0.01)]);
    let at = |record: &Record, name, limit| {
        let condition = condition(result(name), compare(Comparison::LessEqual, limit));
        assess_condition(&condition, DecisionRule::Guarded, record)
    };
    record.procedures[0].results[0].value = ResultValue::Number {
        value: Some(8.0),
        uncertainty: Some(0.0),
    };
    assert_eq!(
        (
            at(&record, "max_displacement", 8.0).verdict,
            at(&record, "max_displacement", 8.0).guard_band
        ),
        (Verdict::Pass, None)
    );
    assert_eq!(
        at(&record, "max_displacement", 7.999).verdict,
        Verdict::Fail
    );
    assert_eq!(
        [20.0, 19.0].map(|limit| at(&record, "steps", limit).verdict),
        [Verdict::Pass, Verdict::Fail]
    );
    assert_eq!(at(&record, "energy_error", 0.02).verdict, Verdict::Pass);
    record.procedures[0].results[0].value = ResultValue::Number {
        value: Some(8.0),
        uncertainty: None,
    };
    for limit in [8.0, 800.0, 0.08] {
        let found = at(&record, "max_displacement", limit);
        assert_eq!(
            (found.verdict, found.guard_band),
            (Verdict::Inconclusive, None),
            "{limit}"
        );
        assert_eq!(
            found.reason.unwrap(),
            "no uncertainty of `max_displacement` is known, but a guard band requires one"
        );
    }
    let simple = condition(
        result("max_displacement"),
        compare(Comparison::LessEqual, 8.5),
    );
    assert_eq!(
        assess_condition(&simple, DecisionRule::Simple, &record).verdict,
        Verdict::Pass
    );
}

/// A known uncertainty of any size decides nothing near its limit; an uncertainty that was lost decides nothing at any distance. `==` and
/// `!=` compare numbers. A budget that the plan leaves partial decides on the value alone under simple acceptance, as an exact value does.
#[test]
fn a_withheld_uncertainty_decides_nothing_under_either_rule() {
    use Comparison::{Equal, Greater, LessEqual, NotEqual};
    let mut withheld = record(Outcome::Completed);
    withheld.procedures[0].results[0].withhold("errors grow");
    assert_eq!(
        withheld.procedures[0].results[0].value,
        ResultValue::Number {
            value: Some(8.0),
            uncertainty: None
        }
    );
    let outcome = |comparison, limit, rule| {
        let condition = condition(result("max_displacement"), compare(comparison, limit));
        assess_condition(&condition, rule, &withheld)
    };
    for rule in [DecisionRule::Simple, DecisionRule::Guarded] {
        for (comparison, limit) in [(LessEqual, 800.0), (LessEqual, 0.08), (Greater, 8.0)] {
            let found = outcome(comparison, limit, rule);
            assert_eq!(
                (found.verdict, found.guard_band, found.conforms),
                (Verdict::Inconclusive, None, None),
                "{comparison:?} {limit}"
            );
            assert_eq!(
                found.reason.as_deref(),
                Some("U of `max_displacement` is withheld: errors grow")
            );
        }
    }
    assert_eq!(
        [(Equal, 8.0), (NotEqual, 8.0)].map(|(comparison, limit)| outcome(
            comparison,
            limit,
            DecisionRule::Simple
        )
        .verdict),
        [Verdict::Pass, Verdict::Fail]
    );
    let mut undeclared = record(Outcome::Completed);
    undeclared.procedures[0].results[0].value = ResultValue::Number {
        value: Some(8.0),
        uncertainty: None,
    };
    let condition = condition(
        result("max_displacement"),
        compare(Comparison::LessEqual, 8.5),
    );
    let found = assess_condition(&condition, DecisionRule::Simple, &undeclared);
    assert!(found.verdict == Verdict::Pass && found.decides_without_uncertainty());
}

/// 8 with u = 0.125 (normal): at its limit 50 %, one u inside 84.1 %; between limits of ±0.125 it is 68.3 %, and U exceeds the limits.
#[test]
fn a_probability_of_conformity_is_reported_under_either_rule() {
    let mut record = record(Outcome::Completed);
    record.procedures[0].results[0].value = ResultValue::Number {
        value: Some(8.0),
        uncertainty: Some(0.125),
    };
    for rule in [DecisionRule::Simple, DecisionRule::Guarded] {
        let of = |test| {
            let found =
                assess_condition(&condition(result("max_displacement"), test), rule, &record);
            (found.conforms.unwrap(), found.wider_than_tolerance)
        };
        let near = |found: (f64, bool), p: f64, wider| {
            assert!(
                (found.0 - p).abs() < 1e-6 && found.1 == wider,
                "{found:?}, not {p}"
            );
        };
        near(of(compare(Comparison::LessEqual, 8.0)), 0.5, false);
        near(
            of(compare(Comparison::LessEqual, 8.125)),
            0.841_344_7,
            false,
        );
        near(of(compare(Comparison::Greater, 8.125)), 0.158_655_3, false);
        let within = |tolerance| Test::Within {
            target: Formula::Constant(8.0),
            tolerance: Formula::Constant(tolerance),
            relative: false,
        };
        near(of(within(0.125)), 0.682_689_5, true);
        near(of(within(0.25)), 0.954_499_7, false);
        near(of(within(0.5)), 0.999_936_7, false);
    }
    record.procedures[0].results[0].value = ResultValue::Number {
        value: Some(8.0),
        uncertainty: None,
    };
    let unknown = condition(
        result("max_displacement"),
        compare(Comparison::LessEqual, 8.5),
    );
    assert_eq!(
        assess_condition(&unknown, DecisionRule::Simple, &record).conforms,
        None
    );
}

/// 8 with u = 0.125 (normal): between limits of ±0.05 it lies with 2Φ(0.4) − 1 = 31.1 %, between ±0.125 with 68.3 %. Simple acceptance
/// decides what is more likely right than wrong. Beside one limit, and outside of a tolerance, every verdict is.
#[test]
fn a_pass_that_is_more_likely_wrong_than_right_is_inconclusive() {
    use Verdict::{Fail, Inconclusive, Pass};
    let mut record = record(Outcome::Completed);
    record.procedures[0].results[0].value = ResultValue::Number {
        value: Some(8.0),
        uncertainty: Some(0.125),
    };
    let of =
        |test, rule| assess_condition(&condition(result("max_displacement"), test), rule, &record);
    let within = |target, tolerance| Test::Within {
        target: Formula::Constant(target),
        tolerance: Formula::Constant(tolerance),
        relative: false,
    };
    for (test, verdict, probability) in [
        (within(8.0, 0.05), Inconclusive, 0.310_843),
        (within(8.0, 0.125), Pass, 0.682_689),
        // The nearer end of the tolerance alone: Φ(0) − Φ(−0.8).
        (within(8.05, 0.05), Inconclusive, 0.288_145),
        (within(8.5, 0.5), Pass, 0.5),
        (within(8.1, 0.05), Fail, 0.229_508),
        (compare(Comparison::LessEqual, 8.0), Pass, 0.5),
        (compare(Comparison::Less, 8.0), Fail, 0.5),
    ] {
        let found = of(test.clone(), DecisionRule::Simple);
        assert_eq!(found.verdict, verdict, "{test:?}");
        assert!(
            (found.conforms.unwrap() - probability).abs() < 1e-6,
            "{test:?}: {found:?}"
        );
        let too_large = "U is too large for this tolerance";
        assert_eq!(
            found.reason.as_deref(),
            (verdict == Inconclusive).then_some(too_large)
        );
        assert_ne!(of(test, DecisionRule::ValueAlone).verdict, Inconclusive);
    }
}

/// On a real rig, a budget without both calibrations gives no guard band; on a simulated rig it gives one.
#[test]
fn a_partial_budget_of_a_real_rig_gives_no_guard_band() {
    let mut plan = crate::tests::fault_table::stage::plan();
    plan.decision_rule = DecisionRule::Guarded;
    plan.requirements = vec![Requirement {
        label: "travel".to_owned(),
        conditions: vec![condition(
            result("max_displacement"),
            compare(Comparison::LessEqual, 9.0),
        )],
    }];
    let record = record(Outcome::Completed);
    plan.rig.calibration = psd_plan::Calibration {
        force_uncertainty: 0.01,
        ..psd_plan::Calibration::default()
    };
    let partial = assess(&plan, &record);
    assert_eq!(partial.verdict, Verdict::Inconclusive);
    assert_eq!(
        partial.requirements[0].conditions[0].reason.as_deref(),
        Some(
            "the budget of `max_displacement` is partial (not declared in the plan: displacement calibration)"
        )
    );
    plan.rig.calibration.displacement_uncertainty = 0.01;
    assert_eq!(assess(&plan, &record).verdict, Verdict::Pass);
    plan.rig = crate::tests::testing::empty_plan().rig;
    assert_eq!(assess(&plan, &record).verdict, Verdict::Pass);
}

#[test]
fn a_limit_that_was_measured_widens_the_band_and_the_same_result_on_both_sides_does_not() {
    let limit = |factor: f64| {
        let product = Formula::Binary(
            psd_plan::formula::Operator::Multiply,
            Box::new(Formula::Constant(factor)),
            Box::new(result("max_displacement")),
        );
        guarded(Test::Compare {
            comparison: Comparison::LessEqual,
            limit: product,
        })
    };
    // 8 ≤ 2·8: the distance is the result itself, and so is its uncertainty. 8 ≤ 3·8: twice that.
    assert_eq!(
        [2.0, 3.0].map(|factor| limit(factor).guard_band),
        [Some(0.25), Some(0.5)]
    );
    assert_eq!(
        (limit(1.0).guard_band, limit(1.0).verdict),
        (None, Verdict::Pass)
    );
}

#[test]
fn the_simple_rule_knows_no_band() {
    let outcome = outcome_of(compare(Comparison::LessEqual, 8.0));
    assert_eq!((outcome.verdict, outcome.guard_band), (Verdict::Pass, None));
    assert!(outcome.uncertainty.is_some());
}
