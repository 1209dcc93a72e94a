//! Conditions that finer time steps change, and those that they do not.

use super::tests::{compare, condition, record, result};
use super::*;
use psd_plan::formula::{Formula, Operator};
use psd_plan::record::NamedResult;
use psd_plan::uncertainty::{Contribution, Refinement, Source};
use psd_plan::{Comparison, Test};

/// 8 m with u = 1/16 m in own steps; the time step has an effect of first order, −0.5 and −0.75 m. So the ends are −1.5 m and 0.
fn stepped(size: f64) -> Record {
    let mut record = record(Outcome::Completed);
    let part = |steps, amount: f64| Contribution::new(Source::TimeStep(steps), size * amount);
    let own: &mut NamedResult = &mut record.procedures[0].results[0];
    own.contributions = vec![
        Contribution::new(Source::StrikerMass(0), 0.0625),
        part(Refinement::Half, -0.5),
        part(Refinement::Quarter, -0.75),
    ];
    let mut step = own.clone();
    step.name = "time_step";
    step.dimension = Dimension::TIME;
    step.contributions.clear();
    step.value = psd_plan::formula::ResultValue::Number {
        value: Some(1e-3),
        uncertainty: None,
    };
    record.procedures[0].results.push(step);
    record
}

fn decided(value: Formula, test: Test, rule: DecisionRule, size: f64) -> ConditionOutcome {
    assess_condition(&condition(value, test), rule, &stepped(size))
}

#[test]
fn a_decision_that_finer_steps_change_is_none() {
    use Comparison::{Equal, GreaterEqual, LessEqual};
    use DecisionRule::{Guarded, Simple, ValueAlone};
    use Verdict::{Fail, Inconclusive, Pass};
    let cases = [
        // (comparison, limit, rule, size of the effect, verdict, recommended step)
        (LessEqual, 8.5, Simple, 1.0, Pass, None),
        (GreaterEqual, 6.25, Simple, 1.0, Pass, None),
        (GreaterEqual, 8.5, Simple, 1.0, Fail, None),
        (LessEqual, 6.25, Simple, 1.0, Fail, None),
        // The value is above, all finer ones are below.
        (
            GreaterEqual,
            7.75,
            Simple,
            1.0,
            Inconclusive,
            Some("0.5 ms"),
        ),
        (LessEqual, 7.75, Simple, 1.0, Inconclusive, Some("0.5 ms")),
        // From the quarter on.
        (
            GreaterEqual,
            7.375,
            Simple,
            1.0,
            Inconclusive,
            Some("0.25 ms"),
        ),
        // Only the bound of still finer steps is on the other side: 1.5 m wide, 0.25 m away.
        (
            GreaterEqual,
            7.0,
            Simple,
            1.0,
            Inconclusive,
            Some("0.125 ms"),
        ),
        // The guard band, 0.125 m, counts at every step.
        (GreaterEqual, 6.5, Simple, 1.0, Pass, None),
        (
            GreaterEqual,
            6.4375,
            Guarded,
            1.0,
            Inconclusive,
            Some("0.125 ms"),
        ),
        (GreaterEqual, 6.25, Guarded, 1.0, Pass, None),
        (LessEqual, 6.25, Guarded, 1.0, Fail, None),
        // In the other direction.
        (LessEqual, 8.25, Simple, -1.0, Inconclusive, Some("0.5 ms")),
        (LessEqual, 9.75, Simple, -1.0, Pass, None),
        // No effect, an equality of the numbers of the run, and a published number.
        (GreaterEqual, 7.75, Simple, 0.0, Pass, None),
        (Equal, 8.0, Simple, 1.0, Pass, None),
        (GreaterEqual, 7.75, ValueAlone, 1.0, Pass, None),
    ];
    for (comparison, limit, rule, size, verdict, step) in cases {
        let outcome = decided(
            result("max_displacement"),
            compare(comparison, limit),
            rule,
            size,
        );
        let case = format!(
            "{comparison:?} {limit}, {rule:?}, {size}: {:?}",
            outcome.reason
        );
        assert_eq!(outcome.verdict, verdict, "{case}");
        let reason = outcome.reason.unwrap_or_default();
        assert_eq!(
            reason.contains("the time step decides"),
            step.is_some(),
            "{case}"
        );
        assert!(
            step.is_none_or(|step| reason.ends_with(&format!("{step} or less"))),
            "{case}"
        );
        assert_eq!(
            (outcome.value, outcome.uncertainty),
            (Some(8.0), Some(0.0625))
        );
    }
}

/// The value and U remain those of the run. The interval is beside them, and the probability is the smallest.
#[test]
fn the_interval_is_beside_the_value() {
    let travels = |size| {
        let test = compare(Comparison::GreaterEqual, 6.4375);
        decided(result("max_displacement"), test, DecisionRule::Simple, size)
    };
    let found = travels(1.0);
    assert_eq!(found.in_finer_steps, Some([6.5, 8.0]));
    // 6.5 m is one standard uncertainty from the limit.
    assert!(
        (found.conforms.unwrap() - 0.841_344_7).abs() < 1e-6,
        "{found:?}"
    );
    assert_eq!(travels(0.0).in_finer_steps, None);
}

/// Results of one re-integration belong together: their difference does not follow the time step, however much each of them does.
#[test]
fn results_of_one_integration_are_decided_together() {
    let binary = |operator, a, b| Formula::Binary(operator, Box::new(a), Box::new(b));
    let read = || result("max_displacement");
    let test = compare(Comparison::LessEqual, 0.0);
    let none = decided(
        binary(Operator::Subtract, read(), read()),
        test,
        DecisionRule::Simple,
        1.0,
    );
    assert_eq!(
        (none.verdict, none.in_finer_steps),
        (Verdict::Pass, Some([0.0, 0.0]))
    );
    let relative = compare(Comparison::GreaterEqual, 0.9);
    let ratio = binary(Operator::Divide, read(), Formula::Constant(8.0));
    let found = decided(ratio, relative, DecisionRule::Simple, 1.0);
    assert_eq!(
        (found.verdict, found.in_finer_steps),
        (Verdict::Inconclusive, Some([0.8125, 1.0]))
    );
}
