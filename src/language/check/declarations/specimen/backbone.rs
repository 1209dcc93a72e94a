//! Backbone curves of a restoring-force model: points, a table, the capping point. In: the variant as it is written. Out: a
//! [`Behaviour`] in SI, or an error.

use crate::check::checker::{Checker, Context};
use crate::check::expressions::choice::Chosen;
use crate::check::violations::MissingPartner;
use crate::check::wording::shown;
use crate::codes::{E630, E631};
use psd_plan::schema::behaviours::{
    CAPPING_CAPACITY, CAPPING_DISPLACEMENT, CAPPING_SLOPE, argument,
};
use psd_plan::{Behaviour, Pinching, Table, Unloading};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::Dimension;

use super::table_file;

/// A backbone that descends before it yields.
struct CappedBeforeYield {
    displacement: f64,
    yielded: f64,
    span: Span,
}

impl Violation for CappedBeforeYield {
    const CODE: Code = E630;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            displacement,
            yielded,
            span,
        } = self;
        let [displacement, yielded] =
            [displacement, yielded].map(|value| shown(value, Dimension::LENGTH));
        Diagnostic::new(
            Self::CODE,
            format!("capping at {displacement} is before yield"),
        )
        .at(span, format!("yields at {yielded}"))
        .help(format!("write a `capping_displacement` above {yielded}"))
    }
}

/// The capping point of a backbone: after yield, and only together with its other arguments.
pub fn check_capping<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    pinching: &Pinching,
) -> Option<()> {
    let given = |name: &str| {
        chosen
            .find(name)
            .and_then(|(_, written)| written)
            .map(|written| written.span)
    };
    let Some(capping) = pinching.capping else {
        let alone = [CAPPING_SLOPE.name, CAPPING_CAPACITY.name]
            .into_iter()
            .find_map(|name| Some((name, given(name)?)));
        let Some((name, span)) = alone else {
            return Some(());
        };
        return checker.fail(MissingPartner {
            given: name,
            missing: CAPPING_DISPLACEMENT.name,
            span,
        });
    };
    let yielded = pinching.yield_force / pinching.stiffness;
    match given(CAPPING_DISPLACEMENT.name) {
        Some(span) if capping.displacement <= yielded => checker.fail(CappedBeforeYield {
            displacement: capping.displacement,
            yielded,
            span,
        }),
        _ => Some(()),
    }
}

#[derive(Violation)]
#[violation(E630, "number of displacements and forces differs")]
#[help("write both lists with the same length")]
struct BackboneListsDiffer {
    #[label("{} displacements", counts.0)]
    displacements: Span,
    #[label("{} forces", counts.1)]
    forces: Span,
    counts: (usize, usize),
}

/// `index` counts from 0.
#[derive(Violation)]
#[violation(E630, "backbone point {} is invalid", index + 1)]
#[help("{}", help)]
struct BadBackbonePoint<'a> {
    index: usize,
    #[label("{}", label)]
    span: Span,
    label: &'a str,
    help: &'a str,
}

/// Backbone points of increasing force, each segment less stiff than the previous one: a model of elastic–plastic springs in parallel.
pub fn multilinear<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
) -> Option<Behaviour> {
    let displacements = checker.list_argument(chosen, argument::DISPLACEMENTS, context);
    let forces = checker.list_argument(chosen, argument::FORCES, context);
    let (displacements, forces) = (displacements?, forces?);
    let (displacements_at, forces_at) = (
        chosen.span(argument::DISPLACEMENTS)?,
        chosen.span(argument::FORCES)?,
    );
    if displacements.len() != forces.len() {
        let counts = (displacements.len(), forces.len());
        return checker.fail(BackboneListsDiffer {
            displacements: displacements_at,
            forces: forces_at,
            counts,
        });
    }
    let corners: Vec<[f64; 2]> = displacements
        .into_iter()
        .zip(forces)
        .map(|(displacement, force)| [displacement, force])
        .collect();
    let (mut before, mut softest) = ([0.0, 0.0], f64::INFINITY);
    for (index, corner) in corners.iter().enumerate() {
        let [moved, gained] = [corner[0] - before[0], corner[1] - before[1]];
        if moved <= 0.0 {
            let help = "write displacements that increase from 0; the curve is symmetric";
            return checker.fail(BadBackbonePoint {
                index,
                span: displacements_at,
                label: "a displacement does not increase",
                help,
            });
        }
        if gained < 0.0 || (index == 0 && gained == 0.0) {
            let help = "write forces that increase from 0, or use `table` for a curve that falls";
            return checker.fail(BadBackbonePoint {
                index,
                span: forces_at,
                label: "a force does not increase",
                help,
            });
        }
        // Equal slopes may differ in their last digits.
        if gained > softest * moved * (1.0 + 1e-9) {
            let help =
                "write segments of decreasing stiffness, or use `table` for a curve that stiffens";
            return checker.fail(BadBackbonePoint {
                index,
                span: forces_at,
                label: "its segment is stiffer than the one before",
                help,
            });
        }
        (before, softest) = (*corner, gained / moved);
    }
    Some(Behaviour::Multilinear { corners })
}

/// A row of a table, its line number from 1 and its text; without a row the error concerns the whole file.
#[derive(Violation)]
#[violation(E631, "`{file}`{line_text}: {reason}", line_text = row.map_or_else(String::new, |(line, text)| {
        format!(", line {line}, `{text}`")
    }))]
#[help("{}", help)]
struct BadTableFile<'a> {
    file: &'a str,
    row: Option<&'a (usize, String)>,
    reason: &'a str,
    #[label("the table")]
    named_at: Span,
    help: &'a str,
}

pub fn table<'a>(checker: &mut Checker<'a>, chosen: &Chosen<'a>) -> Option<Behaviour> {
    let named = checker.text_argument(chosen, argument::FILE).flatten();
    let unloading = match chosen.span(argument::UNLOADING) {
        Some(_) => checker
            .chosen_argument(chosen, argument::UNLOADING)
            .map(|chosen| chosen.variant.name),
        None => Some("initial_stiffness"),
    };
    let (name, named_at) = named?;
    let file = checker.data_file(&name, named_at)?;
    match table_file::points(&file.text) {
        Ok(points) => {
            let unloading = if unloading? == "along_curve" {
                Unloading::AlongTheCurve
            } else {
                Unloading::InitialStiffness
            };
            Some(Behaviour::Table(Table {
                file: file.name,
                points,
                unloading,
                scale: 1.0,
            }))
        }
        Err(bad) => checker.fail(BadTableFile {
            file: &file.name,
            row: bad.row.as_ref(),
            reason: &bad.reason,
            named_at,
            help: bad.help,
        }),
    }
}
