//! Errors of cycles and of impact series.

use crate::text::diagnostic::{Code, Diagnostic};
use crate::text::source::{Span, Spanned};

pub fn amplitudes_twice(span: Span, first: Span) -> Diagnostic {
    Diagnostic::new(
        Code::Duplicate,
        "the amplitudes are given twice: by `amplitudes` and by `protocol`",
    )
    .at(span, "again here")
    .at(first, "first here")
    .help("remove one of them")
}

pub fn rate_without_speed(rate: Span, head: Span) -> Diagnostic {
    Diagnostic::new(
        Code::RateWithoutSpeed,
        "`rate` reads while the actuator moves, and nothing says how fast it moves",
    )
    .at(rate, "a rate of readings on the way")
    .at(head, "`speed` is missing")
    .help("add a line such as `speed = 1 mm/s`, or leave `rate` out to step and pause")
}

pub fn no_use_with_rate(field: &str, span: Span, rate: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NoUseWithRate,
        format!("`{field}` has no use beside `rate`: the actuator does not stop on its way"),
    )
    .at(span, "of step and pause")
    .at(rate, "moved without stopping")
    .help(format!("leave out `{field}`, or `rate`"))
}

/// `what` begins at the final state of `before`.
pub fn impact_on_moving_specimen(
    what: Spanned<&str>,
    before: Spanned<&str>,
    ends: &str,
    help: &str,
) -> Diagnostic {
    Diagnostic::new(
        Code::BlowOnBlow,
        format!(
            "this {} begins where `{}` ended: under load, and at rest",
            what.node, before.node
        ),
    )
    .at(what.span, "begins there")
    .at(before.span, ends.to_owned())
    .help(help)
}

pub fn levels_twice(again: &str, span: Span, first_field: &str, first: Span) -> Diagnostic {
    Diagnostic::new(
        Code::Duplicate,
        format!("the blows are given twice: by `{first_field}` and by `{again}`"),
    )
    .at(span, "again here")
    .at(first, "first here")
    .help("remove one of them")
}

pub fn levels_do_not_rise(field: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::LevelsDoNotRise,
        format!("the `{field}` do not rise from each blow to the next"),
    )
    .at(span, "some blow is no harder than the one before")
    .help("put them in order, so that the first that fails is the least that does")
}

pub fn condition_without_result(text: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::ConditionWithoutBlow,
        format!("`{text}` reads no result of a blow: it is the same after every one"),
    )
    .at(span, "holds always, or never")
    .help("name a result of the blow, such as `max_displacement < 20 mm`")
}
