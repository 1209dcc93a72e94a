//! Errors of cycles and of impact series.

use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::{Span, Spanned};

pub fn amplitudes_twice(span: Span, first: Span) -> Diagnostic {
    Diagnostic::new(
        Code::Duplicate,
        "amplitudes given twice: by `amplitudes` and by `protocol`",
    )
    .at(span, "given again")
    .at(first, "first given here")
    .help("remove one of them")
}

pub fn rate_without_speed(rate: Span, head: Span) -> Diagnostic {
    Diagnostic::new(
        Code::RateWithoutSpeed,
        "`rate` requires `speed`: the actuator is read while it moves",
    )
    .at(rate, "readings during motion")
    .at(head, "`speed` is missing")
    .help("add a line such as `speed = 1 mm/s`, or remove `rate` for ramp-and-hold")
}

pub fn no_use_with_rate(field: &str, span: Span, rate: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NoUseWithRate,
        format!("`{field}` has no effect with `rate`: the actuator does not stop between the ends"),
    )
    .at(span, "for ramp-and-hold only")
    .at(rate, "motion without stops")
    .help(format!("remove `{field}` or `rate`"))
}

/// `what` begins at the final state of `before`.
pub fn impact_on_moving_specimen(
    what: Spanned<&str>,
    before: Spanned<&str>,
    ends: &str,
    help: &str,
) -> Diagnostic {
    Diagnostic::new(
        Code::RepeatedImpact,
        format!(
            "loaded start: this {} begins where `{}` ended, under load and at rest",
            what.node, before.node
        ),
    )
    .at(what.span, "ends under load")
    .at(before.span, ends.to_owned())
    .help(help)
}

pub fn levels_twice(again: &str, span: Span, first_field: &str, first: Span) -> Diagnostic {
    Diagnostic::new(
        Code::Duplicate,
        format!("impacts given twice: by `{first_field}` and by `{again}`"),
    )
    .at(span, "given again")
    .at(first, "first given here")
    .help("remove one of them")
}

pub fn levels_do_not_rise(field: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::LevelsDoNotRise,
        format!("`{field}` do not increase from impact to impact"),
    )
    .at(span, "not in increasing order")
    .help("sort them, so that the first failure has the lowest energy")
}

pub fn condition_without_result(text: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::ConditionWithoutImpact,
        format!("`{text}` reads no result of an impact: it is the same after every one"),
    )
    .at(span, "constant condition")
    .help("name a result of the impact, such as `max_displacement < 20 mm`")
}
