//! Faults of cycles and of sequences of blows.

use crate::diagnostic::{Code, Diagnostic};
use crate::source::Span;

pub fn amplitudes_twice(span: Span, first: Span) -> Diagnostic {
    Diagnostic::new(Code::Duplicate, "the amplitudes are given twice: by `amplitudes` and by `protocol`")
        .at(span, "again here")
        .at(first, "first here")
        .help("remove one of them")
}

pub fn rate_without_speed(rate: Span, head: Span) -> Diagnostic {
    Diagnostic::new(Code::RateWithoutSpeed, "`rate` reads while the actuator moves, and nothing says how fast it moves")
        .at(rate, "a rate of readings on the way")
        .at(head, "`speed` is missing")
        .help("add a line such as `speed = 1 mm/s`, or leave `rate` out to step and pause")
}

pub fn no_use_with_rate(field: &str, span: Span, rate: Span) -> Diagnostic {
    Diagnostic::new(Code::NoUseWithRate, format!("`{field}` has no use beside `rate`: the actuator does not stop on its way"))
        .at(span, "of step and pause")
        .at(rate, "moved without stopping")
        .help(format!("leave out `{field}`, or `rate`"))
}
