//! Errors and warnings of the test as a whole: E6xx and W7xx.

use super::{one_of, shown, suggestion};
use crate::plan::{Interval, MOST_RECORDED_STEPS};
use crate::text::diagnostic::{Code, Diagnostic};
use crate::text::source::Span;
use crate::units::Dimension;

/// Most spans of repeated declarations that are shown.
pub const SHOWN: usize = 20;

/// `declared`: the first [`SHOWN`] of `several`.
pub fn several_specimens(head: Span, declared: &[(String, Span)], several: usize) -> Diagnostic {
    let diagnostic = Diagnostic::new(
        Code::AmbiguousSpecimen,
        "several specimens are declared, and this procedure names none",
    )
    .at(head, "on which specimen?");
    let lines: Vec<String> = declared
        .iter()
        .map(|(name, _)| format!("specimen = {name}"))
        .collect();
    let more = if several > SHOWN {
        format!(", or one of {} more", several - SHOWN)
    } else {
        String::new()
    };
    let help = format!(
        "add a line {}{more}",
        one_of(lines.iter().map(String::as_str))
    );
    declared
        .iter()
        .fold(diagnostic, |diagnostic, (name, span)| {
            diagnostic.at(*span, format!("`{name}` is one"))
        })
        .help(help)
}

pub fn another_specimen(name: &str, span: Span, on_rig: &str, first: Span) -> Diagnostic {
    Diagnostic::new(Code::SeveralSpecimens, format!("the rig holds `{on_rig}`, and this procedure tests `{name}`"))
        .at(span, format!("tests `{name}`"))
        .at(first, format!("`{on_rig}` is on the rig from here"))
        .help(format!("one run tests one specimen: write `specimen = {on_rig}`, or give `{name}` a plan of its own"))
}

pub fn beyond_limits(
    field: &str,
    value: f64,
    dimension: Dimension,
    span: Span,
    limit: Interval,
    limit_at: Span,
) -> Diagnostic {
    let value = shown(value, dimension);
    let (low, high) = (shown(limit.low, dimension), shown(limit.high, dimension));
    Diagnostic::new(
        Code::BeyondLimits,
        format!("`{field}` asks for {value}, outside the limits {low} .. {high}"),
    )
    .at(span, format!("reaches {value}"))
    .at(limit_at, "the limit")
    .help("stay inside the limits, or widen them if the rig and the specimen allow it")
}

/// Limits that stop a run before it begins.
pub fn start_beyond_limits(
    name: &str,
    limit: Interval,
    dimension: Dimension,
    at: Span,
) -> Diagnostic {
    let (low, high) = (shown(limit.low, dimension), shown(limit.high, dimension));
    let (zero, wider) = if limit.low > 0.0 {
        ("0", format!("0 .. {high}"))
    } else {
        ("0", format!("{low} .. 0"))
    };
    Diagnostic::new(
        Code::BeyondLimits,
        format!("the run begins at {name} {zero}, outside the limits {low} .. {high}"),
    )
    .at(at, "leaves out the start")
    .help(format!(
        "let the limits hold the start too, as in `{name} = {wider}`"
    ))
}

/// `gap` and `velocity` as text, `arrives` and `duration` in \[s\].
pub fn never_arrives(
    striker: &str,
    gap: f64,
    arrives: f64,
    duration: f64,
    gap_at: Span,
    duration_at: Span,
) -> Diagnostic {
    let gap = shown(gap, Dimension::LENGTH);
    Diagnostic::new(
        Code::NeverArrives,
        format!(
            "`{striker}` never arrives: it needs {} for its gap of {gap}",
            time(arrives)
        ),
    )
    .at(duration_at, format!("over after {}", time(duration)))
    .at(gap_at, format!("{gap} before the specimen"))
    .help("make the `gap` smaller, or the `duration` longer")
}

pub fn unknown_rig(name: &str, known: &[&str]) -> Diagnostic {
    let help = if known.is_empty() {
        "the plan declares no rig; leave `--rig` out for an ideal one".to_owned()
    } else {
        suggestion(name, known.iter().copied())
    };
    Diagnostic::new(
        Code::UnknownRig,
        format!("`--rig {name}`: no rig is called `{name}`"),
    )
    .help(help)
}

pub fn limits_wider(
    field: &str,
    plan: Span,
    plan_text: &str,
    rig: Span,
    rig_text: &str,
) -> Diagnostic {
    Diagnostic::new(
        Code::LimitsWider,
        format!("the plan's limit on `{field}` is wider than its rig's"),
    )
    .at(plan, format!("`{plan_text}` asks for more"))
    .at(rig, format!("the rig allows `{rig_text}`"))
    .help("narrow the plan's limit to the rig's, or leave it out")
}

