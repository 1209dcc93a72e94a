//! Errors of `golden { … }`.

use super::{shown, suggestion};
use crate::text::diagnostic::{Code, Diagnostic};
use crate::text::source::Span;
use crate::units::Dimension;

pub fn result_wanted(span: Span, text: &str) -> Diagnostic {
    Diagnostic::new(Code::WrongType, "a tolerance is of a result")
        .at(span, format!("`{text}` is no result of a procedure"))
        .help("name a result, such as `hit.max_displacement`; its uncertainty is held alike")
}

pub fn column_wanted(span: Span, text: &str) -> Diagnostic {
    Diagnostic::new(Code::WrongType, "a tolerance is of a column")
        .at(span, format!("`{text}` is no column"))
        .help("name a column of one procedure, such as `hit.displacement_m`, or of all, such as `wall_time_s`")
}

pub fn unknown_column<'a>(
    name: &str,
    span: Span,
    known: impl Iterator<Item = &'a str>,
) -> Diagnostic {
    Diagnostic::new(
        Code::UnknownColumn,
        format!("no table has a column `{name}` with numbers"),
    )
    .at(span, "no such column")
    .help(suggestion(name, known))
}

pub fn near_twice(text: &str, span: Span, first: Span) -> Diagnostic {
    Diagnostic::new(Code::ToleranceTwice, format!("`{text}` has two tolerances"))
        .at(span, "the second")
        .at(first, "the first")
        .help("a name has one tolerance: leave one of them out")
}

pub fn negative(span: Span, text: &str) -> Diagnostic {
    Diagnostic::new(Code::OutOfRange, "a tolerance must be at least 0")
        .at(span, format!("`{text}` is negative"))
        .help("write its size")
}

pub fn wide(tolerance: f64, span: Span) -> Diagnostic {
    let percent = shown(100.0 * tolerance, Dimension::NUMBER);
    Diagnostic::new(Code::WideTolerance, format!("a tolerance of {percent} % holds a rerun to little"))
        .at(span, "more than 10 %")
        .help("a run on a virtual rig gives the same numbers again: a tolerance is for what another machine rounds differently")
}
