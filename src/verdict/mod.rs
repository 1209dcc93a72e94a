//! Assessment of requirements. In: a [`Plan`] and a [`Record`]. Out: an [`Assessment`]: each
//! requirement with value, limit, margin and, under the guarded rule, guard band. A missed
//! requirement is a verdict, never an error.

mod condition;
mod partial;
mod undecided;
mod unfinished_peaks;

use crate::plan::formula::{ProcedureId, Results};
use crate::plan::{Comparison, Condition, DecisionRule, Plan, Requirement};
use crate::record::{ImpactHistory, Outcome, Record};
use crate::units::Dimension;
pub(crate) use condition::assess_condition;
pub(crate) use partial::Declared;
use undecided::{beyond, longer_than_critical, unless_undecided};

/// Completed < Pass < Inconclusive < Fail < Aborted < Error; a parent takes its worst child.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// The run came to its end and nothing is required of it: there is nothing to pass.
    Completed,
    Pass,
    /// A result that the requirement reads does not exist in this run, or is too near its limit for what is known of it; a run that
    /// could not go on with what it found.
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
            Self::Completed => "completed",
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
    /// By which every condition was decided.
    pub rule: DecisionRule,
    pub requirements: Vec<RequirementOutcome>,
}

/// One requirement: the worst of its conditions.
#[derive(Clone, Debug)]
pub struct RequirementOutcome {
    pub label: String,
    pub verdict: Verdict,
    pub conditions: Vec<ConditionOutcome>,
}

/// One condition: what it was held against, and by how much it holds.
#[derive(Clone, Debug)]
pub struct ConditionOutcome {
    /// As the plan wrote it.
    pub text: String,
    pub verdict: Verdict,
    pub dimension: Dimension,
    /// SI; None where a result does not exist.
    pub value: Option<f64>,
    pub uncertainty: Option<f64>,
    /// Effective degrees of freedom of that uncertainty.
    pub degrees: f64,
    pub bound: Option<Bound>,
    /// Distance inside the bound, SI; negative: missed by so much.
    pub margin: Option<f64>,
    /// w = U = k·u of the margin under the guarded rule, SI; None under the simple one, of what is exact, and where no
    /// uncertainty is known.
    pub guard_band: Option<f64>,
    /// Effective degrees of freedom of the uncertainty of the margin, under the guarded rule.
    pub margin_degrees: f64,
    /// Probability that what was measured conforms, by the uncertainty of the margin (JCGM 106:2012, 7.1); None where none is known.
    pub conforms: Option<f64>,
    /// Whether the tolerance is narrower than U of the margin.
    pub wider_than_tolerance: bool,
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
    let rule = plan.decision_rule;
    let requirements: Vec<_> = plan
        .requirements
        .iter()
        .map(|requirement| {
            assess_requirement(requirement, rule, record, &Declared::of(plan, record))
        })
        .collect();
    let run = match record.outcome {
        Outcome::Completed if beyond(record, |_| true).is_some() => Verdict::Inconclusive,
        Outcome::Blocked { .. } => Verdict::Inconclusive,
        Outcome::Completed => Verdict::Completed,
        Outcome::Aborted { .. } | Outcome::NotReleased { .. } => Verdict::Aborted,
        Outcome::Faulted { .. } => Verdict::Error,
    };
    let verdict = requirements
        .iter()
        .map(|requirement| requirement.verdict)
        .fold(run, Verdict::max);
    Assessment {
        verdict,
        rule,
        requirements,
    }
}

/// `results` are those of the record, as far as their uncertainties are declared.
fn assess_requirement(
    requirement: &Requirement,
    rule: DecisionRule,
    record: &Record,
    results: &dyn Results,
) -> RequirementOutcome {
    let assess = |condition: &Condition| {
        let outcome = assess_condition(condition, rule, results);
        unless_undecided(condition, rule, outcome, (record, results))
    };
    let conditions: Vec<_> = requirement.conditions.iter().map(assess).collect();
    let verdict = conditions
        .iter()
        .map(|condition| condition.verdict)
        .fold(Verdict::Pass, Verdict::max);
    RequirementOutcome {
        label: requirement.label.clone(),
        verdict,
        conditions,
    }
}

/// Holds a condition of a row of blows against the results of the blow that is just over, those of the procedure `own`: what a
/// blow leaves open that was cut before its peak decides nothing.
pub(crate) fn assess_on_blow(
    condition: &Condition,
    rule: DecisionRule,
    results: &dyn Results,
    (own, blow): (ProcedureId, &ImpactHistory),
) -> ConditionOutcome {
    let outcome = assess_condition(condition, rule, results);
    let steps = (blow.time_step, blow.critical_time_step);
    let longer = (steps.0 > steps.1).then(|| longer_than_critical("the blow", steps.0, steps.1));
    match longer.or_else(|| unfinished_peaks::undecided_by(condition, rule, results, (own, blow))) {
        Some(why) => ConditionOutcome {
            verdict: Verdict::Inconclusive,
            reason: Some(why),
            ..outcome
        },
        None => outcome,
    }
}

#[cfg(test)]
mod guard_band_tests;
#[cfg(test)]
mod tests;
