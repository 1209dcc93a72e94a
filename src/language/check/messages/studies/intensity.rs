//! Errors of the values of an intensity, and of the ends of an input.

use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::Span;

/// The help for a distribution that reaches an invalid value.
pub const INSIDE: &str = "write limits inside the valid range: `uniform(a .. b)`, or `between: a .. b` of another distribution";
/// The help for an intensity that reaches an invalid value.
pub const ENDS: &str =
    "end the values of the intensity inside the valid range, or widen this range";

pub fn intensity_wanted(text: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::WrongType,
        format!("`{text}` gives no values of an intensity"),
    )
    .at(span, "not `INPUT in VALUES`")
    .help("write it as in `intensity = impact_speed in 0.5 .. 1.5 step 0.1 m/s`")
}

pub fn stripes_do_not_rise(text: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BadRange,
        "the values of an intensity must increase from above 0",
    )
    .at(span, format!("`{text}` is not above the value before"))
    .help("write each value once, in increasing order, all above 0")
}

/// A range that falls. `rising`: the same values in increasing order.
pub fn stripes_fall(rising: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BadRange,
        "the values of an intensity must increase from above 0",
    )
    .at(span, "decreases")
    .help(format!("write `{rising}`"))
}

/// `value`: an end of the distribution or intensity `name`, at which the plan has the error `reason`. `help`: [`INSIDE`] or [`ENDS`].
pub fn invalid_end(
    name: &str,
    value: &str,
    reason: &Diagnostic,
    span: Span,
    help: &str,
) -> Diagnostic {
    let message = format!(
        "the plan has an error where `{name}` is {value}: {}",
        reason.message
    );
    let diagnostic = Diagnostic::new(Code::InvalidEnd, message).at(span, "reaches this value");
    let cause = reason.labels.iter().filter(|label| label.span != span);
    cause
        .take(1)
        .fold(diagnostic, |diagnostic, label| {
            diagnostic.at(label.span, "invalid there")
        })
        .help(help)
}
