//! Errors and warnings of frames and of their ground motion: E62x, W712 and W713.

use super::shown;
use crate::syntax::ast::Ident;
use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::{Span, Spanned};
use psd_text::units::Dimension;
use psd_text::units::display::significant;

/// `files`: where the list is.
pub fn no_such_record(number: usize, count: usize, span: Span, files: Span) -> Diagnostic {
    Diagnostic::new(
        Code::OutOfRange,
        format!("record {number} does not exist: the list has {count}"),
    )
    .at(span, "number of the record")
    .at(files, format!("{count} in the list"))
    .help(format!("write a number from 1 to {count}"))
}

pub fn bad_record(file: &str, reason: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::GroundRecord, format!("cannot read `{file}` as a ground motion: {reason}"))
        .at(span, "invalid record")
        .help("write the header `time_s,acceleration_m_per_s2` and times that increase from 0, or use a PEER file with NPTS and DT")
}

pub fn record_without_unit(file: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::GroundRecord,
        format!("`{file}` does not state the unit of its accelerations"),
    )
    .at(span, "unit missing")
    .help("add a line `unit = 1 m/s^2`, or `unit = 1 gn` for fractions of gravity")
}

pub fn unit_twice(file: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::GroundRecord,
        format!("unit given twice: the header of `{file}` states the unit of its accelerations"),
    )
    .at(span, "given again")
    .help("remove `unit`; write a factor as `scale = 1.5`")
}

pub fn bad_matrix(file: &str, reason: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::BadMatrix, format!("cannot read `{file}` as a structural matrix: {reason}"))
        .at(span, "invalid matrix")
        .help("write one row per line, comma-separated; the matrix must be square, symmetric and positive definite")
}

pub fn matrices_of_two_sizes(file: &str, stiffness: usize, mass: usize, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BadMatrix,
        format!("matrix sizes differ: `{file}` has {stiffness} rows, the mass matrix has {mass}"),
    )
    .at(span, "different size")
    .help("write both matrices with one row and one column per floor")
}

pub fn storey_without_stiffness(number: usize, span: Span) -> Diagnostic {
    Diagnostic::new(Code::StoreyStiffness, format!("storey {number} has no stiffness"))
        .at(span, "stiffness missing")
        .help("add `stiffness: 3 MN/m`, or `column_stiffness: 1.5 MN/m` for one of its two columns, or a `behaviour`")
}

pub fn storey_stiffness_twice(number: usize, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::StoreyStiffness,
        format!("storey {number} has two stiffnesses"),
    )
    .at(span, "given again")
    .help("keep `stiffness` (whole storey) or `column_stiffness` (one of its two columns)")
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
    Diagnostic::new(
        Code::StoreyBendsOtherwise,
        format!(
            "storey {number}: stated stiffness {stated} differs from the \
     model's initial stiffness {initial}"
        ),
    )
    .at(stated_at, format!("stated stiffness: {stated}"))
    .at(
        model_at,
        format!("initial stiffness of the model: {initial}"),
    )
    .help(format!(
        "remove `{field}`, or set `stiffness_uncertainty` to a third of the difference or more"
    ))
}

pub fn too_many_storeys(found: usize, most: usize, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::TooMany,
        format!("too many storeys: {found} (at most {most})"),
    )
    .at(span, "too many")
    .help("combine storeys; each one requires an actuator")
}

pub fn specimen_twice(first: &Ident, other: &Ident) -> Diagnostic {
    Diagnostic::new(
        Code::SpecimenTwice,
        format!(
            "structure given twice: by `{}` and by `{}`",
            first.node, other.node
        ),
    )
    .at(other.span, "given again")
    .at(first.span, "first given here")
    .help(format!("remove `{}`, or `{}`", other.node, first.node))
}

pub fn matrix_alone(given: &Ident, missing: &str) -> Diagnostic {
    Diagnostic::new(
        Code::SpecimenTwice,
        format!("`{}` requires `{missing}`", given.node),
    )
    .at(given.span, "one matrix only")
    .help(format!(
        "add a line `{missing} = \"{}.csv\"`",
        &missing[..1]
    ))
}

pub fn matrix_uncertainty_alone(given: &Ident, matrix: &str) -> Diagnostic {
    Diagnostic::new(
        Code::SpecimenTwice,
        format!("`{}` requires `{matrix}`", given.node),
    )
    .at(given.span, "matrix missing")
    .help(format!(
        "remove it, or read the frame's `{matrix}` from a file"
    ))
}

pub fn no_storeys(specimen: &str, span: Span, declared: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NoStoreys,
        format!("specimen `{specimen}` has no storeys; `shake` requires a frame"),
    )
    .at(span, "requires storeys")
    .at(declared, "no storeys")
    .help("write `storeys = [storey(mass: 2 t, stiffness: 3 MN/m)]` instead of mass and behaviour")
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
        format!("`{keyword}` drives one actuator, but the frame `{specimen}` has {axes}"),
    )
    .at(span, "one degree of freedom");
    let diagnostic = match declared {
        Some(declared) => diagnostic.at(declared, format!("{axes} storeys")),
        None => diagnostic,
    };
    diagnostic.help("use `shake`, `impact`, `escalate` or `unload` for a frame, or test a single-degree-of-freedom \
     specimen in a separate plan")
}

