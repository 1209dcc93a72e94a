//! Assessment of requirements. In: a [`Plan`] and a [`Record`]. Out: an [`Assessment`]: each
//! requirement with value, limit, margin and, under the guarded rule, guard band. A missed
//! requirement is a verdict, never an error.

mod partial;
mod unfinished_peaks;

use crate::physics::impact::energy::WORTHLESS;
use crate::physics::statistics::student_t;
use crate::plan::formula::{
    Formula, FormulaError, Operator, Part, ProcedureId, ResultReference, ResultValue, Results,
};
use crate::plan::{Comparison, Condition, DecisionRule, Plan, Requirement, Test};
use crate::record::{Beyond, ImpactHistory, Outcome, ProcedureRecord, Record};
use crate::rig::safety::failpoint;
use crate::rig::safety::failpoint::Guarding;
use crate::uncertainty::{FEW, Known, known};
use crate::units::Dimension;
use crate::units::display::stated;
pub(crate) use partial::Declared;

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
        unless_doubtful(condition, rule, outcome, (record, results))
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

/// A result that a condition reads: of which procedure, and its name.
type Read<'a> = (&'a ProcedureRecord, &'static str);

/// What was reckoned and yet decides nothing is inconclusive, and says why.
fn unless_doubtful(
    condition: &Condition,
    rule: DecisionRule,
    outcome: ConditionOutcome,
    (record, results): (&Record, &dyn Results),
) -> ConditionOutcome {
    let mut references = Vec::new();
    condition.collect_references(&mut references);
    let procedure = |reference: &ResultReference| {
        Some((
            record.procedures.get(reference.procedure.0)?,
            reference.name,
        ))
    };
    let read: Vec<Read<'_>> = references.iter().filter_map(procedure).collect();
    let unfinished = || {
        let no_peak = || {
            unfinished_peaks::undecided(condition, rule, results, |procedure| {
                record
                    .procedures
                    .get(procedure.0)
                    .map(|procedure| (&procedure.history, procedure.name.as_str()))
            })
        };
        match cut_short(&read)
            .or_else(|| unbalanced(&read))
            .or_else(|| above_critical(&read))
        {
            Some(why) => Some(outcome.reason.clone().unwrap_or(why)),
            None => no_peak(),
        }
    };
    match drifted(&read, record).or_else(unfinished) {
        Some(reason) => ConditionOutcome {
            verdict: Verdict::Inconclusive,
            reason: Some(reason),
            ..outcome
        },
        None => outcome,
    }
}

