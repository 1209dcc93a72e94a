//! `behaviour = series(…)`: the restoring-force model of a specimen. In: its expression. Out: a [`Behaviour`] in SI.

use super::backbone::{check_capping, multilinear, table};
use super::{beam, portal};
use crate::check::checker::{Checker, Context};
use crate::check::expressions::choice::Chosen;
use crate::check::messages::{shown, specimens as message, values};
use crate::syntax::ast::{Expr, ExprKind};
use psd_physics::relaxation::logarithmic::LogarithmicRelaxation;
use psd_plan::schema::behaviours::{STIFFNESS, argument};
use psd_plan::schema::{Presence, Variant};
use psd_plan::{Behaviour, Breaks};
use psd_text::source::Span;
use psd_text::units::Dimension;

/// Most springs of one model.
pub const MOST_PARTS: usize = 16;
/// Most springs in series: each additional one multiplies the cost of a move by about ten.
pub const MOST_IN_SERIES: usize = 4;

/// Duration of a relaxation if the plan does not specify it, in reference times.
const LONGEST_OF_REFERENCE: f64 = 1e6;
/// Shortest duration of a relaxation, in reference times: for a shorter one the logarithm has no effect.
const LEAST_OF_REFERENCE: f64 = 10.0;

/// A model as written, with the variants that are allowed there.
pub struct Written<'a> {
    pub field: &'static str,
    pub variants: &'static [Variant],
    pub expr: &'a Expr,
    pub context: Context,
    pub material: Material,
}

/// Material data of the specimen.
#[derive(Clone, Copy, Default)]
pub struct Material {
    /// q·A \[kg/m\], if both are stated.
    pub mass_per_length: Option<f64>,
    /// q·A·L \[kg\], if all three are stated.
    pub own_mass: Option<f64>,
}

/// The complete model, within its size limit.
pub fn behaviour<'a>(checker: &mut Checker<'a>, written: &Written<'a>) -> Option<Behaviour> {
    let found = part(checker, written, written.expr, Position::Outermost)?;
    if count(&found) > MOST_PARTS {
        return checker.fail(message::too_many_parts(
            MOST_PARTS,
            "springs",
            written.expr.span,
        ));
    }
    if in_series(&found) > MOST_IN_SERIES {
        return checker.fail(message::too_many_parts(
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

/// Nested solutions of the model, itself included.
fn in_series(behaviour: &Behaviour) -> usize {
    let parts = behaviour.parts().iter().map(in_series);
    if matches!(behaviour, Behaviour::Series(_)) {
        parts.sum()
    } else {
        parts.max().unwrap_or(1)
    }
}

/// Position of a model in a composition: rate- and time-dependent models must be the outermost ones.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Position {
    Outermost,
    BesideBranch,
    Inside,
}

fn part<'a>(
    checker: &mut Checker<'a>,
    written: &Written<'a>,
    expr: &'a Expr,
    position: Position,
) -> Option<Behaviour> {
    let context = written.context;
    let chosen = checker.chosen(written.field, written.variants, expr)?;
    let mut number = |name: &str| checker.constant_argument(&chosen, name, context);
    match chosen.variant.name {
        "rate" => {
            let (reference_velocity, exponent) = (
                number(argument::REFERENCE_VELOCITY),
                number(argument::EXPONENT),
            );
            if position != Position::Outermost {
                return checker.fail(message::must_be_outermost("rate", expr.span));
            }
            let of = Box::new(inner(checker, written, &chosen)?);
            Some(Behaviour::Rate {
                of,
                reference_velocity: reference_velocity?,
                exponent: exponent?,
            })
        }
        "maxwell" => {
            let (stiffness, time_constant) =
                (number(STIFFNESS.name), number(argument::TIME_CONSTANT));
            if position == Position::Inside {
                return checker.fail(message::must_be_outermost("maxwell", expr.span));
            }
            let (_, beside) = chosen.find(argument::OF)?;
            let of = Box::new(part(checker, written, beside?, Position::BesideBranch)?);
            Some(Behaviour::Maxwell {
                of,
                stiffness: stiffness?,
                time_constant: time_constant?,
            })
        }
        "logarithmic" => logarithmic(checker, written, &chosen, expr.span, position),
        "multilinear" => multilinear(checker, &chosen, context),
        "table" => table(checker, &chosen),
        "fracture" => fracture(checker, written, &chosen, expr.span),
        "series" => series(checker, written, &chosen, expr.span),
        "parallel" => parts(checker, written, &chosen, expr.span)
            .map(|parts| Behaviour::Parallel(parts.into_iter().map(|(part, _)| part).collect())),
        "portal" => portal::portal(
            checker,
            &chosen,
            context,
            expr.span,
            written.material.mass_per_length,
        ),
        "beam" => beam::beam(checker, &chosen, context, written.material.own_mass),
        word => {
            let numbers = numbers(checker, &chosen, context)?;
            let found = Behaviour::of_numbers(word, |name| {
                let number = numbers.iter().find(|(field, _)| *field == name);
                number.and_then(|(_, number)| *number)
            })?;
            if let Behaviour::Pinching(pinching) = &found {
                check_capping(checker, &chosen, pinching)?;
            }
            Some(found)
        }
    }
}

/// The numbers of a model that has no other parameters; None of those that are left out and have no default.
fn numbers<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
) -> Option<Vec<(&'static str, Option<f64>)>> {
    let fields = chosen.variant.arguments.iter();
    let read: Vec<_> = fields
        .map(|field| {
            let number = match field.presence {
                Presence::Optional | Presence::DefaultInWords(_) => {
                    checker.optional_argument(chosen, field.name, context)
                }
                _ => checker
                    .constant_argument(chosen, field.name, context)
                    .map(Some),
            };
            Some((field.name, number?))
        })
        .collect();
    read.into_iter().collect()
}

