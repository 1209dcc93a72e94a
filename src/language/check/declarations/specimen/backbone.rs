//! Backbone curves of a restoring-force model: points, a table, the capping point, the capacities of its deterioration. In: the variant as
//! it is written. Out: parts of a [`Behaviour`] in SI.

use super::table_file;
use crate::language::check::checker::{Checker, Context};
use crate::language::check::expressions::choice::Chosen;
use crate::language::check::messages::specimens as message;
use crate::plan::{Behaviour, Capping, Deterioration, Pinching, Table, Unloading};

/// The capacities of the deterioration modes; Some(None) where none is stated.
#[expect(
    clippy::option_option,
    reason = "left out and faulty are different things here"
)]
pub fn deterioration<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
    exponent: f64,
    residual: f64,
) -> Option<Option<Deterioration>> {
    // A bilinear backbone has no cap, and its reloading branch is a separate one.
    let mut of = |name| match chosen.find(name) {
        Some(_) => checker.optional_argument(chosen, name, context),
        None => Some(None),
    };
    let stated = [
        of("energy_capacity"),
        of("capping_capacity"),
        of("unloading_capacity"),
        of("reloading_capacity"),
    ];
    let [strength, capping, unloading, reloading] = stated;
    let all = [strength?, capping?, unloading?, reloading?];
    let [strength, capping, unloading, reloading] =
        all.map(|capacity| capacity.unwrap_or(f64::INFINITY));
    let rule = Deterioration {
        strength,
        capping,
        unloading,
        reloading,
        exponent,
        residual,
    };
    Some(all.iter().any(Option::is_some).then_some(rule))
}

/// The capping point of a backbone: after yield, and only together with its other arguments.
#[expect(
    clippy::option_option,
    reason = "left out and faulty are different things here"
)]
pub fn capping<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
    pinching: &Pinching,
    residual: f64,
) -> Option<Option<Capping>> {
    let displacement = checker.optional_argument(chosen, "capping_displacement", context)?;
    let slope = checker.constant_argument(chosen, "capping_slope", context)?;
    let given = |name: &str| {
        chosen
            .find(name)
            .and_then(|(_, written)| written)
            .map(|written| written.span)
    };
    let Some(displacement) = displacement else {
        return match ["capping_slope", "capping_capacity"]
            .into_iter()
            .find_map(|name| Some((name, given(name)?)))
        {
            Some((name, span)) => {
                checker.fail(message::missing_partner(name, "capping_displacement", span))
            }
            None => Some(None),
        };
    };
    let yielded = pinching.yield_force / pinching.stiffness;
    match given("capping_displacement") {
        Some(span) if displacement <= yielded => {
            checker.fail(message::capped_before_yield(displacement, yielded, span))
        }
        _ => Some(Some(Capping {
            displacement,
            slope,
            residual,
        })),
    }
}

/// Backbone points of increasing force, each segment less stiff than the previous one: a model of elastic–plastic springs in parallel.
pub fn multilinear<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
) -> Option<Behaviour> {
    let displacements = checker.list_argument(chosen, "displacements", context);
    let forces = checker.list_argument(chosen, "forces", context);
    let (displacements, forces) = (displacements?, forces?);
    let (displacements_at, forces_at) = (chosen.span("displacements")?, chosen.span("forces")?);
    if displacements.len() != forces.len() {
        let counts = (displacements.len(), forces.len());
        return checker.fail(message::backbone_lists_differ(
            displacements_at,
            forces_at,
            counts,
        ));
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
            return checker.fail(message::backbone_point(
                index,
                displacements_at,
                "a displacement does not increase",
                help,
            ));
        }
        if gained < 0.0 || (index == 0 && gained == 0.0) {
            let help = "write forces that increase from 0, or use `table` for a curve that falls";
            return checker.fail(message::backbone_point(
                index,
                forces_at,
                "a force does not increase",
                help,
            ));
        }
        // Equal slopes may differ in their last digits.
        if gained > softest * moved * (1.0 + 1e-9) {
            let help =
                "write segments of decreasing stiffness, or use `table` for a curve that stiffens";
            return checker.fail(message::backbone_point(
                index,
                forces_at,
                "its segment is stiffer than the one before",
                help,
            ));
        }
        (before, softest) = (*corner, gained / moved);
    }
    Some(Behaviour::Multilinear { corners })
}

pub fn table<'a>(checker: &mut Checker<'a>, chosen: &Chosen<'a>) -> Option<Behaviour> {
    let named = checker.text_argument(chosen, "file").flatten();
    let unloading = match chosen.span("unloading") {
        Some(_) => checker
            .chosen_argument(chosen, "unloading")
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
        Err(bad) => checker.fail(message::table_file(
            &file.name,
            bad.row.as_ref(),
            &bad.reason,
            named_at,
            bad.help,
        )),
    }
}
