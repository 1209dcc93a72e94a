//! Errors of specimens: E401 of a relaxation, E630 to E634, E649, E650, and W715, W724, W726.

use super::shown;
use crate::syntax::ast::Ident;
use psd_plan::{Interval, Mechanism};
use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::Span;
use psd_text::units::Dimension;

pub fn backbone_lists_differ(
    displacements: Span,
    forces: Span,
    counts: (usize, usize),
) -> Diagnostic {
    Diagnostic::new(
        Code::CornersDoNotFit,
        "number of displacements and forces differs",
    )
    .at(displacements, format!("{} displacements", counts.0))
    .at(forces, format!("{} forces", counts.1))
    .help("write both lists with the same length")
}

/// `index` counts from 0.
pub fn backbone_point(index: usize, span: Span, label: &str, help: &str) -> Diagnostic {
    Diagnostic::new(
        Code::CornersDoNotFit,
        format!("backbone point {} is invalid", index + 1),
    )
    .at(span, label)
    .help(help)
}

/// A row of a table, its line number from 1 and its text; without a row the error concerns the whole file.
pub fn table_file(
    file: &str,
    row: Option<&(usize, String)>,
    reason: &str,
    named_at: Span,
    help: &str,
) -> Diagnostic {
    let line_text = row.map_or_else(String::new, |(line, text)| {
        format!(", line {line}, `{text}`")
    });
    Diagnostic::new(Code::BadTableFile, format!("`{file}`{line_text}: {reason}"))
        .at(named_at, "the table")
        .help(help)
}

pub fn breaks_counted_twice(breaks: Span, most: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BreaksTwice,
        "`breaks` states the number of breakpoints: `most` has no effect",
    )
    .at(most, "bounds an automatic choice")
    .at(breaks, "number stated here")
    .help("remove `most`, or remove `breaks` for an automatic choice")
}

/// A backbone that descends before it yields.
pub fn capped_before_yield(displacement: f64, yielded: f64, span: Span) -> Diagnostic {
    let [displacement, yielded] =
        [displacement, yielded].map(|value| shown(value, Dimension::LENGTH));
    Diagnostic::new(
        Code::CornersDoNotFit,
        format!("capping at {displacement} is before yield"),
    )
    .at(span, format!("yields at {yielded}"))
    .help(format!("write a `capping_displacement` above {yielded}"))
}

/// The loss of force of a logarithmic relaxation.
#[derive(Clone, Copy)]
pub struct RelaxationLoss {
    /// a of a·ln(1 + t/t₀): fraction of the force that is lost each time 1 + t/t₀ grows e-fold.
    pub share: f64,
    /// Fraction of the force that is lost at the end.
    pub lost: f64,
    /// Duration of the relaxation \[s\].
    pub longest: f64,
}

pub fn relaxes_away(loss: RelaxationLoss, span: Span) -> Diagnostic {
    let RelaxationLoss { share, lost, .. } = loss;
    let longest = shown(loss.longest, Dimension::TIME);
    let percent = |number: f64| psd_text::units::display::significant(100.0 * number, 3);
    Diagnostic::new(Code::OutOfRange, "relaxation would exceed the force itself")
        .at(span, format!("loses {} % until {longest}", percent(lost)))
        .help(format!(
            "write a `share` below {} %, or a shorter `longest`",
            percent(0.99 * share / lost)
        ))
}

/// The law ends before it begins.
pub fn relaxes_too_short(longest: f64, reference_time: f64, span: Span) -> Diagnostic {
    let times = [longest, reference_time].map(|time| shown(time, Dimension::TIME));
    Diagnostic::new(
        Code::OutOfRange,
        format!(
            "relaxation that ends after {} is too short for the logarithmic law",
            times[0]
        ),
    )
    .at(span, format!("`reference_time` is {}", times[1]))
    .help(format!(
        "write a `longest` of {} or more",
        shown(10.0 * reference_time, Dimension::TIME)
    ))
}

/// The time range of the readings of a dwell, last over first.
pub fn few_decades(readings: u32, span: Span) -> Diagnostic {
    let spanned = u64::from(readings) * u64::from(readings);
    let message = format!("{readings} readings per pause cannot distinguish relaxation laws");
    Diagnostic::new(Code::FewDecades, message)
        .at(span, format!("last reading at {spanned} × the first time"))
        .help("write ten `readings` or more, which span two decades of time")
}

pub fn relaxation_without_hold(relaxation: Span) -> Diagnostic {
    Diagnostic::new(
        Code::RelaxationWithoutHold,
        "`relaxation` requires a `pause`",
    )
    .at(relaxation, "no readings without a pause")
    .help("add a line such as `pause = 5 s`")
}

/// Two arguments, one of which has no meaning without the other.
pub fn missing_partner(given: &str, missing: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BehaviourIncomplete,
        format!("`{given}` requires `{missing}`"),
    )
    .at(span, format!("`{missing}` is missing"))
    .help(format!("add `{missing}`, or remove `{given}`"))
}

