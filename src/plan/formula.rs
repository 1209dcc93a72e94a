//! Checked expressions: names are resolved, units converted, dimensions checked. At run time they contain only arithmetic on constants
//! and on the results of finished procedures. In: a [`Formula`] and [`Results`]. Out: an [`Estimate`], the value with its standard
//! uncertainty.

use super::contribution::{Contribution, combined, combined_entries};
use super::results::{Moved, ReadOnce, sources_of};
pub use super::results::{
    NoResults, ResultPart, ResultReference, ResultValue, Results, UncertaintyStatus,
};
pub use super::source::ProcedureId;
use super::source::Source;

/// A checked expression, in SI.
#[derive(Clone, Debug, PartialEq)]
pub enum Formula {
    Constant(f64),
    /// A number that the plan states with its uncertainty.
    Stated(Stated),
    Result(ResultReference),
    /// Δt of eq. 7 for the current impact; allowed only in `time_step`.
    CriticalTimeStep,
    List(Vec<Formula>),
    Index(Box<Formula>, usize),
    Negate(Box<Formula>),
    Binary(Operator, Box<Formula>, Box<Formula>),
    Call(Function, Vec<Formula>),
}

/// A number of the plan in SI units, with its standard uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stated {
    pub source: Source,
    pub value: f64,
    /// Standard uncertainty.
    pub uncertainty: f64,
}

impl Stated {
    /// The number, as a constant if it is exact.
    #[must_use]
    pub fn formula(self) -> Formula {
        if self.uncertainty > 0.0 {
            Formula::Stated(self)
        } else {
            Formula::Constant(self.value)
        }
    }
}

/// Between two numbers; their dimensions were checked with the plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

/// A function of numbers or of a list; `ALL` contains its name in the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    Abs,
    Min,
    Max,
    Sum,
    Mean,
    Sqrt,
    Sin,
    Cos,
    Tan,
    Exp,
    Log,
    Hypot,
}

/// A value and its standard uncertainty, both in SI units; no uncertainty if no measured result is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    pub value: f64,
    pub uncertainty: Option<f64>,
}

