//! `behaviour = series(…)`: what a virtual specimen is. In: the expression of a behaviour. Out: a [`Behaviour`] in SI.

use super::{portal, table_file};
use crate::language::check::checker::{Checker, Place};
use crate::language::check::expressions::choice::Chosen;
use crate::language::check::messages::{shown, specimens as fault, values};
use crate::language::syntax::ast::{Expr, ExprKind};
use crate::physics::relaxation::logarithmic::lost_after_long;
use crate::physics::structure::beam;
use crate::plan::{
    Beam, Behaviour, Bolted, Breaks, Capping, Deterioration, Ends, Pinching, Table, Unloading,
};
use crate::schema::Variant;
use crate::text::source::Span;
use crate::units::Dimension;

/// Springs of one behaviour, at most.
pub const MOST_PARTS: usize = 16;
/// Springs one behind the other, at most: each one more makes every move some ten times dearer.
pub const MOST_IN_SERIES: usize = 4;

/// How long a force relaxes where the plan does not say, in reference times.
const LONGEST_OF_REFERENCE: f64 = 1e6;
/// And how long at least: shorter, the logarithm has no room.
const LEAST_OF_REFERENCE: f64 = 10.0;

/// A behaviour as it was written, with the variants it may be one of.
pub struct Written<'a> {
    pub field: &'static str,
    pub variants: &'static [Variant],
    pub expr: &'a Expr,
    pub place: Place,
    pub material: Material,
}

/// What a specimen says of its material.
#[derive(Clone, Copy, Default)]
pub struct Material {
    /// q·A, kg/m, where it states both.
    pub mass_per_length: Option<f64>,
    /// q·A·L, kg, where it states all three.
    pub own_mass: Option<f64>,
}

/// The behaviour, whole and not too large.
pub fn behaviour<'a>(checker: &mut Checker<'a>, written: &Written<'a>) -> Option<Behaviour> {
    let found = part(checker, written, written.expr, Stands::Outermost)?;
    if count(&found) > MOST_PARTS {
        return checker.fail(fault::too_many_parts(
            MOST_PARTS,
            "springs",
            written.expr.span,
        ));
    }
    if in_series(&found) > MOST_IN_SERIES {
        return checker.fail(fault::too_many_parts(
            MOST_IN_SERIES,
            "springs in series",
            written.expr.span,
        ));
    }
    Some(found)
}

fn count(behaviour: &Behaviour) -> usize {
    behaviour.parts().iter().map(count).sum::<usize>().max(1)
}

/// Solves inside each other, and one.
fn in_series(behaviour: &Behaviour) -> usize {
    let parts = behaviour.parts().iter().map(in_series);
    if matches!(behaviour, Behaviour::Series(_)) {
        parts.sum()
    } else {
        parts.max().unwrap_or(1)
    }
}

/// Where a behaviour stands: what the load cell feels of a speed or in time cannot stand inside another.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stands {
    Outermost,
    BesideBranch,
    Inside,
}