/// Exactly one of two forms is required; `takes` names the owner and both forms, `example` shows one.
pub fn one_form_only(takes: &str, example: &str, span: Span, given: usize) -> Diagnostic {
    let (label, help) = if given == 0 {
        (
            "neither is given",
            format!("add one of them, such as `{example}`"),
        )
    } else {
        ("both are given", "remove one of them".to_owned())
    };
    Diagnostic::new(Code::BehaviourIncomplete, format!("{takes}, but not both"))
        .at(span, label)
        .help(help)
}

/// Neither a mass nor a weight that moves with the load.
pub fn portal_without_mass(name: Option<&Ident>, head: Span) -> Diagnostic {
    let name = name.map_or("", |name| name.node.as_str());
    Diagnostic::new(
        Code::MissingField,
        format!("specimen `{name}` has no mass: no moving part of its portal has one"),
    )
    .at(head, "`mass` is missing")
    .help("add the mass of the members, such as `mass_per_length: 12 kg/m` in `portal(…)`, or a line such as `mass = 25 kg`")
}

/// `half` is q·A·L/2, `elastic` the mass from its own ends \[kg\]; None where the beam is only a part of its model.
pub fn beam_without_mass(name: &str, head: Span, half: f64, elastic: Option<f64>) -> Diagnostic {
    let kg = |mass| shown(mass, Dimension::MASS);
    let half = format!(
        "`mass = density * area * length / 2`, {}, which is for a beam on two supports",
        kg(half)
    );
    let help = match elastic {
        Some(elastic) => format!(
            "write `mass = {name}.elastic_mass`, {}, from its ends, or {half}",
            kg(elastic)
        ),
        None => format!("write the moving mass, as in `mass = 0.9 kg`, or {half}"),
    };
    Diagnostic::new(
        Code::MissingField,
        format!(
            "specimen `{name}` requires the field `mass`, which depends on the ends of its `beam`"
        ),
    )
    .at(head, "`mass` is missing")
    .help(help)
}

pub fn too_few_parts(variant: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BehaviourIncomplete,
        format!("`{variant}` requires two models or more"),
    )
    .at(span, "only one")
    .help(format!("add another model, or remove `{variant}`"))
}

pub fn too_many_parts(most: usize, what: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::UnfitInside,
        format!("a behaviour can have at most {most} {what}"),
    )
    .at(span, "too many")
    .help("combine springs into one")
}

/// `variant` is `rate` or `maxwell`.
pub fn must_be_outermost(variant: &str, span: Span) -> Diagnostic {
    let message = format!("`{variant}` acts on the load cell: it must be the outermost model");
    let help = match variant {
        "rate" => "move it outside: `rate(of: series(…), reference_velocity: …)`",
        "logarithmic" => {
            "move it outside: `logarithmic(of: series(…), share: …, reference_time: …)`"
        }
        _ => "move it outside: `maxwell(of: series(…), stiffness: …, time_constant: …)`",
    };
    Diagnostic::new(Code::UnfitInside, message)
        .at(span, "inside")
        .help(help)
}

pub fn falls_in_series(span: Span, series: Span) -> Diagnostic {
    Diagnostic::new(
        Code::UnfitInside,
        "a model that softens to a falling force is not allowed in `series`: its displacement is undetermined",
    )
    .at(span, "force may fall")
    .at(series, "in this series")
    .help("move it outside: `fracture(of: series(…), force: …)`")
}

pub fn no_such_property(
    name: Option<&Ident>,
    property: &str,
    reason: &str,
    help: &'static str,
    span: Span,
) -> Diagnostic {
    let name = name.map_or("", |name| name.node.as_str());
    Diagnostic::new(
        Code::NoSuchProperty,
        format!("specimen `{name}` has no `{property}`: {reason}"),
    )
    .at(span, "not available")
    .help(help)
}

/// Limits that let the specimen exceed its table.
pub fn table_too_short(
    file: &str,
    table: Interval,
    limit: Interval,
    named_at: Span,
    limit_at: Span,
) -> Diagnostic {
    let range = |interval: Interval| {
        format!(
            "{} .. {}",
            shown(interval.low, Dimension::LENGTH),
            shown(interval.high, Dimension::LENGTH)
        )
    };
    Diagnostic::new(
        Code::TableTooShort,
        format!("the limits exceed the points of `{file}`: the last force is used beyond them"),
    )
    .at(named_at, format!("points over {}", range(table)))
    .at(limit_at, format!("allows {}", range(limit)))
    .help("narrow the limits to the measured range, or measure further")
}

/// A contact force \[N\] that may exceed the largest force of a mechanism \[N\].
pub fn beyond_mechanism(mechanism: Mechanism, force: f64, most: f64, span: Span) -> Diagnostic {
    let [force, most] = [force, most].map(|force| shown(force, Dimension::FORCE));
    let name = mechanism.name();
    Diagnostic::new(
        Code::BeyondMechanism,
        format!("a contact force above {most} forms other hinges than the {name} mechanism"),
    )
    .at(span, format!("can reach {force}"))
    .help(
        "reduce the force to the mechanism's limit, or expect hinges nearer to the impact than the model has",
    )
}