/// A frame without the floor that the striker hits.
pub fn which_storey(specimen: &str, storeys: usize, at: Span, declared: Span) -> Diagnostic {
    Diagnostic::new(
        Code::WhichStorey,
        format!("struck storey missing: the frame `{specimen}` has {storeys} storeys"),
    )
    .at(at, "storey missing")
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
        format!("storey does not exist: frame `{specimen}` has {has}, counted from the ground up"),
    )
    .at(at, "no such storey")
    .at(declared, has)
    .help(format!("write `storey = {storeys}` for the top one"))
}

pub fn storey_of_none(specimen: &str, at: Span, declared: Span) -> Diagnostic {
    Diagnostic::new(
        Code::WhichStorey,
        format!("specimen `{specimen}` has no storeys, but the impact has `storey`"),
    )
    .at(at, "no storeys to strike")
    .at(declared, "no storeys")
    .help(
        "remove `storey`, or write `storeys = [storey(mass: 2 t, stiffness: 3 MN/m)]` in the specimen",
    )
}

/// A field of the other kind of impact.
pub fn no_use_on_a_frame(field: &str, of: &str, at: Span, help: &str) -> Diagnostic {
    Diagnostic::new(
        Code::NoUseOnAFrame,
        format!("`{field}` has no effect in {of}"),
    )
    .at(at, "no effect here")
    .help(help)
}

pub fn of_a_frame_only(field: &str, at: Span, help: &str) -> Diagnostic {
    Diagnostic::new(
        Code::NoUseOnAFrame,
        format!("`{field}` requires a frame, but this impact strikes one degree of freedom"),
    )
    .at(at, "no effect here")
    .help(help)
}

pub fn result_of_a_storey(result: &str, at: Span, head: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NoUseOnAFrame,
        format!("`{result}` exists only for an impact on a frame"),
    )
    .at(at, "not a result here")
    .at(head, "strikes one degree of freedom")
    .help("write `storeys` in the specimen and `storey = 1` in the impact")
}

pub fn result_of_a_frame(result: &str, at: Span, head: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NoUseOnAFrame,
        format!("`{result}` exists only for the unloading of a frame"),
    )
    .at(at, "not a result here")
    .at(head, "unloads one degree of freedom")
    .help("read `residual_displacement` and `residual_force`")
}

pub fn damping_ratios(found: usize, modes: usize, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::DampingRatios,
        format!("number of damping ratios differs: {found} for {modes} modes"),
    )
    .at(span, "one per mode required")
    .help("write one ratio per mode, the longest period first, or one number for Rayleigh damping")
}

/// A damping ratio below 0 within its uncertainty.
pub fn damping_too_uncertain(uncertainty: f64, least: f64, span: Span) -> Diagnostic {
    let percent = |number: f64| format!("{} %", significant(100.0 * number, 2));
    let of = format!(
        "damping ratio minus its uncertainty is below 0: {}",
        percent(least)
    );
    Diagnostic::new(Code::DampingTooUncertain, format!("minus its uncertainty, {of}"))
        .at(span, format!("standard uncertainty: {}", percent(uncertainty)))
        .help("write an uncertainty up to the damping ratio; for a rectangular distribution on 0 .. ζ it is ζ / (2 √3)")
}

pub fn damping_impossible(reason: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::DampingRatios,
        format!("no damping matrix has these ratios: {reason}"),
    )
    .at(span, "not possible")
    .help("write one ratio per mode: `damping_ratio = [2, 3] %`")
}

pub fn no_one_of_its_kind(name: Option<&Ident>, property: &str, span: Span) -> Diagnostic {
    let name = name.map_or("the frame", |name| name.node.as_str());
    Diagnostic::new(
        Code::NoOneStiffness,
        format!("`{name}` is a frame: it has no single `{property}`"),
    )
    .at(span, "several storeys")
    .help("declare the value of one storey with `let`, and read that")
}

pub fn unstable_though(span: Span, step: f64, limit: f64) -> Diagnostic {
    let (step, limit) = (shown(step, Dimension::TIME), shown(limit, Dimension::TIME));
    Diagnostic::new(
        Code::BeyondStability,
        format!("the motion will grow: time step {step} exceeds the stability limit {limit}"),
    )
    .at(span, "allowed here")
    .help("remove `allow_unstable`, unless the growth itself is to be shown")
}

pub fn record_finer_than_step(span: Span, step: f64, spacing: f64, ground: &str) -> Diagnostic {
    let (step, spacing) = (
        shown(step, Dimension::TIME),
        shown(spacing, Dimension::TIME),
    );
    Diagnostic::new(
        Code::RecordFinerThanStep,
        format!("ground peaks may be missed: time step {step} exceeds the sample spacing {spacing} of `{ground}`"),
    )
    .at(span, format!("{step}, sample spacing is {spacing}"))
    .help(format!("write `time_step = {spacing}` or less"))
}