fn part<'a>(
    checker: &mut Checker<'a>,
    written: &Written<'a>,
    expr: &'a Expr,
    stands: Stands,
) -> Option<Behaviour> {
    let place = written.place;
    let chosen = checker.chosen(written.field, written.variants, expr)?;
    let mut number = |name: &str| checker.constant_argument(&chosen, name, place);
    match chosen.variant.name {
        "elastic" => Some(Behaviour::Elastic {
            stiffness: number("stiffness")?,
        }),
        "bilinear" => {
            let (stiffness, yield_force, hardening) = (
                number("stiffness"),
                number("yield_force"),
                number("hardening"),
            );
            let (exponent, residual) = (
                number("deterioration_exponent"),
                number("residual_strength"),
            );
            let (stiffness, yield_force, hardening) = (stiffness?, yield_force?, hardening?);
            Some(
                match deterioration(checker, &chosen, place, (exponent?, residual?))? {
                    None => Behaviour::Bilinear {
                        stiffness,
                        yield_force,
                        hardening,
                    },
                    Some(deterioration) => Behaviour::WearingBilinear {
                        stiffness,
                        yield_force,
                        hardening,
                        deterioration,
                    },
                },
            )
        }
        "bouc_wen" => {
            let (stiffness, yield_force, hardening) = (
                number("stiffness"),
                number("yield_force"),
                number("hardening"),
            );
            let (sharpness, beta) = (number("n"), number("beta"));
            let (stiffness, yield_force, hardening) = (stiffness?, yield_force?, hardening?);
            Some(Behaviour::BoucWen {
                stiffness,
                yield_force,
                hardening,
                sharpness: sharpness?,
                beta: beta?,
            })
        }
        "pinching" => {
            let (stiffness, yield_force, hardening) = (
                number("stiffness"),
                number("yield_force"),
                number("hardening"),
            );
            let (force, displacement) = (number("force_factor"), number("displacement_factor"));
            let exponent = number("unloading_exponent");
            let (rate, residual) = (
                number("deterioration_exponent"),
                number("residual_strength"),
            );
            let (rate, residual) = (rate?, residual?);
            let pinching = Pinching {
                stiffness: stiffness?,
                yield_force: yield_force?,
                hardening: hardening?,
                force_factor: force?,
                displacement_factor: displacement?,
                unloading_exponent: exponent?,
                capping: None,
                deterioration: None,
            };
            let deterioration = deterioration(checker, &chosen, place, (rate, residual))?;
            let capping = capping(checker, &chosen, place, &pinching, residual)?;
            Some(Behaviour::Pinching(Pinching {
                capping,
                deterioration,
                ..pinching
            }))
        }
        "degrading" => {
            let (stiffness, half, residual) = (
                number("stiffness"),
                number("half_displacement"),
                number("residual"),
            );
            Some(Behaviour::Degrading {
                stiffness: stiffness?,
                half_displacement: half?,
                residual: residual?,
            })
        }
        "bolted" => {
            let (stiffness, bearing_force) = (number("stiffness"), number("bearing_force"));
            let (clearance, slip_force) = (number("clearance"), number("slip_force"));
            let (stiffness, bearing_force) = (stiffness?, bearing_force?);
            Some(Behaviour::Bolted(Bolted {
                stiffness,
                bearing_force,
                clearance: clearance?,
                slip_force: slip_force?,
            }))
        }
        "rate" => {
            let (reference_velocity, exponent) = (number("reference_velocity"), number("exponent"));
            if stands != Stands::Outermost {
                return checker.fail(fault::felt_inside("rate", expr.span));
            }
            let of = Box::new(inner(checker, written, &chosen)?);
            Some(Behaviour::Rate {
                of,
                reference_velocity: reference_velocity?,
                exponent: exponent?,
            })
        }
        "maxwell" => {
            let (stiffness, time_constant) = (number("stiffness"), number("time_constant"));
            if stands == Stands::Inside {
                return checker.fail(fault::felt_inside("maxwell", expr.span));
            }
            let (_, beside) = chosen.find("of")?;
            let of = Box::new(part(checker, written, beside?, Stands::BesideBranch)?);
            Some(Behaviour::Maxwell {
                of,
                stiffness: stiffness?,
                time_constant: time_constant?,
            })
        }
        "logarithmic" => logarithmic(checker, written, &chosen, expr.span, stands),
        "multilinear" => multilinear(checker, &chosen, place),
        "table" => table(checker, &chosen),
        "fracture" => fracture(checker, written, &chosen, expr.span),
        "series" => series(checker, written, &chosen, expr.span),
        "parallel" => parts(checker, written, &chosen, expr.span)
            .map(|parts| Behaviour::Parallel(parts.into_iter().map(|(part, _)| part).collect())),
        "portal" => portal::portal(
            checker,
            &chosen,
            place,
            expr.span,
            written.material.mass_per_length,
        ),
        _ => beam(checker, &chosen, place, written.material.own_mass),
    }
}

/// The capacities of the modes of deterioration; Some(None) where none is stated.
#[expect(
    clippy::option_option,
    reason = "left out and faulty are different things here"
)]
fn deterioration<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    place: Place,
    (exponent, residual): (f64, f64),
) -> Option<Option<Deterioration>> {
    // Two slopes alone are not capped, and reload along their own.
    let mut of = |name| match chosen.find(name) {
        Some(_) => checker.optional_argument(chosen, name, place),
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

/// Where a backbone begins to fall: past yield, and its partners only with it.
#[expect(
    clippy::option_option,
    reason = "left out and faulty are different things here"
)]
fn capping<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    place: Place,
    pinching: &Pinching,
    residual: f64,
) -> Option<Option<Capping>> {
    let displacement = checker.optional_argument(chosen, "capping_displacement", place)?;
    let slope = checker.constant_argument(chosen, "capping_slope", place)?;
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
                checker.fail(fault::missing_partner(name, "capping_displacement", span))
            }
            None => Some(None),
        };
    };
    let yielded = pinching.yield_force / pinching.stiffness;
    match given("capping_displacement") {
        Some(span) if displacement <= yielded => {
            checker.fail(fault::capped_before_yield(displacement, yielded, span))
        }
        _ => Some(Some(Capping {
            displacement,
            slope,
            residual,
        })),
    }
}

