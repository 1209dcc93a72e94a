//! Errors and warnings of frames and of their ground motion: E62x, W712 and W713.

use super::shown;
use crate::language::syntax::ast::Ident;
use crate::text::diagnostic::{Code, Diagnostic};
use crate::text::source::{Span, Spanned};
use crate::units::Dimension;
use crate::units::display::significant;

pub fn bad_record(file: &str, reason: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::GroundRecord, format!("`{file}` is no ground motion: {reason}"))
        .at(span, "cannot be used")
        .help("a table begins with `time_s,acceleration_m_per_s2` and then has rising times from 0; a PEER file says NPTS and DT")
}

pub fn record_without_unit(file: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::GroundRecord,
        format!("`{file}` does not say the unit of its accelerations"),
    )
    .at(span, "in which unit?")
    .help("add a line `unit = 1 m/s^2`, or `unit = 1 gn` where they are fractions of gravity")
}

pub fn unit_twice(file: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::GroundRecord,
        format!("the header of `{file}` says the unit of its accelerations already"),
    )
    .at(span, "said again")
    .help("remove `unit`; a factor is `scale = 1.5`")
}

pub fn bad_matrix(file: &str, reason: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::BadMatrix, format!("`{file}` is no matrix of a structure: {reason}"))
        .at(span, "cannot be used")
        .help("write a row a line, its numbers parted by commas; the matrix is square, symmetric and positive definite")
}

pub fn matrices_of_two_sizes(file: &str, stiffness: usize, mass: usize, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BadMatrix,
        format!("`{file}` has {stiffness} rows, and the mass matrix has {mass}"),
    )
    .at(span, "another size")
    .help("both matrices have a row and a column for each floor")
}

pub fn storey_without_stiffness(number: usize, span: Span) -> Diagnostic {
    Diagnostic::new(Code::StoreyStiffness, format!("storey {number} has no stiffness"))
        .at(span, "how stiff?")
        .help("add `stiffness: 3 MN/m`, or `column_stiffness: 1.5 MN/m` for one of its two columns, or a `behaviour`")
}

pub fn storey_stiffness_twice(number: usize, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::StoreyStiffness,
        format!("storey {number} says its stiffness twice"),
    )
    .at(span, "the second time")
    .help("keep `stiffness`, of the whole storey, or `column_stiffness`, of one of its two columns")
}

/// A stiffness \[N/m\], by the name of its field, beside a model with a different initial stiffness \[N/m\].
pub fn storey_bends_otherwise(
    number: usize,
    field: &str,
    stated: Spanned<f64>,
    model: Spanned<f64>,
) -> Diagnostic {
    let (stated_at, model_at) = (stated.span, model.span);
    let (stated, initial) = (
        shown(stated.node, Dimension::STIFFNESS),
        shown(model.node, Dimension::STIFFNESS),
    );
    Diagnostic::new(Code::StoreyBendsOtherwise, format!("storey {number} is said to have {stated}, and its behaviour begins with {initial}"))
        .at(stated_at, format!("the run integrates with {stated}"))
        .at(model_at, format!("and a virtual rig bends {initial}"))
        .help(format!(
            "remove `{field}`, so that the behaviour says it; or state how well it is known: `stiffness_uncertainty` of a third of what they are apart by, or more"
        ))
}

pub fn too_many_storeys(found: usize, most: usize, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::TooMany,
        format!("a frame has at most {most} storeys, this one {found}"),
    )
    .at(span, "too many")
    .help("each storey needs an actuator of its own; join some")
}

pub fn specimen_twice(first: &Ident, other: &Ident) -> Diagnostic {
    Diagnostic::new(
        Code::SpecimenTwice,
        format!("a specimen of `{}` has no `{}`", first.node, other.node),
    )
    .at(other.span, "says another structure")
    .at(first.span, "says the structure")
    .help(format!("remove `{}`, or `{}`", other.node, first.node))
}

pub fn matrix_alone(given: &Ident, missing: &str) -> Diagnostic {
    Diagnostic::new(
        Code::SpecimenTwice,
        format!("`{}` stands without `{missing}`", given.node),
    )
    .at(given.span, "half a structure")
    .help(format!(
        "add a line `{missing} = \"{}.csv\"`",
        &missing[..1]
    ))
}

pub fn matrix_uncertainty_alone(given: &Ident, matrix: &str) -> Diagnostic {
    Diagnostic::new(
        Code::SpecimenTwice,
        format!("`{}` stands without `{matrix}`", given.node),
    )
    .at(given.span, "uncertain of what?")
    .help(format!(
        "remove it: it is the uncertainty of a frame's `{matrix}`, read from a file"
    ))
}

pub fn no_storeys(specimen: &str, span: Span, declared: Span) -> Diagnostic {
    Diagnostic::new(Code::NoStoreys, format!("specimen `{specimen}` has no storeys, and `shake` moves the ground under some"))
        .at(span, "shakes it")
        .at(declared, "one degree of freedom, without storeys")
        .help("write `storeys = [storey(mass: 2 t, stiffness: 3 MN/m)]` in place of its mass and behaviour")
}

pub fn one_degree_of_freedom(
    keyword: &str,
    specimen: &str,
    axes: usize,
    span: Span,
    declared: Option<Span>,
) -> Diagnostic {
    let diagnostic = Diagnostic::new(
        Code::OneDegreeOfFreedom,
        format!("`{keyword}` drives one actuator, and the frame `{specimen}` has {axes}"),
    )
    .at(span, "one degree of freedom");
    let diagnostic = match declared {
        Some(declared) => diagnostic.at(declared, format!("{axes} storeys")),
        None => diagnostic,
    };
    diagnostic.help("test the storeys by `shake`, `impact`, `escalate` or `unload`, or a specimen of one degree of freedom in a plan of its own")
}

