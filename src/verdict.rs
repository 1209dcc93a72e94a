//! Requirements against the record. In: a [`Plan`] and a [`Record`]. Out: an [`Assessment`], every requirement with
//! value, limit and margin. A missed requirement is a verdict, never an error.

use crate::formula::{Formula, FormulaError, Results};
use crate::plan::{Comparison, Condition, Plan, Requirement, Test};
use crate::quantity::Dimension;
use crate::record::{Outcome, Record};

/// Pass < Inconclusive < Fail < Aborted < Error; a parent takes its worst child.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    Pass,
    /// A result that the requirement reads does not exist in this run.
    Inconclusive,
    Fail,
    /// Stopped by a limit or by a person.
    Aborted,
    /// The rig failed.
    Error,
}

impl Verdict {
    /// As in `summary.json`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Inconclusive => "inconclusive",
            Self::Fail => "fail",
            Self::Aborted => "aborted",
            Self::Error => "error",
        }
    }
}

/// The verdict on a whole run.
#[derive(Clone, Debug)]
pub struct Assessment {
    pub verdict: Verdict,
    pub requirements: Vec<RequirementOutcome>,
}

/// One requirement: the worst of its conditions.
#[derive(Clone, Debug)]
pub struct RequirementOutcome {
    pub label: String,
    pub verdict: Verdict,
    pub conditions: Vec<ConditionOutcome>,
}

#[derive(Clone, Debug)]
pub struct ConditionOutcome {
    /// As the plan wrote it.
    pub text: String,
    pub verdict: Verdict,
    pub dimension: Dimension,
    /// SI; None where a result does not exist.
    pub value: Option<f64>,
    pub uncertainty: Option<f64>,
    pub bound: Option<Bound>,
    /// Distance inside the bound, SI; negative: missed by so much.
    pub margin: Option<f64>,
    /// Why it is inconclusive.
    pub reason: Option<String>,
}

/// What the value was held against, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    Compare {
        comparison: Comparison,
        limit: f64,
    },
    /// |value − target| ≤ tolerance
    Within {
        target: f64,
        tolerance: f64,
    },
}

/// Holds every requirement of the plan against the record. A run that was stopped is at least Aborted, one whose rig
/// failed an Error, whatever its requirements say of the results it has.
#[must_use]
pub fn assess(plan: &Plan, record: &Record) -> Assessment {
    let requirements: Vec<_> = plan.requirements.iter().map(|requirement| assess_requirement(requirement, record)).collect();
    let run = match record.outcome {
        Outcome::Completed => Verdict::Pass,
        Outcome::Aborted { .. } => Verdict::Aborted,
        Outcome::Faulted { .. } => Verdict::Error,
    };
    let verdict = requirements.iter().map(|requirement| requirement.verdict).fold(run, Verdict::max);
    Assessment { verdict, requirements }
}

fn assess_requirement(requirement: &Requirement, record: &Record) -> RequirementOutcome {
    let conditions: Vec<_> = requirement.conditions.iter().map(|condition| assess_condition(condition, record)).collect();
    let verdict = conditions.iter().map(|condition| condition.verdict).fold(Verdict::Pass, Verdict::max);
    RequirementOutcome { label: requirement.label.clone(), verdict, conditions }
}

/// Value and bound are evaluated each on its own, so that a report shows whichever exists.
pub(crate) fn assess_condition(condition: &Condition, record: &dyn Results) -> ConditionOutcome {
    let value = condition.value.evaluate(record, None);
    let bound = evaluate_bound(&condition.test, record);
    let known = match (&value, &bound) {
        (Ok(value), Ok(bound)) => Some((value.value, *bound)),
        _ => None,
    };
    let verdict = match known {
        Some((value, bound)) if bound.holds(value) => Verdict::Pass,
        Some(_) => Verdict::Fail,
        None => Verdict::Inconclusive,
    };
    ConditionOutcome {
        text: condition.text.clone(),
        verdict,
        dimension: condition.dimension,
        value: value.as_ref().ok().map(|value| value.value),
        uncertainty: value.as_ref().ok().and_then(|value| value.uncertainty),
        bound: bound.as_ref().ok().copied(),
        margin: known.map(|(value, bound)| bound.margin(value)),
        reason: value.err().or(bound.err()).map(|error| error.to_string()),
    }
}

fn evaluate_bound(test: &Test, record: &dyn Results) -> Result<Bound, FormulaError> {
    let number = |formula: &Formula| formula.evaluate(record, None).map(|estimate| estimate.value);
    Ok(match test {
        Test::Compare { comparison, limit } => Bound::Compare { comparison: *comparison, limit: number(limit)? },
        Test::Within { target, tolerance, relative } => {
            let target = number(target)?;
            let tolerance = number(tolerance)? * if *relative { target.abs() } else { 1.0 };
            Bound::Within { target, tolerance }
        }
    })
}