fn time(value: f64) -> String {
    shown(value, Dimension::TIME)
}

/// `all` steps up to the end of this procedure, which has `steps` of them; the procedures before it leave `remaining`.
pub fn too_many_recorded_steps(span: Span, all: u64, steps: u64, remaining: u64) -> Diagnostic {
    let message =
        format!("this run has {all} steps, and one run has at most {MOST_RECORDED_STEPS} steps");
    Diagnostic::new(Code::TooManyRecordedSteps, message)
        .at(span, format!("{steps} steps"))
        .help(format!(
            "shorten `duration` or take a longer `time_step`: {remaining} steps fit here"
        ))
}

pub fn step_above_critical(span: Span, step: f64, critical: f64) -> Diagnostic {
    let (step, critical) = (time(step), time(critical));
    Diagnostic::new(
        Code::StepAboveCritical,
        format!("the time step {step} is above the critical time step {critical}"),
    )
    .at(span, format!("{step}, critical is {critical}"))
    .help("write `time_step = critical / 20`")
}

/// The step compared with the limit from a stiffness that is measured only in the run.
pub fn step_above_predicted(span: Span, step: f64, critical: f64) -> Diagnostic {
    let (step, critical) = (time(step), time(critical));
    let message = format!(
        "the time step {step} is above the critical time step, about {critical} by the declared behaviour"
    );
    Diagnostic::new(Code::StepAboveCritical, message)
        .at(span, format!("{step}, critical is about {critical}"))
        .help("write `time_step = critical / 20`")
}

/// `law`: a law without a duration, whose force is an impulse over one step.
pub fn peak_force_follows_the_step(span: Span, impact: Span, law: &str) -> Diagnostic {
    let (of, holds) = match law {
        "rigid" => ("the rigid law", "`contact = rigid`"),
        _ => ("`restitution`", "`contact = restitution(…)`"),
    };
    let message = format!(
        "the peak contact force under {of} grows as 1/Δt: it says more of the time step than of the blow"
    );
    Diagnostic::new(Code::PeakForceUnderRigidLaw, message)
        .at(span, "this figure follows the time step")
        .at(impact, format!("{holds} holds here"))
        .help("require the `impulse`, or give a law that converges: `contact = hertz(…)`")
}

/// `first`: the longest step at which the limit acts at the first impact; `resolved`: the longest step that resolves the displacement.
pub fn limit_force_not_resolved(span: Span, step: f64, first: f64, resolved: f64) -> Diagnostic {
    let (now, first_text, resolved_text) = (time(step), time(first), time(resolved));
    let message = if step >= first {
        format!(
            "with the time step {now} the limit force does not act at the first blow; it does below {first_text}"
        )
    } else {
        format!("the time step {now} does not resolve the limit force; {resolved_text} does")
    };
    Diagnostic::new(Code::LimitForceNotResolved, message)
        .at(span, format!("the step is {now}"))
        .help(format!("write `time_step = {resolved_text}` or less"))
}

/// `letters` are the first that no font of the page has, `printed` is their replacement.
pub fn not_printed(letters: &str, printed: &str, others: usize, span: Span) -> Diagnostic {
    let also = match others {
        0 => String::new(),
        1 => ", here and in one more text".to_owned(),
        more => format!(", here and in {more} more texts"),
    };
    Diagnostic::new(Code::NotPrinted, format!("on paper `{letters}` stands as `{printed}`{also}"))
        .at(span, "holds letters that the fonts of the PDF certificate lack")
        .help(
            "they have Latin, Greek and Cyrillic letters: write the name in one of those as well; the HTML certificate shows all",
        )
}

pub fn nothing_required(span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NothingRequired,
        "the plan requires nothing: its verdict says only that it ran",
    )
    .at(span, "the last procedure")
    .help("add a line such as `require \"stays in travel\" hit.max_displacement <= 8.5 mm`")
}

pub fn nothing_runs(span: Span) -> Diagnostic {
    Diagnostic::new(Code::NothingRuns, "the plan runs nothing")
        .at(span, "no procedure follows")
        .help("add a procedure, such as\nstiffness ramp k0 { displacements = 0.1 mm .. 1 mm step 0.1 mm }")
}

pub fn unused(keyword: &str, name: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::Unused,
        format!("the `{keyword}` `{name}` is never used"),
    )
    .at(span, "not used")
    .help("remove it, or use it")
}
