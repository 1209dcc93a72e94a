//! Scatters of inputs that are not what was meant.

use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::Span;
use psd_text::units::display::significant;

/// `mean` and `sd` as they are written, without names.
pub fn mean_first(distribution: &str, mean: &str, sd: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BadDistribution,
        format!("`{distribution}` has the standard deviation first if its arguments have no names"),
    )
    .at(span, "two arguments without names")
    .help(format!("write `{distribution}(mean: {mean}, sd: {sd})`"))
}

/// A coefficient of variation above 1 that is written without `%`.
pub fn cv_without_percent(text: &str, cv: f64, span: Span) -> Diagnostic {
    let percent = significant(100.0 * cv, 3);
    Diagnostic::new(
        Code::RunsWithoutResult,
        format!("the scatter exceeds the mean: `cv: {text}` is {percent} %"),
    )
    .at(span, format!("{percent} % of the mean"))
    .help(format!(
        "write `cv: {text} %`, or `cv: {percent} %` if it is meant"
    ))
}

/// `value`: one draw of `name` in 1000 is beyond it, and the plan has the error `reason` there.
pub fn runs_without_result(
    name: &str,
    value: &str,
    reason: &Diagnostic,
    span: Span,
    help: &str,
) -> Diagnostic {
    let message = format!(
        "one run in 1000 or more has no result, where `{name}` is beyond {value}: {}",
        reason.message
    );
    Diagnostic::new(Code::RunsWithoutResult, message)
        .at(span, "reaches this value")
        .help(help)
}