/// What a procedure came to that did not run to its end decides nothing: a largest value may still have grown.
fn cut_short(read: &[Read<'_>]) -> Option<String> {
    let (procedure, _) = read.iter().find(|(procedure, _)| !procedure.complete)?;
    Some(format!("{} did not run to its end", procedure.name))
}

/// Results that neither a balance of energy nor the length of the steps says anything of: what is given, and the balance itself.
const BESIDE_THE_BALANCE: [&str; 7] = [
    "energy_error",
    "energy_errors",
    "time_step",
    "critical_time_step",
    "steps",
    "periods",
    "levels",
];

/// What a scheme made of a run whose energy does not close by half of what was put in is no motion of the specimen.
fn unbalanced(read: &[Read<'_>]) -> Option<String> {
    let told =
        |(procedure, result): &&Read<'_>| !BESIDE_THE_BALANCE.contains(result) && off(procedure);
    let (procedure, _) = read.iter().find(told)?;
    Some(format!(
        "the energy balance of {} is off by more than half of what was put in",
        procedure.name
    ))
}

/// Steps longer than the critical one do not follow the motion: what they come to is none of the specimen's.
fn above_critical(read: &[Read<'_>]) -> Option<String> {
    let of = |(procedure, result): &Read<'_>| {
        let (step, critical) = procedure
            .history
            .above_critical()
            .filter(|_| !BESIDE_THE_BALANCE.contains(result))?;
        Some(longer_than_critical(&procedure.name, step, critical))
    };
    read.iter().find_map(of)
}

/// That steps (s) are longer than the critical one (s).
fn longer_than_critical(name: &str, step: f64, critical: f64) -> String {
    let (step, critical) = (
        stated(step, Dimension::TIME),
        stated(critical, Dimension::TIME),
    );
    format!("the time step of {name}, {step}, is above the critical one, {critical} (W701)")
}

/// Whether the balance of a procedure, or of one of its blows, is off by more than it may be.
fn off(procedure: &ProcedureRecord) -> bool {
    let found = |name| {
        procedure
            .results
            .iter()
            .find(|result| result.name == name)
            .map(|result| &result.value)
    };
    let beyond = |error: &f64| error.is_nan() || error.abs() > WORTHLESS;
    match found("energy_error").or_else(|| found("energy_errors")) {
        Some(ResultValue::Number { value, .. }) => value.as_ref().is_none_or(beyond),
        Some(ResultValue::List(errors)) => errors.iter().any(beyond),
        None => false,
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

/// What readings entered whose zero drifted farther than the rig allows decides nothing: they were not of what they seemed to be.
fn drifted(read: &[Read<'_>], record: &Record) -> Option<String> {
    let reason = |(procedure, result): &Read<'_>| {
        beyond(record, |beyond| {
            enters(beyond.of_force, procedure.kind, result)
        })
        .map(|beyond| beyond.reason)
    };
    read.iter().find_map(reason)
}

/// The first drift beyond what the rig allows that is `of_interest`.
fn beyond(record: &Record, of_interest: impl Fn(&Beyond) -> bool) -> Option<Beyond> {
    let drift = record
        .drift
        .as_ref()
        .filter(|_| failpoint::on(Guarding::ZeroDrift))?;
    drift.all_beyond().find(of_interest)
}

/// Whether readings of the force, or else of the displacement, enter a result. Everything that a procedure integrates or
/// fits hangs on both; where the force only follows, it enters none of the ways and speeds.
fn enters(of_force: bool, kind: &str, result: &str) -> bool {
    let given = matches!(result, "time_step" | "steps");
    let of_ways = matches!(
        (kind, result),
        ("stiffness ramp", "max_displacement") | ("damping sweep", "max_velocity")
    );
    !(given || (of_force && of_ways))
}

/// Value and bound are evaluated each on its own, so that a report shows whichever exists.
pub(crate) fn assess_condition(
    condition: &Condition,
    rule: DecisionRule,
    record: &dyn Results,
) -> ConditionOutcome {
    let value = condition.value.evaluate(record, None);
    let bound = evaluate_bound(&condition.test, record);
    let known = match (&value, &bound) {
        (Ok(value), Ok(bound)) => Some((value.value, *bound)),
        _ => None,
    };
    let lacking = no_uncertainty(condition, record);
    let distance_known =
        known.and_then(|(value, bound)| margin_known(condition, value, bound, record));
    let (margin_known, unguarded) = match rule {
        DecisionRule::Simple => (None, None),
        DecisionRule::Guarded => (distance_known, lacking.clone()),
    };
    let told = distance_known.filter(|_| lacking.is_none());
    let conforms = known
        .zip(told)
        .map(|((value, bound), told)| bound.conforms(value, told));
    let wider_than_tolerance = known
        .zip(told)
        .is_some_and(|((_, bound), told)| match bound {
            Bound::Within { tolerance, .. } => told.expanded() > tolerance,
            Bound::Compare { .. } => false,
        });
    let guard_band = margin_known
        .filter(|_| unguarded.is_none())
        .map(Known::expanded);
    let verdict = match (known, &unguarded) {
        (Some((value, bound)), None) => bound.verdict(value, guard_band),
        _ => Verdict::Inconclusive,
    };
    let missing = value
        .as_ref()
        .err()
        .or(bound.as_ref().err())
        .map(ToString::to_string)
        .or(unguarded);
    let too_near = || (verdict == Verdict::Inconclusive).then(|| near(margin_known));
    ConditionOutcome {
        text: condition.text.clone(),
        verdict,
        dimension: condition.dimension,
        value: value.as_ref().ok().map(|value| value.value),
        uncertainty: value.as_ref().ok().and_then(|value| value.uncertainty),
        degrees: how_well(&condition.value, record).map_or(f64::INFINITY, |known| known.degrees),
        bound: bound.ok(),
        margin: known.map(|(value, bound)| bound.margin(value)),
        guard_band,
        margin_degrees: margin_known.map_or(f64::INFINITY, |known| known.degrees),
        conforms,
        wider_than_tolerance,
        reason: missing.or_else(too_near),
    }
}

/// Why a guard band cannot be kept: a measured result that the condition reads has no expanded uncertainty.
fn no_uncertainty(condition: &Condition, record: &dyn Results) -> Option<String> {
    let mut references = Vec::new();
    condition.collect_references(&mut references);
    references
        .into_iter()
        .filter(|reference| reference.part == Part::Value)
        .find_map(|read| record.no_uncertainty(read))
}

/// Why a limit within the guard band decides nothing, and why the band is wide where few readings made it so.
fn near(margin: Option<Known>) -> String {
    let few = margin.filter(|known| known.degrees < f64::from(FEW));
    let why = few.map(|known| {
        format!(
            " = {:.2} u, of {:.1} degrees of freedom",
            known.coverage(),
            known.degrees
        )
    });
    "the limit is nearer than the guard band w = U".to_owned() + &why.unwrap_or_default()
}

/// How well a formula is known, with its degrees of freedom.
fn how_well(formula: &Formula, record: &dyn Results) -> Option<Known> {
    known(&formula.contributions(record, None).ok()?, record)
}

/// w = U = k·u of the distance between value and bound, so that a limit which was measured itself counts too, and a result
/// that stands on both sides counts once. None where nothing of it is uncertain.
fn margin_known(
    condition: &Condition,
    value: f64,
    bound: Bound,
    record: &dyn Results,
) -> Option<Known> {
    let difference = |a: &Formula, b: &Formula| {
        Formula::Binary(Operator::Subtract, Box::new(a.clone()), Box::new(b.clone()))
    };
    let distance = match (&condition.test, bound) {
        (Test::Compare { limit, .. }, _) => difference(&condition.value, limit),
        (
            Test::Within {
                target,
                tolerance,
                relative,
            },
            bound,
        ) => {
            let low_side = matches!(bound, Bound::Within { target, .. } if value < target);
            let off = if low_side {
                difference(target, &condition.value)
            } else {
                difference(&condition.value, target)
            };
            let tolerance = if *relative {
                let size = Formula::Call(crate::plan::formula::Function::Abs, vec![target.clone()]);
                Formula::Binary(
                    Operator::Multiply,
                    Box::new(tolerance.clone()),
                    Box::new(size),
                )
            } else {
                tolerance.clone()
            };
            difference(&off, &tolerance)
        }
    };
    how_well(&distance, record).filter(|known| known.standard > 0.0)
}

fn evaluate_bound(test: &Test, record: &dyn Results) -> Result<Bound, FormulaError> {
    let number = |formula: &Formula| {
        formula
            .evaluate(record, None)
            .map(|estimate| estimate.value)
    };
    Ok(match test {
        Test::Compare { comparison, limit } => Bound::Compare {
            comparison: *comparison,
            limit: number(limit)?,
        },
        Test::Within {
            target,
            tolerance,
            relative,
        } => {
            let target = number(target)?;
            let tolerance = number(tolerance)? * if *relative { target.abs() } else { 1.0 };
            Bound::Within { target, tolerance }
        }
    })
}

/// Numbers that differ by no more than this share of the larger are one number: 0.3 mm read in quanta of 0.1 mm, or an energy
/// that went through a square root and back, is off by some 1e-16 of itself, and no measurement tells such a difference.
const ROUNDING: f64 = 1e-12;

/// What rounding may make of numbers such as these.
fn rounding(a: f64, b: f64) -> f64 {
    ROUNDING * a.abs().max(b.abs()).min(f64::MAX)
}

fn equal(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() <= rounding(a, b)
}

impl ConditionOutcome {
    /// How well the value is known.
    #[must_use]
    pub fn known(&self) -> Option<Known> {
        self.uncertainty.map(|standard| Known {
            standard,
            degrees: self.degrees,
        })
    }

    /// How well its margin is known, where a guard band is kept.
    #[must_use]
    pub fn margin_known(&self) -> Option<Known> {
        let degrees = self.margin_degrees;
        self.guard_band.map(|band| Known {
            standard: band
                / Known {
                    standard: 1.0,
                    degrees,
                }
                .coverage(),
            degrees,
        })
    }
}

impl Bound {
    /// Whether `value` (SI) meets it. What is equal but for rounding is equal.
    #[must_use]
    pub fn holds(self, value: f64) -> bool {
        match self {
            Self::Compare { comparison, limit } => match comparison {
                Comparison::Less => value < limit && !equal(value, limit),
                Comparison::LessEqual => value <= limit || equal(value, limit),
                Comparison::Greater => value > limit && !equal(value, limit),
                Comparison::GreaterEqual => value >= limit || equal(value, limit),
                Comparison::Equal => equal(value, limit),
                Comparison::NotEqual => !equal(value, limit),
            },
            Self::Within { .. } => self.margin(value) >= 0.0,
        }
    }

    /// Probability that what was measured as `value` (SI) meets it, `known` how well the distance between them is.
    #[must_use]
    pub fn conforms(self, value: f64, known: Known) -> f64 {
        let Known { standard, degrees } = known;
        let below = |limit: f64| student_t::below((limit - value) / standard, degrees);
        match self {
            Self::Compare { comparison, limit } => match comparison {
                Comparison::Less | Comparison::LessEqual => below(limit),
                Comparison::Greater | Comparison::GreaterEqual => {
                    student_t::below((value - limit) / standard, degrees)
                }
                Comparison::Equal => 0.0,
                Comparison::NotEqual => 1.0,
            },
            Self::Within { target, tolerance } => {
                below(target + tolerance) - below(target - tolerance)
            }
        }
    }

    /// The verdict on `value` (SI): without a guard band the value decides. With one, w (SI, above 0), it passes if it keeps
    /// the bound by at least w, fails if it misses it by more than w, and else nothing is decided.
    #[must_use]
    pub fn verdict(self, value: f64, guard_band: Option<f64>) -> Verdict {
        let Some(band) = guard_band else {
            return if self.holds(value) {
                Verdict::Pass
            } else {
                Verdict::Fail
            };
        };
        let margin = self.margin(value);
        let strict = matches!(
            self,
            Self::Compare {
                comparison: Comparison::Less | Comparison::Greater | Comparison::NotEqual,
                ..
            }
        );
        if if strict {
            margin > band
        } else {
            margin >= band
        } {
            Verdict::Pass
        } else if margin < -band {
            Verdict::Fail
        } else {
            Verdict::Inconclusive
        }
    }

    /// Distance of `value` inside the bound; negative: missed by so much. Equality has nothing inside it, inequality
    /// nothing outside.
    #[must_use]
    pub fn margin(self, value: f64) -> f64 {
        match self {
            Self::Compare { limit, .. } if equal(value, limit) => 0.0,
            Self::Compare { comparison, limit } => match comparison {
                Comparison::Less | Comparison::LessEqual => limit - value,
                Comparison::Greater | Comparison::GreaterEqual => value - limit,
                Comparison::Equal => -(value - limit).abs(),
                Comparison::NotEqual => (value - limit).abs(),
            },
            Self::Within { target, tolerance } => {
                let margin = tolerance - (value - target).abs();
                if margin.abs() <= rounding(value, target) {
                    0.0
                } else {
                    margin
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
