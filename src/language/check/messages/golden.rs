//! Errors of `golden { … }`.

use super::{shown, suggestion};
use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::Span;
use psd_text::units::Dimension;

pub fn result_wanted(span: Span, text: &str) -> Diagnostic {
    Diagnostic::new(Code::WrongType, "a result is required")
        .at(span, format!("`{text}` is not a result of a procedure"))
        .help("name a result, such as `hit.max_displacement`; the tolerance applies to its uncertainty too")
}

pub fn column_wanted(span: Span, text: &str) -> Diagnostic {
    Diagnostic::new(Code::WrongType, "a column is required")
        .at(span, format!("`{text}` is not a column"))
        .help("name a column of one procedure, such as `hit.displacement_m`, or of all, such as `wall_time_s`")
}

pub fn unknown_column<'a>(
    name: &str,
    span: Span,
    known: impl Iterator<Item = &'a str>,
) -> Diagnostic {
    Diagnostic::new(
        Code::UnknownColumn,
        format!("no table has a numeric column `{name}`"),
    )
    .at(span, "unknown column")
    .help(suggestion(name, known))
}

pub fn tolerance_twice(text: &str, span: Span, first: Span) -> Diagnostic {
    Diagnostic::new(Code::ToleranceTwice, format!("`{text}` has two tolerances"))
        .at(span, "second tolerance")
        .at(first, "first tolerance")
        .help("remove one of the tolerances")
}

pub fn negative(span: Span, text: &str) -> Diagnostic {
    Diagnostic::new(Code::OutOfRange, "a tolerance must be at least 0")
        .at(span, format!("`{text}` is negative"))
        .help("write its absolute value")
}

pub fn wide(tolerance: f64, span: Span) -> Diagnostic {
    let percent = shown(100.0 * tolerance, Dimension::NUMBER);
    Diagnostic::new(Code::WideTolerance, format!("a tolerance of {percent} % would hide real changes"))
        .at(span, "more than 10 %")
        .help("write a smaller tolerance: results on a virtual rig differ between machines by rounding only")
}
