//! Errors of values: E4xx.

use super::shown;
use psd_physics::statistics::student_t::coverage;
use psd_plan::Interval;
use psd_plan::schema::{Field, Range};
use psd_plan::uncertainty::FEW;
use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::Span;
use psd_text::units::display::significant;
use psd_text::units::{Dimension, display};

fn allowed(range: Range, dimension: Dimension) -> String {
    let number = |value: f64| ((value * 1e4).round() / 1e4).to_string();
    let show = |value: f64| {
        if dimension == Dimension::NUMBER || value == 0.0 {
            number(value)
        } else {
            shown(value, dimension)
        }
    };
    match (range.low.is_finite(), range.above, range.high.is_finite()) {
        (true, true, false) => format!("greater than {}", show(range.low)),
        (true, false, false) => format!("at least {}", show(range.low)),
        (true, true, true) => format!(
            "greater than {} and at most {}",
            show(range.low),
            show(range.high)
        ),
        (true, false, true) => format!("between {} and {}", show(range.low), show(range.high)),
        _ => format!("at most {}", show(range.high)),
    }
}

pub fn out_of_range(
    field: &Field,
    dimension: Dimension,
    value: f64,
    text: &str,
    span: Span,
) -> Diagnostic {
    let allowed = allowed(field.range, dimension);
    let is = if dimension == Dimension::NUMBER {
        value.to_string()
    } else {
        shown(value, dimension)
    };
    let mirrored = text
        .strip_prefix('-')
        .map(str::trim_start)
        .filter(|_| -value > field.range.low && -value <= field.range.high);
    let help = mirrored.map_or_else(
        || format!("write a value that is {allowed}"),
        |size| format!("write its absolute value, `{size}`"),
    );
    // A literal is not repeated: "`-10 kg` is -10 kg".
    let side = if value > field.range.high {
        "too large"
    } else {
        "too small"
    };
    let label = if is == text {
        side.to_owned()
    } else {
        format!("`{text}` is {is}")
    };
    Diagnostic::new(
        Code::OutOfRange,
        format!("`{}` must be {allowed}", field.name),
    )
    .at(span, label)
    .help(help)
}

/// `dimension` is that of the value, whose name begins the name of the field.
pub fn too_uncertain(
    field: &str,
    uncertainty: f64,
    value: f64,
    dimension: Dimension,
    span: Span,
) -> Diagnostic {
    let (uncertainty, value) = (shown(uncertainty, dimension), shown(value, dimension));
    let of = field.trim_end_matches("_uncertainty");
    Diagnostic::new(Code::TooUncertain, format!("`{field}` exceeds a fifth of the `{of}`, {value}"))
        .at(span, format!("standard uncertainty: {uncertainty}"))
        .help(
            "write the standard uncertainty: half of a 95 % coverage interval ±a, or a/√3 for a rectangular distribution",
        )
}

/// A mass whose uncertainty is not used.
pub fn uncertainty_unused(specimen: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::UncertaintyUnused, format!("the uncertainty of the mass of `{specimen}` has no effect on any result"))
        .at(span, "mass not used by any impact")
        .help("remove `mass` from the impact, so that the specimen's mass is used; or remove `mass_uncertainty`")
}

pub fn few_degrees_of_freedom(
    ramp: &str,
    points: usize,
    degrees: usize,
    displacements: Span,
    required: Span,
) -> Diagnostic {
    #[expect(clippy::cast_precision_loss, reason = "a few")]
    let factor = significant(coverage(degrees as f64), 3);
    let freedom = if degrees == 1 {
        "1 degree of freedom".to_owned()
    } else {
        format!("{degrees} degrees of freedom")
    };
    let text = format!(
        "uncertainty is large: {points} steps leave {freedom} in the fit of `{ramp}`, U = {factor} × standard error"
    );
    Diagnostic::new(Code::FewDegreesOfFreedom, text)
        .at(displacements, format!("{points} steps"))
        .at(required, "fitted result read here")
        .help(format!(
            "write {} steps or more",
            points + usize::from(FEW) - degrees
        ))
}

