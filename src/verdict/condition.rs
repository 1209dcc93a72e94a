//! One condition. In: its value, its bound and the decision rule. Out: a verdict with margin, guard band and probability of conformity.

use super::{Bound, ConditionOutcome, Verdict};
use psd_physics::statistics::student_t;
use psd_plan::formula::{Formula, FormulaError, Operator, ResultPart, Results, UncertaintyStatus};
use psd_plan::schema::{Printed, printed};
use psd_plan::uncertainty::{FEW, MeasurementUncertainty, measurement_uncertainty};
use psd_plan::{Comparison, Condition, DecisionRule, Test};
use psd_text::units::Dimension;

/// In the steps of these results. Value and bound are evaluated separately, so that a report shows the one that exists.
pub(super) fn decide(
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
    let status = uncertainty_status(condition, record);
    // An equality is a comparison of numbers, not of a quantity with a tolerance.
    let rule = match rule {
        DecisionRule::Simple if is_equality(condition) => DecisionRule::ValueAlone,
        rule => rule,
    };
    let (unknown, undecided) = match (&status, rule) {
        (UncertaintyStatus::Exact | UncertaintyStatus::Known, _) => (false, None),
        (UncertaintyStatus::Partial(why), DecisionRule::Guarded)
        | (UncertaintyStatus::Withheld(why), DecisionRule::Guarded | DecisionRule::Simple) => {
            (true, Some(why.clone()))
        }
        (UncertaintyStatus::Partial(_), DecisionRule::Simple) | (_, DecisionRule::ValueAlone) => {
            (true, None)
        }
    };
    let distance_uncertainty = known
        .filter(|_| !unknown)
        .and_then(|(value, bound)| margin_uncertainty(condition, value, bound, record));
    let margin_uncertainty = distance_uncertainty.filter(|_| rule == DecisionRule::Guarded);
    let conforms = known
        .zip(distance_uncertainty)
        .map(|((value, bound), distance_uncertainty)| bound.conforms(value, distance_uncertainty));
    let wider_than_tolerance = known.zip(distance_uncertainty).is_some_and(
        |((_, bound), distance_uncertainty)| match bound {
            Bound::Within { tolerance, .. } => distance_uncertainty.expanded() > tolerance,
            Bound::Compare { .. } => false,
        },
    );
    let guard_band = margin_uncertainty.map(MeasurementUncertainty::expanded);
    let verdict = match (known, &undecided) {
        (Some((value, bound)), None) => bound.verdict(value, guard_band),
        _ => Verdict::Inconclusive,
    };
    let unlikely = rule == DecisionRule::Simple
        && conforms.is_some_and(|conforms| is_unlikely(verdict, conforms));
    let verdict = if unlikely {
        Verdict::Inconclusive
    } else {
        verdict
    };
    let missing = value
        .as_ref()
        .err()
        .or(bound.as_ref().err())
        .map(ToString::to_string)
        .or(undecided);
    let too_near = || match verdict {
        Verdict::Inconclusive if unlikely => Some(TOO_LARGE.to_owned()),
        Verdict::Inconclusive => Some(near(margin_uncertainty)),
        _ => None,
    };
    ConditionOutcome {
        text: condition.text.clone(),
        verdict,
        dimension: condition.dimension,
        percent: in_percent(condition),
        value: value.as_ref().ok().map(|value| value.value),
        uncertainty: value.as_ref().ok().and_then(|value| value.uncertainty),
        status,
        degrees: how_well(&condition.value, record).map_or(f64::INFINITY, |known| known.degrees),
        bound: bound.ok(),
        margin: known.map(|(value, bound)| bound.margin(value)),
        guard_band,
        margin_degrees: margin_uncertainty.map_or(f64::INFINITY, |known| known.degrees),
        conforms,
        wider_than_tolerance,
        reason: missing.or_else(too_near),
        in_finer_steps: None,
    }
}

/// Whether the plan compares a plain number with a percentage, or reads results that are printed in percent.
fn in_percent(condition: &Condition) -> bool {
    if condition.dimension != Dimension::NUMBER {
        return false;
    }
    let mut references = Vec::new();
    condition.value.collect_references(&mut references);
    let fractions = !references.is_empty()
        && references
            .iter()
            .all(|read| printed(read.name) == Printed::InPercent);
    let stated = matches!(condition.test, Test::Compare { .. }) && condition.text.contains('%');
    fractions || stated
}

/// What is known of the uncertainty of the results that the condition reads.
fn uncertainty_status(condition: &Condition, record: &dyn Results) -> UncertaintyStatus {
    let mut read = Vec::new();
    for formula in condition.formulas() {
        formula.collect_entries(&mut read);
    }
    read.into_iter()
        .filter(|(reference, _)| reference.part == ResultPart::Value)
        .map(|(reference, entry)| record.uncertainty_status(reference, entry))
        .fold(UncertaintyStatus::Exact, UncertaintyStatus::and)
}