/// A frame without the floor that the striker hits.
pub fn which_storey(specimen: &str, storeys: usize, at: Span, declared: Span) -> Diagnostic {
    Diagnostic::new(
        Code::WhichStorey,
        format!("the frame `{specimen}` has {storeys} storeys: which of them is struck?"),
    )
    .at(at, "strikes it")
    .at(declared, format!("{storeys} storeys"))
    .help(format!("add a line `storey = {storeys}`; the lowest is 1"))
}

pub fn no_such_storey(specimen: &str, storeys: usize, at: Span, declared: Span) -> Diagnostic {
    let has = if storeys == 1 {
        "one storey".to_owned()
    } else {
        format!("{storeys} storeys")
    };
    Diagnostic::new(
        Code::WhichStorey,
        format!("the frame `{specimen}` has {has}, counted from the ground up"),
    )
    .at(at, "no such storey")
    .at(declared, has)
    .help(format!("the top one is `storey = {storeys}`"))
}

pub fn storey_of_none(specimen: &str, at: Span, declared: Span) -> Diagnostic {
    Diagnostic::new(
        Code::WhichStorey,
        format!("specimen `{specimen}` has no storeys, so that none of them is struck"),
    )
    .at(at, "which storey?")
    .at(declared, "one degree of freedom, without storeys")
    .help(
        "remove `storey`, or give the specimen `storeys = [storey(mass: 2 t, stiffness: 3 MN/m)]`",
    )
}

/// A field of the other kind of impact.
pub fn no_use_on_a_frame(field: &str, of: &str, at: Span, help: &str) -> Diagnostic {
    Diagnostic::new(
        Code::NoUseOnAFrame,
        format!("`{field}` says nothing of {of}"),
    )
    .at(at, "has no use here")
    .help(help)
}

pub fn of_a_frame_only(field: &str, at: Span, help: &str) -> Diagnostic {
    Diagnostic::new(
        Code::NoUseOnAFrame,
        format!("`{field}` says something of frames only, and this impact strikes none"),
    )
    .at(at, "has no use here")
    .help(help)
}

pub fn result_of_a_storey(result: &str, at: Span, head: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NoUseOnAFrame,
        format!("only an impact on a storey of a frame has `{result}`"),
    )
    .at(at, "not of this impact")
    .at(head, "strikes one degree of freedom")
    .help("strike a frame: its specimen has `storeys`, and the impact says `storey = 1`")
}

pub fn result_of_a_frame(result: &str, at: Span, head: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NoUseOnAFrame,
        format!("only the unloading of a frame has `{result}`"),
    )
    .at(at, "not of this unloading")
    .at(head, "unloads one degree of freedom")
    .help("read `residual_displacement` and `residual_force`")
}

pub fn damping_ratios(found: usize, modes: usize, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::DampingRatios,
        format!("{found} damping ratios for {modes} modes"),
    )
    .at(span, "a list has one for each mode")
    .help("give one ratio for each mode, the longest period first, or one number: Rayleigh damping")
}

/// A damping ratio below 0 within its uncertainty.
pub fn damping_too_uncertain(uncertainty: f64, least: f64, span: Span) -> Diagnostic {
    let percent = |number: f64| format!("{} %", significant(100.0 * number, 2));
    let of = format!("the damping ratio of {} would be below 0", percent(least));
    Diagnostic::new(Code::DampingTooUncertain, format!("less its uncertainty, {of}"))
        .at(span, format!("{} is one standard uncertainty", percent(uncertainty)))
        .help("write a standard uncertainty of at most the damping ratio; of a ratio in 0 to ζ, all as likely, it is ζ / (2 √3)")
}

pub fn damping_impossible(reason: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::DampingRatios,
        format!("no damping matrix has these ratios: {reason}"),
    )
    .at(span, "cannot be met")
    .help("give each mode its own ratio: `damping_ratio = [2, 3] %`")
}

pub fn no_one_of_its_kind(name: Option<&Ident>, property: &str, span: Span) -> Diagnostic {
    let name = name.map_or("the frame", |name| name.node.as_str());
    Diagnostic::new(
        Code::NoOneStiffness,
        format!("`{name}` is a frame: no one `{property}` is its own"),
    )
    .at(span, "which storey's?")
    .help("declare the storey's own by `let`, and read that")
}

pub fn unstable_though(span: Span, step: f64, limit: f64) -> Diagnostic {
    let (step, limit) = (shown(step, Dimension::TIME), shown(limit, Dimension::TIME));
    Diagnostic::new(
        Code::BeyondStability,
        format!("the time step {step} is beyond the stability limit {limit}, and the plan allows it: the motion will grow"),
    )
    .at(span, "allowed here")
    .help("remove `allow_unstable` unless the growth is what is to be seen")
}

pub fn record_finer_than_step(span: Span, step: f64, spacing: f64, ground: &str) -> Diagnostic {
    let (step, spacing) = (
        shown(step, Dimension::TIME),
        shown(spacing, Dimension::TIME),
    );
    Diagnostic::new(
        Code::RecordFinerThanStep,
        format!("the time step {step} is longer than the {spacing} between samples of `{ground}`: peaks between are not felt"),
    )
    .at(span, format!("{step}, the record has {spacing}"))
    .help(format!("write `time_step = {spacing}` or less"))
}