/// The instantaneous force relaxes with the logarithm of time, at most to zero.
fn logarithmic<'a>(
    checker: &mut Checker<'a>,
    written: &Written<'a>,
    chosen: &Chosen<'a>,
    span: Span,
    position: Position,
) -> Option<Behaviour> {
    let (share, time) = (
        checker.constant_argument(chosen, argument::SHARE, written.context),
        checker.constant_argument(chosen, argument::REFERENCE_TIME, written.context),
    );
    let longest = checker.optional_argument(chosen, argument::LONGEST, written.context)?;
    if position == Position::Inside {
        return checker.fail(message::must_be_outermost("logarithmic", span));
    }
    let of = Box::new(inner(checker, written, chosen)?);
    let (share, reference_time) = (share?, time?);
    let longest = longest.unwrap_or(LONGEST_OF_REFERENCE * reference_time);
    if longest < LEAST_OF_REFERENCE * reference_time {
        return checker.fail(message::relaxes_too_short(longest, reference_time, span));
    }
    let law = LogarithmicRelaxation {
        share,
        reference_time,
        longest,
    };
    let lost = law.lost_after_long();
    if lost >= 1.0 {
        return checker.fail(message::relaxes_away(
            message::RelaxationLoss {
                share,
                lost,
                longest,
            },
            span,
        ));
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
    let (_, expr) = chosen.find(argument::OF)?;
    part(checker, written, expr?, Position::Inside)
}

/// The models that a variant combines, with the position of each.
fn parts<'a>(
    checker: &mut Checker<'a>,
    written: &Written<'a>,
    chosen: &Chosen<'a>,
    span: Span,
) -> Option<Vec<(Behaviour, Span)>> {
    let exprs = chosen.several(argument::OF);
    if exprs.len() < 2 {
        return checker.fail(message::too_few_parts(chosen.variant.name, span));
    }
    // The size of a list is checked before its entries, so that its length is bounded.
    if exprs.len() > MOST_PARTS {
        return checker.fail(message::too_many_parts(MOST_PARTS, "springs", span));
    }
    let found: Vec<_> = exprs
        .into_iter()
        .map(|expr| Some((part(checker, written, expr, Position::Inside)?, expr.span)))
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
        return checker.fail(message::falls_in_series(*falls, span));
    }
    Some(Behaviour::Series(
        found.into_iter().map(|(part, _)| part).collect(),
    ))
}

fn fracture<'a>(
    checker: &mut Checker<'a>,
    written: &Written<'a>,
    chosen: &Chosen<'a>,
    span: Span,
) -> Option<Behaviour> {
    let of = inner(checker, written, chosen);
    let displacement = checker.optional_argument(chosen, argument::DISPLACEMENT, written.context);
    let force = checker.optional_argument(chosen, argument::FORCE, written.context);
    let at = match (displacement?, force?) {
        (Some(displacement), None) => Breaks::Displacement(displacement),
        (None, Some(force)) => Breaks::Force(force),
        (displacement, _) => {
            let given = if displacement.is_some() { 2 } else { 0 };
            let takes = "a `fracture` requires a `displacement` or a `force`";
            return checker.fail(message::one_form_only(takes, "force: 5 kN", span, given));
        }
    };
    let of = of?;
    if let (Breaks::Force(force), Some(span)) = (at, chosen.span(argument::FORCE))
        && force > of.capacity()
    {
        let (force, most) = (
            shown(force, Dimension::FORCE),
            shown(of.capacity(), Dimension::FORCE),
        );
        let message =
            format!("fracture at {force} is never reached: the force of `of` is at most {most}");
        checker.diagnostics.push(values::no_effect(
            message,
            span,
            "never reached",
            "write a `displacement`, or a lower force",
        ));
    }
    Some(Behaviour::Fracture {
        of: Box::new(of),
        at,
    })
}

/// Whether a model contains this variant.
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

/// The tables that a model names, with the span of each name.
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