pub fn zero(field: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::OutOfRange, format!("`{field}` must not be 0"))
        .at(span, "scale factor is zero")
        .help("write the scale factor with its sign")
}

pub fn even(field: &str, span: Span, value: u32) -> Diagnostic {
    Diagnostic::new(
        Code::OutOfRange,
        format!("`{field}` must be odd, so that one reading is the median"),
    )
    .at(span, "even")
    .help(format!(
        "write {} or {}",
        value.saturating_sub(1),
        value + 1
    ))
}

pub fn not_whole(field: &str, span: Span, text: &str) -> Diagnostic {
    Diagnostic::new(
        Code::OutOfRange,
        format!("`{field}` must be a whole number"),
    )
    .at(span, format!("`{text}` is not whole"))
    .help("write it without decimals")
}

pub fn negative_bound(field: &str, span: Span, text: &str, symmetric: bool) -> Diagnostic {
    let help = if symmetric {
        "write both ends, as in `-2 mm .. 25 mm`, or one positive bound"
    } else {
        "write the absolute value"
    };
    Diagnostic::new(
        Code::OutOfRange,
        format!("the bound on `{field}` must be at least 0"),
    )
    .at(span, format!("`{text}` is negative"))
    .help(help)
}

/// For `A within TOLERANCE of B`: a tolerance must be positive.
pub fn negative_tolerance(span: Span, text: &str) -> Diagnostic {
    Diagnostic::new(
        Code::OutOfRange,
        "the tolerance of `within` must be at least 0",
    )
    .at(span, format!("`{text}` is negative"))
    .help("write the absolute value")
}

pub fn bounds_reversed(span: Span, low: &str, high: &str) -> Diagnostic {
    Diagnostic::new(
        Code::OutOfRange,
        format!("range in reverse order: `{low}` is more than `{high}`"),
    )
    .at(span, "lower end must be first")
    .help(format!("write `{high} .. {low}`"))
}

pub fn parameter_out_of_bounds(
    name: &str,
    text: &str,
    span: Span,
    bounds: Interval,
    dimension: Dimension,
) -> Diagnostic {
    let (low, high) = (shown(bounds.low, dimension), shown(bounds.high, dimension));
    Diagnostic::new(
        Code::OutOfRange,
        format!("`{name}` is outside its range {low} .. {high}"),
    )
    .at(span, format!("`{text}` is outside"))
    .help("widen the range or change the value")
}

/// `name`: as in `--set speed`, or the parameter alone where no text gives the value.
pub fn setting_out_of_range(
    name: &str,
    text: &str,
    span: Span,
    bounds: Interval,
    dimension: Dimension,
    bounds_at: Span,
) -> Diagnostic {
    let (low, high) = (shown(bounds.low, dimension), shown(bounds.high, dimension));
    Diagnostic::new(
        Code::SettingOutOfRange,
        format!("`{name}` is outside {low} .. {high}"),
    )
    .at(span, format!("`{text}` is outside"))
    .at(bounds_at, "allowed range")
    .help(format!("write a value between {low} and {high}"))
}

pub fn no_such_entry(span: Span, entry: usize, length: usize) -> Diagnostic {
    Diagnostic::new(
        Code::OutOfRange,
        format!("the list has no entry {entry}: its length is {length}"),
    )
    .at(span, "past the end")
    .help(format!(
        "write at most {}, the index of the last entry",
        length.saturating_sub(1)
    ))
}

pub fn empty_list(span: Span) -> Diagnostic {
    Diagnostic::new(Code::OutOfRange, "a list must have at least one entry")
        .at(span, "empty list")
        .help("write the entries, as in `[1, 2, 5] mm`")
}

pub fn range_without_step(span: Span, text: &str) -> Diagnostic {
    Diagnostic::new(Code::BadRange, "this range requires a step")
        .at(span, "list required")
        .help(format!("add one, as in `{text} step …`"))
}

pub fn step_in_bounds(span: Span) -> Diagnostic {
    Diagnostic::new(Code::BadRange, "a range of allowed values has no step")
        .at(span, "not allowed here")
        .help("remove `step`")
}

