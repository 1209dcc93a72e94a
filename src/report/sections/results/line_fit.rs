//! The note on a least-squares line. In: the fit, names and dimensions of its two coefficients. Out: a note.

use crate::report::document::Block;
use crate::report::number;
use crate::report::wording::line_fit as wording;
use psd_plan::record::LineFit;
use psd_text::units::Dimension;

/// A coefficient of the line: its name and its dimension.
pub(crate) struct Coefficient(pub &'static str, pub Dimension);

impl Coefficient {
    fn with_error(&self, value: f64, error: f64) -> String {
        let value = number::with_uncertainty(value, Some(error), self.1);
        format!("{} = {value}", self.0)
    }
}

/// The line with the standard errors of slope and intercept, and R².
pub(crate) fn fitted(
    line: &str,
    slope: &Coefficient,
    intercept: &Coefficient,
    fit: LineFit,
) -> Block {
    let slope = slope.with_error(fit.slope, fit.slope_error);
    let intercept = intercept.with_error(fit.intercept, fit.intercept_error);
    let has_errors = [&slope, &intercept].iter().any(|text| text.contains('('));
    let errors = if has_errors {
        wording::STANDARD_ERRORS
    } else {
        ""
    };
    Block::note(wording::fitted(
        line,
        slope,
        intercept,
        errors,
        fit.r_squared,
    ))
}
