//! Errors and warnings of the test as a whole: E6xx and W7xx.

use super::{one_of, shown, suggestion};
use psd_plan::{Contact, Interval, MOST_RECORDED_STEPS};
use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::Span;
use psd_text::units::Dimension;

/// Most spans of repeated declarations that are shown.
pub const SHOWN: usize = 20;

/// `declared`: the first [`SHOWN`] of `several`.
pub fn several_specimens(head: Span, declared: &[(String, Span)], several: usize) -> Diagnostic {
    let diagnostic = Diagnostic::new(
        Code::AmbiguousSpecimen,
        "specimen not specified: the plan declares several",
    )
    .at(head, "specimen missing");
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
    Diagnostic::new(
        Code::SeveralSpecimens,
        format!("specimen `{on_rig}` is on the rig, but this procedure tests `{name}`"),
    )
    .at(span, format!("tests `{name}`"))
    .at(first, format!("`{on_rig}` is on the rig from here"))
    .help(format!(
        "write `specimen = {on_rig}`, or move `{name}` to a separate plan"
    ))
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
        format!("`{field}` has {value}, outside the limits {low} .. {high}"),
    )
    .at(span, format!("reaches {value}"))
    .at(limit_at, "limit")
    .help("stay within the limits, or widen them if the rig and the specimen allow it")
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
        format!("the start is outside the limits: {name} {zero}, limits {low} .. {high}"),
    )
    .at(at, "excludes the start")
    .help(format!("include the start: write `{name} = {wider}`"))
}

/// `gap` and `velocity` as text, `arrives` and `duration` in \[s\].
pub fn never_arrives(
    striker: &str,
    gap: f64,
    gap_at: Span,
    arrives: f64,
    duration: f64,
    duration_at: Span,
) -> Diagnostic {
    let gap = shown(gap, Dimension::LENGTH);
    Diagnostic::new(
        Code::NeverArrives,
        format!(
            "`{striker}` never arrives: it takes {} for its gap of {gap}",
            time(arrives)
        ),
    )
    .at(duration_at, format!("ends after {}", time(duration)))
    .at(gap_at, format!("{gap} before the specimen"))
    .help("reduce the `gap`, or increase the `duration`")
}

pub fn unknown_rig(name: &str, known: &[&str]) -> Diagnostic {
    let help = if known.is_empty() {
        "remove `--rig`: the plan declares no rig and runs on an ideal one".to_owned()
    } else {
        suggestion(name, known.iter().copied())
    };
    Diagnostic::new(Code::UnknownRig, format!("`--rig {name}`: unknown rig")).help(help)
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
        format!("the plan's limit on `{field}` exceeds the limit of the rig"),
    )
    .at(plan, format!("plan: `{plan_text}`"))
    .at(rig, format!("rig: `{rig_text}`"))
    .help("write the limit of the rig, or remove it")
}

fn time(value: f64) -> String {
    shown(value, Dimension::TIME)
}

/// `all` steps up to the end of this procedure, which has `steps` of them; the procedures before it leave `remaining`.
pub fn too_many_recorded_steps(span: Span, all: u64, steps: u64, remaining: u64) -> Diagnostic {
    let message = format!("too many steps in the run: {all} (at most {MOST_RECORDED_STEPS})");
    Diagnostic::new(Code::TooManyRecordedSteps, message)
        .at(span, format!("{steps} steps"))
        .help(format!(
            "reduce `duration` or increase `time_step`: {remaining} steps remain here"
        ))
}

pub fn step_above_critical(span: Span, step: f64, critical: f64) -> Diagnostic {
    let (step, critical) = (time(step), time(critical));
    Diagnostic::new(
        Code::StepAboveCritical,
        format!("peaks may be wrong: time step {step} exceeds the critical step {critical}"),
    )
    .at(span, format!("{step}, critical is {critical}"))
    .help("write `time_step = critical / 20`")
}

/// The step compared with the limit from a stiffness that is measured only in the run.
pub fn step_above_predicted(span: Span, step: f64, critical: f64) -> Diagnostic {
    let (step, critical) = (time(step), time(critical));
    let message = format!(
        "peaks may be wrong: time step {step} exceeds the critical step, about {critical} by the declared behaviour"
    );
    Diagnostic::new(Code::StepAboveCritical, message)
        .at(span, format!("{step}, critical is about {critical}"))
        .help("write `time_step = critical / 20`")
}

/// `law`: a law without a duration, whose force is an impulse over one step.
pub fn peak_force_follows_the_step(span: Span, impact: Span, law: &Contact) -> Diagnostic {
    let word = law.name();
    let (of, holds) = if law.numbers().is_empty() {
        (format!("the {word} law"), format!("`contact = {word}`"))
    } else {
        (format!("`{word}`"), format!("`contact = {word}(…)`"))
    };
    let message = format!("peak contact force depends on the time step under {of}, as 1/Δt");
    Diagnostic::new(Code::PeakForceUnderRigidLaw, message)
        .at(span, "depends on the time step")
        .at(impact, format!("{holds} applies here"))
        .help("require the `impulse`, or use a law that converges: `contact = hertz(…)`")
}