/// Whether it is `==` or `!=`.
pub(super) const fn is_equality(condition: &Condition) -> bool {
    matches!(
        condition.test,
        Test::Compare {
            comparison: Comparison::Equal | Comparison::NotEqual,
            ..
        }
    )
}

/// Why a value inside its tolerance does not show conformity.
const TOO_LARGE: &str = "U is too large for this tolerance";

/// Whether a verdict is more likely wrong than right, by the probability of conformity. A value beside one limit cannot have such a
/// verdict: the distribution about it is symmetric. A value inside a tolerance can, if U is larger than the tolerance.
fn is_unlikely(verdict: Verdict, conforms: f64) -> bool {
    let right = match verdict {
        Verdict::Pass => conforms,
        Verdict::Fail => 1.0 - conforms,
        _ => return false,
    };
    // A value at its limit: one half, but for rounding.
    right < 0.5 - 1e-9
}

/// Why a value near its limit is not conclusive, and why the band is wide if it comes from few readings.
fn near(margin: Option<MeasurementUncertainty>) -> String {
    let few = margin.filter(|known| known.degrees < f64::from(FEW));
    let why = few.map(|known| {
        format!(
            " = {:.2} u, with {:.1} degrees of freedom",
            known.coverage(),
            known.degrees
        )
    });
    "the distance to the limit is less than the guard band w = U".to_owned()
        + &why.unwrap_or_default()
}

/// The uncertainty of a formula, with its degrees of freedom.
fn how_well(formula: &Formula, record: &dyn Results) -> Option<MeasurementUncertainty> {
    measurement_uncertainty(&formula.contributions(record, None).ok()?, record)
}

/// w = U = k·u of the distance between value and bound. The uncertainty of a measured limit is therefore included, and a result on both
/// sides counts once. None if nothing in it is uncertain.
fn margin_uncertainty(
    condition: &Condition,
    value: f64,
    bound: Bound,
    record: &dyn Results,
) -> Option<MeasurementUncertainty> {
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
                let size = Formula::Call(psd_plan::formula::Function::Abs, vec![target.clone()]);
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

/// Numbers that differ by no more than this fraction of the larger one are equal. For example, 0.3 mm read with a resolution of 0.1 mm
/// has a relative rounding error of about 1e-16. The same applies to an energy after a square root and its square. No measurement
/// resolves such a difference.
const ROUNDING: f64 = 1e-12;

/// The possible rounding error of these numbers.
pub(super) fn rounding(a: f64, b: f64) -> f64 {
    ROUNDING * a.abs().max(b.abs()).min(f64::MAX)
}

pub(super) fn equal(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() <= rounding(a, b)
}

impl ConditionOutcome {
    /// Whether the value alone decides: it is exact, or the plan does not declare its uncertainty.
    #[must_use]
    pub fn decides_without_uncertainty(&self) -> bool {
        self.verdict != Verdict::Inconclusive
            && self.conforms.is_none()
            && self.status != UncertaintyStatus::Known
    }

    /// The condition without a decision. Its value is not that of a whole procedure, and has no probability of conformity.
    pub(super) fn inconclusive(self, reason: String) -> Self {
        Self {
            verdict: Verdict::Inconclusive,
            conforms: None,
            reason: Some(reason),
            ..self
        }
    }

    /// The uncertainty of the value.
    #[must_use]
    pub fn measurement_uncertainty(&self) -> Option<MeasurementUncertainty> {
        self.uncertainty.map(|standard| MeasurementUncertainty {
            standard,
            degrees: self.degrees,
        })
    }

    /// The uncertainty of its margin, if a guard band is applied.
    #[must_use]
    pub fn margin_uncertainty(&self) -> Option<MeasurementUncertainty> {
        let degrees = self.margin_degrees;
        self.guard_band.map(|band| MeasurementUncertainty {
            standard: band
                / MeasurementUncertainty {
                    standard: 1.0,
                    degrees,
                }
                .coverage(),
            degrees,
        })
    }
}

impl Bound {
    /// Whether `value` (SI) satisfies it. Values that are equal except for rounding count as equal.
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

    /// Probability that the quantity measured as `value` (SI) satisfies it; `known` is the uncertainty of the distance between them.
    #[must_use]
    pub fn conforms(self, value: f64, known: MeasurementUncertainty) -> f64 {
        let MeasurementUncertainty { standard, degrees } = known;
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

    /// The verdict on `value` (SI). Without a guard band, the value alone is compared. With a guard band w (SI, above 0), a bound that is
    /// met with a margin of at least w is a pass. A bound that is exceeded by more than w is a fail. Otherwise the verdict is
    /// inconclusive.
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

    /// Distance of `value` inside the bound; negative: exceeded by this amount. For equality the distance is never positive, for
    /// inequality never negative.
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