pub fn range_not_constant(span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::UsedBeforeItRan,
        "both ends and the step of a range must be known before the run",
    )
    .at(span, "known only after the run")
    .help("write numbers, or a `let` or `param` of numbers")
}

pub fn step_leads_away(span: Span, text: &str, zero: bool) -> Diagnostic {
    let help = match text.strip_prefix('-') {
        _ if zero => "a step must not be zero".to_owned(),
        Some(size) => format!("write `step {}`: this range increases", size.trim_start()),
        None => format!("write `step -{text}`: this range decreases"),
    };
    Diagnostic::new(
        Code::BadRange,
        "the step does not lead from the start to the end",
    )
    .at(span, format!("`{text}` never reaches the end"))
    .help(help)
}

pub fn step_does_not_divide(
    range: Span,
    step: Span,
    length: f64,
    count: f64,
    dimension: Dimension,
) -> Diagnostic {
    // Only sizes with few digits: a third of 1 mm is not suggested.
    let size = |steps: &f64| {
        let size = length / steps;
        let short = display::plain(size, dimension, 6);
        (short == display::plain(size, dimension, 14)).then_some(short)
    };
    let whole = |offset: u32| count.floor() + f64::from(offset);
    let larger = (0..1000)
        .map(|less| count.floor() - f64::from(less))
        .take_while(|steps| *steps >= 1.0)
        .find_map(|it| size(&it));
    let smaller = (1..1000).map(whole).find_map(|it| size(&it));
    let nearest = match (smaller, larger) {
        (Some(smaller), Some(larger)) => format!("write `step {smaller}` or `step {larger}`"),
        (Some(one), None) | (None, Some(one)) => format!("write `step {one}`"),
        (None, None) => {
            "change an end of the range by the remainder, or write another step".to_owned()
        }
    };
    Diagnostic::new(Code::BadRange, "the step does not divide the range")
        .at(step, "remainder at the end")
        .at(range, "both ends are part of the range")
        .help(nearest)
}

pub fn too_many_entries(span: Span, found: f64, most: usize) -> Diagnostic {
    let found = if found < 1e12 {
        found.to_string()
    } else {
        format!("about {found:.0e}")
    };
    Diagnostic::new(
        Code::TooMany,
        format!("too many entries in a list: {found} (at most {most})"),
    )
    .at(span, "too many")
    .help("write a larger step")
}

pub fn too_many(what: &str, found: f64, most: f64, span: Span, help: &str) -> Diagnostic {
    // A readable count; for a larger one its order of magnitude.
    let found = if found < 1e12 {
        found.to_string()
    } else {
        format!("about {found:.0e}")
    };
    Diagnostic::new(
        Code::TooMany,
        format!("too many {what} in a procedure: {found} (at most {most})"),
    )
    .at(span, "too many")
    .help(help)
}

/// A limit on the speed that allows none.
pub fn no_motion(field: &str, help: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::OutOfRange,
        format!("the bound on `{field}` must be greater than 0"),
    )
    .at(span, "no motion possible")
    .help(help)
}

/// Values that depend on one another too deeply.
pub fn too_deep(span: Span, most: usize) -> Diagnostic {
    Diagnostic::new(
        Code::TooMany,
        format!("values are nested more than {most} deep"),
    )
    .at(span, "too deep")
    .help("declare a value before the values that use it, or use fewer intermediate values")
}

/// A value that is copied wherever it is named.
pub fn too_many_terms(span: Span, most: usize) -> Diagnostic {
    Diagnostic::new(
        Code::TooMany,
        format!("a value can use at most {most} results and operators, including those of the values it names"),
    )
    .at(span, "too many")
    .help("name each result once, or simplify the calculation")
}

pub fn not_finite(span: Span) -> Diagnostic {
    Diagnostic::new(Code::NotFinite, "the value is not a finite number")
        .at(span, "zero divisor, negative root, or too large")
        .help("change the expression so that its value is finite")
}

pub fn energy_not_finite(span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NotFinite,
        "the energy of the striker, ½ m v², is not a finite number",
    )
    .at(span, "velocity or mass too large")
    .help("reduce its velocity or its mass")
}