/// Why a formula has no value.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FormulaError {
    #[error("the result `{0}` does not exist in this run")]
    Missing(&'static str),
    #[error("the uncertainty of `{0}` is not known in this run")]
    NoUncertainty(&'static str),
    #[error("the value is not a finite number")]
    NotFinite,
    #[error("a list, but one number is required")]
    NotANumber,
    #[error("the list has no entry {0}")]
    NoSuchEntry(usize),
}

#[derive(Clone, Debug)]
enum Value {
    Number(f64),
    List(Vec<f64>),
}

impl Formula {
    /// The value, and its standard uncertainty propagated to first order: the root sum of squares of the effect of each source
    /// on the value (JCGM 100:2008, 5.1.2; for results that share sources, 5.2.2). `critical` is Δtc
    /// \[s\], for `time_step` only.
    ///
    /// # Errors
    /// A result that does not exist in this run, or a value that is not finite.
    pub fn evaluate(
        &self,
        results: &dyn Results,
        critical: Option<f64>,
    ) -> Result<Estimate, FormulaError> {
        let value = self.number(results, critical)?;
        let uncertainty = combined(&self.contributions(results, critical)?);
        Ok(Estimate { value, uncertainty })
    }

    /// The effect of each source of the results that it reads on the value.
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    pub fn contributions(
        &self,
        results: &dyn Results,
        critical: Option<f64>,
    ) -> Result<Vec<Contribution>, FormulaError> {
        if matches!(self, Self::Constant(_)) {
            return Ok(Vec::new());
        }
        let mut references = Vec::new();
        self.collect_references(&mut references);
        let mut sources = sources_of(&references, results);
        self.collect_stated(&mut sources);
        if sources.is_empty() {
            return Ok(Vec::new());
        }
        let results = &ReadOnce::new(&references, results);
        let value = self.number(results, critical)?;
        let effect = |source| {
            // Half the effect of a perturbation by ±u: exact for a linear formula.
            let moved = |by| {
                let shifts = &[(source, by)];
                self.number(&Moved { results, shifts }, critical)
            };
            let (up, down) = (moved(1.0)?, moved(-1.0)?);
            let (above, below) = (up - value, value - down);
            // Finer steps are to one side.
            if !source.is_of_uncertainty() {
                return Ok(Contribution::new(source, above));
            }
            // Both perturbations have an effect of the same sign, as for `abs` about 0: half of their difference would be nearly zero.
            let folds = above * below < 0.0;
            Ok(Contribution::new(
                source,
                if folds {
                    above.abs().max(below.abs()).copysign(above)
                } else {
                    0.5 * (up - down)
                },
            ))
        };
        sources.into_iter().map(effect).collect()
    }

    /// The value if no result is needed: constants, folded by `check`.
    #[must_use]
    pub fn constant(&self) -> Option<f64> {
        self.number(&NoResults, None).ok()
    }

    /// The result that this formula reads, if it contains nothing else.
    #[must_use]
    pub fn as_result(&self) -> Option<ResultReference> {
        if let Self::Result(reference) = self {
            Some(*reference)
        } else {
            None
        }
    }

    /// Adds every result that the formula reads, each once.
    pub fn collect_references(&self, into: &mut Vec<ResultReference>) {
        match self {
            Self::Constant(_) | Self::Stated(_) | Self::CriticalTimeStep => {}
            Self::Result(reference) => {
                if !into.contains(reference) {
                    into.push(*reference);
                }
            }
            Self::Negate(inner) | Self::Index(inner, _) => inner.collect_references(into),
            Self::Binary(_, left, right) => {
                left.collect_references(into);
                right.collect_references(into);
            }
            Self::List(parts) | Self::Call(_, parts) => {
                for part in parts {
                    part.collect_references(into);
                }
            }
        }
    }

    /// Adds every result that the formula reads, with the entry of a list that it reads alone.
    pub fn collect_entries(&self, into: &mut Vec<(ResultReference, Option<usize>)>) {
        match self {
            Self::Constant(_) | Self::Stated(_) | Self::CriticalTimeStep => {}
            Self::Result(reference) => into.push((*reference, None)),
            Self::Index(inner, entry) => match &**inner {
                Self::Result(reference) => into.push((*reference, Some(*entry))),
                inner => inner.collect_entries(into),
            },
            Self::Negate(inner) => inner.collect_entries(into),
            Self::Binary(_, left, right) => {
                left.collect_entries(into);
                right.collect_entries(into);
            }
            Self::List(parts) | Self::Call(_, parts) => {
                for part in parts {
                    part.collect_entries(into);
                }
            }
        }
    }

    /// Adds the source of every number that is stated with an uncertainty, each once.
    pub fn collect_stated(&self, into: &mut Vec<Source>) {
        match self {
            Self::Constant(_) | Self::Result(_) | Self::CriticalTimeStep => {}
            Self::Stated(stated) => {
                if !into.contains(&stated.source) {
                    into.push(stated.source);
                }
            }
            Self::Negate(inner) | Self::Index(inner, _) => inner.collect_stated(into),
            Self::Binary(_, left, right) => {
                left.collect_stated(into);
                right.collect_stated(into);
            }
            Self::List(parts) | Self::Call(_, parts) => {
                for part in parts {
                    part.collect_stated(into);
                }
            }
        }
    }

    /// Whether it states a number with an uncertainty.
    #[must_use]
    pub fn is_uncertain(&self) -> bool {
        let mut stated = Vec::new();
        self.collect_stated(&mut stated);
        !stated.is_empty()
    }

    /// The number of its parts that are neither constants nor lists.
    #[must_use]
    pub fn terms(&self) -> usize {
        match self {
            Self::Constant(_) => 0,
            Self::Stated(_) | Self::Result(_) | Self::CriticalTimeStep => 1,
            Self::Negate(inner) | Self::Index(inner, _) => 1 + inner.terms(),
            Self::Binary(_, left, right) => 1 + left.terms() + right.terms(),
            Self::Call(_, parts) => 1 + parts.iter().map(Self::terms).sum::<usize>(),
            Self::List(parts) => parts.iter().map(Self::terms).sum(),
        }
    }

    /// Whether it contains `critical`.
    #[must_use]
    pub fn reads_critical_time_step(&self) -> bool {
        match self {
            Self::CriticalTimeStep => true,
            Self::Constant(_) | Self::Stated(_) | Self::Result(_) => false,
            Self::Negate(inner) | Self::Index(inner, _) => inner.reads_critical_time_step(),
            Self::Binary(_, left, right) => {
                left.reads_critical_time_step() || right.reads_critical_time_step()
            }
            Self::List(parts) | Self::Call(_, parts) => {
                parts.iter().any(Self::reads_critical_time_step)
            }
        }
    }

    fn number(&self, results: &dyn Results, critical: Option<f64>) -> Result<f64, FormulaError> {
        match self.value(results, critical)? {
            Value::Number(value) if value.is_finite() => Ok(value),
            Value::Number(_) => Err(FormulaError::NotFinite),
            Value::List(_) => Err(FormulaError::NotANumber),
        }
    }

    fn value(&self, results: &dyn Results, critical: Option<f64>) -> Result<Value, FormulaError> {
        let number = |formula: &Formula| formula.number(results, critical);
        Ok(match self {
            Self::Constant(value) => Value::Number(*value),
            Self::Stated(Stated {
                source,
                value,
                uncertainty,
            }) => {
                let by = results.moved(*source);
                Value::Number(if by == 0.0 {
                    *value
                } else {
                    value + by * uncertainty
                })
            }
            Self::CriticalTimeStep => {
                Value::Number(critical.ok_or(FormulaError::Missing("critical"))?)
            }
            Self::Result(reference) => {
                match (
                    results
                        .result(*reference)
                        .ok_or(FormulaError::Missing(reference.name))?,
                    reference.part,
                ) {
                    (ResultValue::List(values), ResultPart::Value) => Value::List(values),
                    (ResultValue::List(values), ResultPart::Uncertainty) => {
                        let entries =
                            combined_entries(&results.contributions(*reference), values.len());
                        let known: Option<Vec<f64>> = entries.into_iter().collect();
                        Value::List(known.ok_or(FormulaError::NoUncertainty(reference.name))?)
                    }
                    (ResultValue::Number { value, .. }, ResultPart::Value) => {
                        Value::Number(value.ok_or(FormulaError::Missing(reference.name))?)
                    }
                    (ResultValue::Number { uncertainty, .. }, ResultPart::Uncertainty) => {
                        Value::Number(
                            uncertainty.ok_or(FormulaError::NoUncertainty(reference.name))?,
                        )
                    }
                }
            }
            Self::List(parts) => Value::List(parts.iter().map(number).collect::<Result<_, _>>()?),
            Self::Index(inner, index) => match inner.value(results, critical)? {
                Value::List(values) => Value::Number(
                    *values
                        .get(*index)
                        .ok_or(FormulaError::NoSuchEntry(*index))?,
                ),
                Value::Number(_) => return Err(FormulaError::NotANumber),
            },
            Self::Negate(inner) => Value::Number(-number(inner)?),
            Self::Binary(operator, left, right) => {
                let (left, right) = (number(left)?, number(right)?);
                Value::Number(match operator {
                    Operator::Add => left + right,
                    Operator::Subtract => left - right,
                    Operator::Multiply => left * right,
                    Operator::Divide => left / right,
                    Operator::Power => left.powf(right),
                })
            }
            Self::Call(function, arguments) => {
                let mut values = Vec::new();
                for argument in arguments {
                    match argument.value(results, critical)? {
                        Value::Number(value) => values.push(value),
                        Value::List(list) => values.extend(list),
                    }
                }
                Value::Number(function.apply(&values))
            }
        })
    }
}

impl Function {
    /// Value of the function over its arguments, with lists expanded; NaN without arguments.
    fn apply(self, values: &[f64]) -> f64 {
        let Some(&first) = values.first() else {
            return f64::NAN;
        };
        match self {
            Self::Abs => first.abs(),
            Self::Sqrt => first.sqrt(),
            Self::Sin => first.sin(),
            Self::Cos => first.cos(),
            Self::Tan => first.tan(),
            Self::Exp => first.exp(),
            Self::Log => first.ln(),
            Self::Hypot => values.iter().copied().fold(0.0, f64::hypot),
            Self::Min => values.iter().copied().fold(first, f64::min),
            Self::Max => values.iter().copied().fold(first, f64::max),
            Self::Sum => values.iter().sum(),
            #[expect(
                clippy::cast_precision_loss,
                reason = "a list has at most some million entries"
            )]
            Self::Mean => values.iter().sum::<f64>() / values.len() as f64,
        }
    }
}

#[cfg(test)]
mod tests;