/// `first`: the longest step at which the limit acts at the first impact; `resolved`: the longest step that resolves the displacement.
pub fn limit_force_not_resolved(step: f64, span: Span, first: f64, resolved: f64) -> Diagnostic {
    let (now, first_text, resolved_text) = (time(step), time(first), time(resolved));
    let message = if step >= first {
        format!(
            "the limit force has no effect on the first impact: time step {now} must be below {first_text}"
        )
    } else {
        format!(
            "indentation may be wrong: time step {now} does not resolve the limit force (at most {resolved_text})"
        )
    };
    Diagnostic::new(Code::LimitForceNotResolved, message)
        .at(span, format!("time step {now}"))
        .help(format!("write `time_step = {resolved_text}` or less"))
}

/// `letters` are the first that no font of the page has, `printed` is their replacement.
pub fn not_printed(letters: &str, printed: &str, others: usize, span: Span) -> Diagnostic {
    let also = match others {
        0 => String::new(),
        1 => ", here and in one other string".to_owned(),
        more => format!(", here and in {more} other strings"),
    };
    Diagnostic::new(
        Code::NotPrinted,
        format!("the PDF report shows `{letters}` as `{printed}`{also}"),
    )
    .at(span, "characters without a glyph")
    .help(
        "add a Latin, Greek or Cyrillic spelling for the PDF; the HTML report shows all characters",
    )
}

pub fn nothing_required(span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NothingRequired,
        "the plan has no requirement: its verdict is only `completed`",
    )
    .at(span, "last procedure")
    .help("add a line such as `require \"stays in travel\" hit.max_displacement <= 8.5 mm`")
}

pub fn nothing_runs(span: Span) -> Diagnostic {
    Diagnostic::new(Code::NothingRuns, "the plan has no procedure")
        .at(span, "no procedure follows")
        .help("add a procedure, such as\nstiffness ramp k0 { displacements = 0.1 mm .. 1 mm step 0.1 mm }")
}

pub fn unused(keyword: &str, name: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::Unused, format!("`{keyword}` `{name}` is never used"))
        .at(span, "not used")
        .help("remove it, or use it")
}

/// A requirement on numbers of the plan alone. `met`: whether they meet it.
pub fn without_result(condition: &str, met: bool, span: Span) -> Diagnostic {
    let (code, always) = if met {
        (Code::AlwaysMet, "always")
    } else {
        (Code::NeverMet, "never")
    };
    Diagnostic::new(
        code,
        format!("`{condition}` is {always} met: it reads no result"),
    )
    .at(span, "decided before the run")
    .help("compare a result with a limit, as in `hit.max_displacement < 45 mm`")
}

pub fn never_negative(condition: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NeverMet,
        format!("no run meets `{condition}`: this result is never below 0"),
    )
    .at(span, "never met")
    .help("write a limit that a run can meet")
}

/// `limit`: the largest displacement \[m\] that the limits allow.
pub fn beyond_the_limit(condition: &str, limit: f64, span: Span) -> Diagnostic {
    let limit = shown(limit, Dimension::LENGTH);
    Diagnostic::new(
        Code::NeverMet,
        format!("no run meets `{condition}`: a run that exceeds {limit} is stopped"),
    )
    .at(span, "never met")
    .help(format!(
        "write a value below {limit}, or widen `displacement` in `limits` if the rig and the specimen allow it"
    ))
}

/// `other`: the requirement that excludes the one at `span`.
pub fn contradictory(span: Span, other: Span) -> Diagnostic {
    let diagnostic = Diagnostic::new(
        Code::NeverMet,
        "no run meets these conditions together: no value is within both",
    )
    .at(span, "excludes the other condition");
    let diagnostic = if other == span {
        diagnostic
    } else {
        diagnostic.at(other, "the other condition")
    };
    diagnostic.help("change one of the limits, or remove one of the conditions")
}

pub fn always_met(condition: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::AlwaysMet,
        format!("every run meets `{condition}`: this result is never below 0"),
    )
    .at(span, "always met")
    .help("write a limit that a run can miss, or remove the requirement")
}

/// Targets \[m\] at which a specimen with a constant stiffness has a force beyond the limits.
pub fn force_beyond_limits(
    field: &str,
    target: f64,
    force: f64,
    span: Span,
    limit: Interval,
    limit_at: Span,
) -> Diagnostic {
    let newtons = |value| shown(value, Dimension::FORCE);
    let (low, high) = (newtons(limit.low), newtons(limit.high));
    let target = shown(target, Dimension::LENGTH);
    Diagnostic::new(
        Code::BeyondLimits,
        format!(
            "`{field}` leads to {} at {target}, outside the limits {low} .. {high}",
            newtons(force)
        ),
    )
    .at(
        span,
        format!("{} by the specimen's stiffness", newtons(force)),
    )
    .at(limit_at, "limit")
    .help("stay within the limits, or widen them if the rig and the specimen allow it")
}