/// What is reached relaxes with the logarithm of time: not more of it than there is.
fn logarithmic<'a>(
    checker: &mut Checker<'a>,
    written: &Written<'a>,
    chosen: &Chosen<'a>,
    span: Span,
    stands: Stands,
) -> Option<Behaviour> {
    let (share, time) = (
        checker.constant_argument(chosen, "share", written.place),
        checker.constant_argument(chosen, "reference_time", written.place),
    );
    let longest = checker.optional_argument(chosen, "longest", written.place)?;
    if stands == Stands::Inside {
        return checker.fail(fault::felt_inside("logarithmic", span));
    }
    let of = Box::new(inner(checker, written, chosen)?);
    let (share, reference_time) = (share?, time?);
    let longest = longest.unwrap_or(LONGEST_OF_REFERENCE * reference_time);
    if longest < LEAST_OF_REFERENCE * reference_time {
        return checker.fail(fault::relaxes_too_short(longest, reference_time, span));
    }
    let lost = lost_after_long(share, reference_time, longest);
    if lost >= 1.0 {
        return checker.fail(fault::relaxes_away(share, lost, longest, span));
    }
    Some(Behaviour::Logarithmic {
        of,
        share,
        reference_time,
        longest,
    })
}

fn inner<'a>(
    checker: &mut Checker<'a>,
    written: &Written<'a>,
    chosen: &Chosen<'a>,
) -> Option<Behaviour> {
    let (_, expr) = chosen.find("of")?;
    part(checker, written, expr?, Stands::Inside)
}

/// The behaviours that a variant joins, and where each stands.
fn parts<'a>(
    checker: &mut Checker<'a>,
    written: &Written<'a>,
    chosen: &Chosen<'a>,
    span: Span,
) -> Option<Vec<(Behaviour, Span)>> {
    let exprs = chosen.several("of");
    if exprs.len() < 2 {
        return checker.fail(fault::too_few_parts(chosen.variant.name, span));
    }
    // A list of any length would be looked at one by one before its size is.
    if exprs.len() > MOST_PARTS {
        return checker.fail(fault::too_many_parts(MOST_PARTS, "springs", span));
    }
    let found: Vec<_> = exprs
        .into_iter()
        .map(|expr| Some((part(checker, written, expr, Stands::Inside)?, expr.span)))
        .collect();
    found.into_iter().collect()
}

fn series<'a>(
    checker: &mut Checker<'a>,
    written: &Written<'a>,
    chosen: &Chosen<'a>,
    span: Span,
) -> Option<Behaviour> {
    let found = parts(checker, written, chosen, span)?;
    if let Some((_, falls)) = found.iter().find(|(part, _)| !part.never_falls()) {
        return checker.fail(fault::falls_in_series(*falls, span));
    }
    Some(Behaviour::Series(
        found.into_iter().map(|(part, _)| part).collect(),
    ))
}

/// Corners that rise, each stretch softer than the one before: what elastic–plastic springs side by side can be.
fn multilinear<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    place: Place,
) -> Option<Behaviour> {
    let displacements = checker.list_argument(chosen, "displacements", place);
    let forces = checker.list_argument(chosen, "forces", place);
    let (displacements, forces) = (displacements?, forces?);
    let (displacements_at, forces_at) = (chosen.span("displacements")?, chosen.span("forces")?);
    if displacements.len() != forces.len() {
        let counts = (displacements.len(), forces.len());
        return checker.fail(fault::corners_of_two_lengths(
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
            let help = "displacements rise from 0: the same holds backwards";
            return checker.fail(fault::corner(
                index,
                displacements_at,
                "a displacement does not rise",
                help,
            ));
        }
        if gained < 0.0 || (index == 0 && gained == 0.0) {
            let help = "forces rise from 0; write `table` for a curve that falls";
            return checker.fail(fault::corner(
                index,
                forces_at,
                "a force does not rise",
                help,
            ));
        }
        // Equal slopes may differ in their last bits.
        if gained > softest * moved * (1.0 + 1e-9) {
            let help = "each stretch is softer than the one before; write `table` for a curve that stiffens";
            return checker.fail(fault::corner(
                index,
                forces_at,
                "the stretch to it is stiffer",
                help,
            ));
        }
        (before, softest) = (*corner, gained / moved);
    }
    Some(Behaviour::Multilinear { corners })
}

fn table<'a>(checker: &mut Checker<'a>, chosen: &Chosen<'a>) -> Option<Behaviour> {
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
        Err(bad) => checker.fail(fault::table_file(
            &file.name,
            bad.row.as_ref(),
            &bad.reason,
            named_at,
            bad.help,
        )),
    }
}

