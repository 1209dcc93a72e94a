//! A line of least squares as a report gives it. In: the fit, and the names of its two numbers. Out: a note.

use super::super::document::Block;
use super::super::number;
use crate::record::LineFit;
use crate::units::Dimension;

/// The line of least squares with the standard error of both its numbers, and how far the readings lie from it.
pub(crate) fn fitted(
    line: &str,
    slope: (&str, Dimension),
    intercept: (&str, Dimension),
    fit: LineFit,
) -> Block {
    let number = |(name, dimension): (&str, Dimension), value, error| {
        format!(
            "{name} = {}",
            number::with_uncertainty(value, Some(error), dimension)
        )
    };
    Block::note(format!(
        "Least-squares line {line}: {}, {} (in brackets the standard error), R² = {:.6}.",
        number(slope, fit.slope, fit.slope_error),
        number(intercept, fit.intercept, fit.intercept_error),
        fit.r_squared
    ))
}
