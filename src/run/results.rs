//! How procedures name their results. A number that is not finite does not exist in the run.

use crate::formula::ResultValue;
use crate::quantity::Dimension;
use crate::record::NamedResult;

/// A result without uncertainty; None where it does not exist in this run.
pub(super) fn result(name: &'static str, dimension: Dimension, value: Option<f64>) -> NamedResult {
    measured(name, dimension, value.map(|value| (value, None)))
}

/// A result and its standard uncertainty, where it has one.
pub(super) fn measured(name: &'static str, dimension: Dimension, value: Option<(f64, Option<f64>)>) -> NamedResult {
    let value = value.filter(|(value, _)| value.is_finite());
    let uncertainty = value.and_then(|(_, uncertainty)| uncertainty).filter(|uncertainty| uncertainty.is_finite());
    let value = ResultValue::Number { value: value.map(|(value, _)| value), uncertainty };
    NamedResult { name, value, dimension, contributions: Vec::new() }
}

/// The largest of some sizes; None of nothing.
pub(super) fn largest(values: impl Iterator<Item = f64>) -> Option<f64> {
    values.map(f64::abs).reduce(f64::max)
}