fn fracture<'a>(
    checker: &mut Checker<'a>,
    written: &Written<'a>,
    chosen: &Chosen<'a>,
    span: Span,
) -> Option<Behaviour> {
    let of = inner(checker, written, chosen);
    let displacement = checker.optional_argument(chosen, "displacement", written.place);
    let force = checker.optional_argument(chosen, "force", written.place);
    let at = match (displacement?, force?) {
        (Some(displacement), None) => Breaks::Displacement(displacement),
        (None, Some(force)) => Breaks::Force(force),
        (displacement, _) => {
            let given = if displacement.is_some() { 2 } else { 0 };
            let takes = "a `fracture` comes at a `displacement` or at a `force`";
            return checker.fail(fault::one_way_only(takes, "force: 5 kN", span, given));
        }
    };
    let of = of?;
    if let (Breaks::Force(force), Some(span)) = (at, chosen.span("force"))
        && force > of.capacity()
    {
        let (force, most) = (
            shown(force, Dimension::FORCE),
            shown(of.capacity(), Dimension::FORCE),
        );
        let message = format!(
            "the fracture at {force} never comes: what is to break carries no more than {most}"
        );
        checker.faults.push(values::no_effect(
            message,
            span,
            "is never reached",
            "let it break at a `displacement`, or at less",
        ));
    }
    Some(Behaviour::Fracture {
        of: Box::new(of),
        at,
    })
}

/// Midspan or tip stiffness of a beam; the formulas stand in `physics/structure/beam.rs`.
fn beam<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    place: Place,
    own_mass: Option<f64>,
) -> Option<Behaviour> {
    let length = checker.constant_argument(chosen, "length", place);
    let youngs_modulus = checker.constant_argument(chosen, "youngs_modulus", place);
    let second_moment = checker.constant_argument(chosen, "second_moment", place);
    let modulus = checker.optional_argument(chosen, "shear_modulus", place);
    let area = checker.optional_argument(chosen, "shear_area", place);
    let ends = checker.chosen_argument(chosen, "ends")?;
    let rotational_stiffness = match ends.variant.name {
        "partly_built_in" => {
            Some(checker.constant_argument(&ends, "rotational_stiffness", place)?)
        }
        _ => None,
    };
    let fixity = match ends.variant.name {
        "fixity" => Some(checker.constant_argument(&ends, "factor", place)?),
        _ => None,
    };
    let (length, youngs_modulus, second_moment) = (length?, youngs_modulus?, second_moment?);
    let shear = match (modulus?, area?) {
        (Some(modulus), Some(area)) => Some(modulus * area),
        (None, None) => None,
        (Some(_), None) => {
            return checker.fail(fault::missing_partner(
                "shear_modulus",
                "shear_area",
                chosen.span("shear_modulus")?,
            ));
        }
        (None, Some(_)) => {
            return checker.fail(fault::missing_partner(
                "shear_area",
                "shear_modulus",
                chosen.span("shear_area")?,
            ));
        }
    };
    let ends = match (ends.variant.name, rotational_stiffness, fixity) {
        (_, Some(rotational_stiffness), _) => Ends::PartlyBuiltIn {
            rotational_stiffness,
        },
        (_, _, Some(factor)) => {
            beam::ends_of_fixity(factor, length, youngs_modulus * second_moment)
        }
        ("cantilever", ..) => Ends::Cantilever,
        ("simply_supported", ..) => Ends::SimplySupported,
        _ => Ends::BuiltIn,
    };
    let stiffness = beam::stiffness(length, youngs_modulus, second_moment, ends, shear);
    Some(Behaviour::Beam(Beam {
        stiffness,
        length,
        youngs_modulus,
        second_moment,
        ends,
        shear,
        own_mass,
    }))
}

/// Whether a behaviour is written with this variant somewhere.
pub fn names(expr: &Expr, variant: &str) -> bool {
    match &expr.kind {
        ExprKind::Parenthesised(inner) => names(inner, variant),
        ExprKind::List { items, .. } => items.iter().any(|item| names(item, variant)),
        ExprKind::Call {
            name, arguments, ..
        } => {
            name.node == variant
                || arguments
                    .iter()
                    .any(|argument| names(&argument.value, variant))
        }
        _ => false,
    }
}

/// The tables that a behaviour was written with, and where each is named.
pub fn tables_named(expr: &Expr, found: &mut Vec<Span>) {
    match &expr.kind {
        ExprKind::Text(_) => found.push(expr.span),
        ExprKind::Parenthesised(inner) => tables_named(inner, found),
        ExprKind::List { items, .. } => items.iter().for_each(|item| tables_named(item, found)),
        ExprKind::Call { arguments, .. } => arguments
            .iter()
            .for_each(|argument| tables_named(&argument.value, found)),
        _ => {}
    }
}