impl Bound {
    /// Whether `value` (SI) meets it.
    #[must_use]
    pub fn holds(self, value: f64) -> bool {
        match self {
            Self::Compare { comparison, limit } => match comparison {
                Comparison::Less => value < limit,
                Comparison::LessEqual => value <= limit,
                Comparison::Greater => value > limit,
                Comparison::GreaterEqual => value >= limit,
                Comparison::Equal => value == limit,
                Comparison::NotEqual => value != limit,
            },
            Self::Within { target, tolerance } => (value - target).abs() <= tolerance,
        }
    }

    /// Distance of `value` inside the bound; negative: missed by so much. Equality has nothing inside it, inequality
    /// nothing outside.
    #[must_use]
    pub fn margin(self, value: f64) -> f64 {
        match self {
            Self::Compare { comparison, limit } => match comparison {
                Comparison::Less | Comparison::LessEqual => limit - value,
                Comparison::Greater | Comparison::GreaterEqual => value - limit,
                // 0 − |…|, not −|…|: a report should not show −0.
                Comparison::Equal => 0.0 - (value - limit).abs(),
                Comparison::NotEqual => (value - limit).abs(),
            },
            Self::Within { target, tolerance } => tolerance - (value - target).abs(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formula::{Part, ProcedureId, ResultReference, ResultValue};
    use crate::record::{History, NamedResult, ProcedureRecord};
    use crate::rig::Identity;

    fn record(outcome: Outcome) -> Record {
        let number = |name, value, uncertainty| NamedResult {
            name,
            value: ResultValue::Number { value, uncertainty },
            dimension: Dimension::LENGTH,
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
                results: vec![number("max_displacement", Some(8.0), Some(0.1)), number("stop_time", None, None)],
                history: History::Inspect,
            }],
            events: Vec::new(),
            outcome,
        }
    }

    fn result(name: &'static str) -> Formula {
        Formula::Result(ResultReference { procedure: ProcedureId(0), name, part: Part::Value })
    }

    fn condition(value: Formula, test: Test) -> Condition {
        Condition { text: "as written".to_owned(), value, test, dimension: Dimension::LENGTH }
    }

    fn compare(comparison: Comparison, limit: f64) -> Test {
        Test::Compare { comparison, limit: Formula::Constant(limit) }
    }

    fn outcome_of(test: Test) -> ConditionOutcome {
        assess_condition(&condition(result("max_displacement"), test), &record(Outcome::Completed))
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
            outcome_of(Test::Within { target: Formula::Constant(target), tolerance: Formula::Constant(tolerance), relative })
        };
        let near = within(10.0, 0.25, true);
        assert_eq!((near.verdict, near.margin), (Verdict::Pass, Some(0.5)));
        assert_eq!(near.bound, Some(Bound::Within { target: 10.0, tolerance: 2.5 }));
        assert_eq!(within(10.0, 0.25, false).verdict, Verdict::Fail);
        assert_eq!(within(-10.0, 1.9, true).verdict, Verdict::Pass);
    }

    #[test]
    fn a_missing_result_is_inconclusive_and_says_so() {
        let outcome =
            assess_condition(&condition(result("stop_time"), compare(Comparison::Less, 1.0)), &record(Outcome::Completed));
        assert_eq!((outcome.verdict, outcome.value, outcome.margin), (Verdict::Inconclusive, None, None));
        assert!(outcome.reason.unwrap().contains("stop_time"));
        assert_eq!(outcome.bound, Some(Bound::Compare { comparison: Comparison::Less, limit: 1.0 }));
    }

    #[test]
    fn the_whole_takes_its_worst_part_and_the_end_of_the_run() {
        let mut plan = crate::run::testing::empty_plan();
        let requirement = |limit| Requirement {
            label: "travel".to_owned(),
            conditions: vec![condition(result("max_displacement"), compare(Comparison::Less, limit))],
        };
        assert_eq!(assess(&plan, &record(Outcome::Completed)).verdict, Verdict::Pass);
        plan.requirements = vec![requirement(9.0), requirement(7.0)];
        let assessed = assess(&plan, &record(Outcome::Completed));
        assert_eq!(assessed.verdict, Verdict::Fail);
        assert_eq!(assessed.requirements[0].verdict, Verdict::Pass);
        let stopped = assess(&plan, &record(Outcome::Aborted { reason: String::new() }));
        assert_eq!((stopped.verdict, stopped.requirements[1].verdict), (Verdict::Aborted, Verdict::Fail));
        assert_eq!(assess(&plan, &record(Outcome::Faulted { reason: String::new() })).verdict, Verdict::Error);
    }
}
