//! Assessment of requirements. In: a [`Plan`] and a [`Record`]. Out: an [`Assessment`]: each
//! requirement with value, limit, margin and, under the guarded rule, guard band. A missed
//! requirement is a verdict, never an error.

mod condition;
mod partial;
mod reproduction;
mod time_step;
mod undecided;
mod unfinished_peaks;

pub use partial::Declared;
use psd_plan::formula::{ProcedureId, Results, UncertaintyStatus};
use psd_plan::record::{ImpactHistory, Outcome, Record};
use psd_plan::{Comparison, Condition, DecisionRule, Plan, Requirement};
use psd_text::units::Dimension;
pub use reproduction::ReproductionOutcome;
pub use time_step::assess_condition;
pub use undecided::unfinished;
use undecided::{beyond, longer_than_critical, unless_undecided};

/// Completed < Pass < Inconclusive < Fail < Aborted < Error; a parent takes its worst child.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// The run is complete and the plan has no requirement: there is nothing to pass.
    Completed,
    Pass,
    /// A result that the requirement reads does not exist in this run, its uncertainty is withheld, or its margin is too small for its
    /// uncertainty. Also a run that could not continue with its measured values.
    Inconclusive,
    Fail,
    /// Stopped by a limit or by the operator.
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
    /// The rule that decided every condition.
    pub rule: DecisionRule,
    pub requirements: Vec<RequirementOutcome>,
    /// Comparisons with published numbers. They do not change the verdict.
    pub reproductions: Vec<ReproductionOutcome>,
}

/// One requirement: the worst of its conditions.
#[derive(Clone, Debug)]
pub struct RequirementOutcome {
    pub label: String,
    pub verdict: Verdict,
    pub conditions: Vec<ConditionOutcome>,
}

/// One condition: its bound, and its margin.
#[derive(Clone, Debug)]
pub struct ConditionOutcome {
    /// As the plan wrote it.
    pub text: String,
    pub verdict: Verdict,
    pub dimension: Dimension,
    /// Whether its numbers are printed in percent.
    pub percent: bool,
    /// SI; None if a result does not exist.
    pub value: Option<f64>,
    pub uncertainty: Option<f64>,
    /// What is known of the uncertainty of the results that it reads.
    pub status: UncertaintyStatus,
    /// Effective degrees of freedom of that uncertainty.
    pub degrees: f64,
    pub bound: Option<Bound>,
    /// Distance inside the bound, SI; negative: exceeded by this amount.
    pub margin: Option<f64>,
    /// w = U = k·u of the margin under the guarded rule, SI. None under the simple rule, for exact values, and if the uncertainty is
    /// unknown.
    pub guard_band: Option<f64>,
    /// Effective degrees of freedom of the uncertainty of the margin, under the guarded rule.
    pub margin_degrees: f64,
    /// Probability of conformity, from the uncertainty of the margin (JCGM 106:2012, 7.1), the smallest in any finer time steps; None if
    /// that is unknown.
    pub conforms: Option<f64>,
    /// Whether the tolerance is narrower than U of the margin.
    pub wider_than_tolerance: bool,
    /// Why it is inconclusive.
    pub reason: Option<String>,
    /// The smallest and the largest value in any finer time steps, SI; None if the time step has no effect on it.
    pub in_finer_steps: Option<[f64; 2]>,
}

/// The bound that the value is compared with, SI.
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

/// Assesses every requirement of the plan against the record. A run that was stopped is at least `Aborted`. A run whose rig failed is an
/// `Error`. This does not depend on the requirements that its results satisfy.
#[must_use]
pub fn assess(plan: &Plan, record: &Record) -> Assessment {
    let rule = plan.decision_rule;
    let results = Declared::of(plan, record);
    let requirements = assess_requirements(&plan.requirements, rule, plan, record);
    let reproductions = plan.reproductions.iter();
    let reproductions = reproductions
        .map(|reproduction| reproduction::compare(reproduction, record, &results))
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
        reproductions,
    }
}

/// Assesses requirements under a decision rule against the record of a run of the plan.
#[must_use]
pub fn assess_requirements(
    requirements: &[Requirement],
    rule: DecisionRule,
    plan: &Plan,
    record: &Record,
) -> Vec<RequirementOutcome> {
    let results = Declared::of(plan, record);
    let assessed = requirements.iter();
    assessed
        .map(|requirement| assess_requirement(requirement, rule, record, &results))
        .collect()
}

/// `results` are those of the record, if their uncertainties are declared.
fn assess_requirement(
    requirement: &Requirement,
    rule: DecisionRule,
    record: &Record,
    results: &dyn Results,
) -> RequirementOutcome {
    let assess = |condition: &Condition| {
        let outcome = assess_condition(condition, rule, results);
        unless_undecided(condition, rule, outcome, record, results)
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

/// Assesses a condition of an impact series against the results of the last impact, which are those of the procedure `own`. Results that
/// are not determined, because the impact ended before its peak, are not conclusive.
pub(crate) fn assess_on_impact(
    condition: &Condition,
    rule: DecisionRule,
    results: &dyn Results,
    own: ProcedureId,
    impact: &ImpactHistory,
) -> ConditionOutcome {
    let outcome = assess_condition(condition, rule, results);
    let steps = (impact.time_step, impact.critical_time_step);
    let longer = (steps.0 > steps.1).then(|| longer_than_critical("the impact", steps.0, steps.1));
    match longer.or_else(|| unfinished_peaks::undecided_by(condition, rule, results, own, impact)) {
        Some(why) => outcome.inconclusive(why),
        None => outcome,
    }
}

#[cfg(test)]
mod guard_band_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod time_step_tests;