pub fn edition(span: Span, text: &str) -> Diagnostic {
    Diagnostic::new(
        Code::Edition,
        format!("this version reads edition 1 of the language, not {text}"),
    )
    .at(span, "unknown edition")
    .help("write `edition = 1`, or use the version of psd for which the plan was written")
}

pub fn needs_the_run(span: Span, text: &str) -> Diagnostic {
    Diagnostic::new(Code::UsedBeforeItRan, "this must be known before the run")
        .at(span, format!("`{text}` is known only during the run"))
        .help("write a number, or a `let` or `param` of numbers")
}

pub fn result_before_the_run(text: &str, span: Span, what: &str, procedure: Span) -> Diagnostic {
    Diagnostic::new(
        Code::UsedBeforeItRan,
        format!("`{text}` is a result, but {what} is fixed before the run"),
    )
    .at(span, "known only after the run")
    .at(procedure, "its procedure")
    .help("read results only in fields of later procedures and in `require`")
}

pub fn own_result(text: &str, span: Span, procedure: Span) -> Diagnostic {
    Diagnostic::new(
        Code::UsedBeforeItRan,
        format!("`{text}` is a result of the procedure that uses it"),
    )
    .at(span, "known only after this procedure")
    .at(procedure, "this procedure")
    .help("read a result of an earlier procedure")
}

pub fn result_of_later_procedure(text: &str, span: Span, procedure: Span) -> Diagnostic {
    Diagnostic::new(
        Code::UsedBeforeItRan,
        format!("`{text}` is used before its procedure runs"),
    )
    .at(span, "used here")
    .at(procedure, "runs later")
    .help("move that procedure up: procedures run in the order written")
}

/// `read` is a ramp result that an expression reads, `lacks` why it never exists, `help` the remedy.
pub fn never_given(
    read: &str,
    span: Span,
    ramp: (&str, Span),
    lacks: &str,
    help: &str,
) -> Diagnostic {
    Diagnostic::new(
        Code::NeverGiven,
        format!("ramp `{}` never gives `{read}`: {lacks}", ramp.0),
    )
    .at(span, "read here")
    .at(ramp.1, "from this ramp")
    .help(help.to_owned())
}

/// `result` is read by a requirement under the guarded rule, and never has an uncertainty.
pub fn nothing_to_guard(result: &str, required: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NothingToGuard,
        format!("`{result}` never has an uncertainty: guarded acceptance has no guard band for it"),
    )
    .at(required, "simple acceptance is used")
    .help("write a limit that includes a margin, or require a measured result")
}

/// Under the guarded rule, and on a rig that does not declare these `fields`, no measured result is decided.
pub fn partial_under_guard(rig: &str, fields: &[&str], head: Span) -> Diagnostic {
    let fields: Vec<String> = fields.iter().map(|field| format!("`{field}`")).collect();
    Diagnostic::new(
        Code::PartialUnderGuard,
        format!("under `guarded` nothing that is measured can be decided on rig `{rig}`"),
    )
    .at(head, format!("without {}", fields.join(" and ")))
    .help(format!("declare {}", fields.join(" and ")))
}

/// `read` is a position at the last step of a run; `row`: of an impact series.
pub fn final_is_not_residual(read: &str, row: bool, required: Span, head: Span) -> Diagnostic {
    let or_row = if row {
        ", or write `between = unload`"
    } else {
        ""
    };
    Diagnostic::new(
        Code::FinalIsNotResidual,
        format!("`{read}` is read under load: it is not a residual value"),
    )
    .at(required, "value at the last step")
    .at(head, "not unloaded afterwards")
    .help(format!(
        "add `unload rest {{ }}`, and require its `residual_…`{or_row}"
    ))
}

/// An entry that has no effect here: the reason, and the remedy.
pub fn no_effect(message: String, span: Span, label: &str, help: &str) -> Diagnostic {
    Diagnostic::new(Code::NoEffect, message)
        .at(span, label.to_owned())
        .help(help.to_owned())
}
