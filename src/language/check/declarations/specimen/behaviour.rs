//! `behaviour = series(…)`: the restoring-force model of a specimen. In: its expression. Out: a [`Behaviour`] in SI.

use crate::check::checker::{Checker, Context};
use crate::check::expressions::choice::Chosen;
use crate::check::violations::{NoEffect, OneFormOnly};
use crate::check::wording::shown;
use crate::codes::{E401, E632, E633};
use crate::syntax::ast::{Expr, ExprKind};
use psd_physics::relaxation::logarithmic::LogarithmicRelaxation;
use psd_plan::schema::behaviours::{STIFFNESS, argument};
use psd_plan::schema::{Presence, Variant};
use psd_plan::{Behaviour, Breaks};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::Dimension;

use super::backbone::{check_capping, multilinear, table};
use super::{beam, portal};

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

#[derive(Violation)]
#[violation(E633, "a behaviour can have at most {most} {what}")]
#[help("combine springs into one")]
struct TooManyParts<'a> {
    most: usize,
    what: &'a str,
    #[label("too many")]
    span: Span,
}

/// The complete model, within its size limit.
pub fn behaviour<'a>(checker: &mut Checker<'a>, written: &Written<'a>) -> Option<Behaviour> {
    let found = part(checker, written, written.expr, Position::Outermost)?;
    if count(&found) > MOST_PARTS {
        return checker.fail(TooManyParts {
            most: MOST_PARTS,
            what: "springs",
            span: written.expr.span,
        });
    }
    if in_series(&found) > MOST_IN_SERIES {
        return checker.fail(TooManyParts {
            most: MOST_IN_SERIES,
            what: "springs in series",
            span: written.expr.span,
        });
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

/// `variant` is `rate` or `maxwell`.
struct MustBeOutermost<'a> {
    variant: &'a str,
    span: Span,
}

impl Violation for MustBeOutermost<'_> {
    const CODE: Code = E633;

    fn diagnostic(self) -> Diagnostic {
        let Self { variant, span } = self;
        let message = format!("`{variant}` acts on the load cell: it must be the outermost model");
        let help = match variant {
            "rate" => "move it outside: `rate(of: series(…), reference_velocity: …)`",
            "logarithmic" => {
                "move it outside: `logarithmic(of: series(…), share: …, reference_time: …)`"
            }
            _ => "move it outside: `maxwell(of: series(…), stiffness: …, time_constant: …)`",
        };
        Diagnostic::new(Self::CODE, message)
            .at(span, "inside")
            .help(help)
    }
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
                return checker.fail(MustBeOutermost {
                    variant: "rate",
                    span: expr.span,
                });
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
                return checker.fail(MustBeOutermost {
                    variant: "maxwell",
                    span: expr.span,
                });
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

/// The law ends before it begins.
struct RelaxesTooShort {
    longest: f64,
    reference_time: f64,
    span: Span,
}

impl Violation for RelaxesTooShort {
    const CODE: Code = E401;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            longest,
            reference_time,
            span,
        } = self;
        let times = [longest, reference_time].map(|time| shown(time, Dimension::TIME));
        Diagnostic::new(
            Self::CODE,
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
}

/// The loss of force of a logarithmic relaxation.
#[derive(Clone, Copy)]
struct RelaxationLoss {
    /// a of a·ln(1 + t/t₀): fraction of the force that is lost each time 1 + t/t₀ grows e-fold.
    share: f64,
    /// Fraction of the force that is lost at the end.
    lost: f64,
    /// Duration of the relaxation \[s\].
    longest: f64,
}

struct RelaxesAway {
    loss: RelaxationLoss,
    span: Span,
}

impl Violation for RelaxesAway {
    const CODE: Code = E401;

    fn diagnostic(self) -> Diagnostic {
        let Self { loss, span } = self;
        let RelaxationLoss { share, lost, .. } = loss;
        let longest = shown(loss.longest, Dimension::TIME);
        let percent = |number: f64| psd_text::units::display::significant(100.0 * number, 3);
        Diagnostic::new(Self::CODE, "relaxation would exceed the force itself")
            .at(span, format!("loses {} % until {longest}", percent(lost)))
            .help(format!(
                "write a `share` below {} %, or a shorter `longest`",
                percent(0.99 * share / lost)
            ))
    }
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
        return checker.fail(MustBeOutermost {
            variant: "logarithmic",
            span,
        });
    }
    let of = Box::new(inner(checker, written, chosen)?);
    let (share, reference_time) = (share?, time?);
    let longest = longest.unwrap_or(LONGEST_OF_REFERENCE * reference_time);
    if longest < LEAST_OF_REFERENCE * reference_time {
        return checker.fail(RelaxesTooShort {
            longest,
            reference_time,
            span,
        });
    }
    let law = LogarithmicRelaxation {
        share,
        reference_time,
        longest,
    };
    let lost = law.lost_after_long();
    if lost >= 1.0 {
        return checker.fail(RelaxesAway {
            loss: RelaxationLoss {
                share,
                lost,
                longest,
            },
            span,
        });
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

#[derive(Violation)]
#[violation(E632, "`{variant}` requires two models or more")]
#[help("add another model, or remove `{variant}`")]
struct TooFewParts<'a> {
    variant: &'a str,
    #[label("only one")]
    span: Span,
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
        return checker.fail(TooFewParts {
            variant: chosen.variant.name,
            span,
        });
    }
    // The size of a list is checked before its entries, so that its length is bounded.
    if exprs.len() > MOST_PARTS {
        return checker.fail(TooManyParts {
            most: MOST_PARTS,
            what: "springs",
            span,
        });
    }
    let found: Vec<_> = exprs
        .into_iter()
        .map(|expr| Some((part(checker, written, expr, Position::Inside)?, expr.span)))
        .collect();
    found.into_iter().collect()
}

#[derive(Violation)]
#[violation(
    E633,
    "a model that softens to a falling force is not allowed in `series`: its displacement is undetermined"
)]
#[help("move it outside: `fracture(of: series(…), force: …)`")]
struct FallsInSeries {
    #[label("force may fall")]
    span: Span,
    #[label("in this series")]
    series: Span,
}

fn series<'a>(
    checker: &mut Checker<'a>,
    written: &Written<'a>,
    chosen: &Chosen<'a>,
    span: Span,
) -> Option<Behaviour> {
    let found = parts(checker, written, chosen, span)?;
    if let Some((_, falls)) = found.iter().find(|(part, _)| !part.never_falls()) {
        return checker.fail(FallsInSeries {
            span: *falls,
            series: span,
        });
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
            return checker.fail(OneFormOnly {
                takes,
                example: "force: 5 kN",
                span,
                given,
            });
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
        checker.report(NoEffect {
            message,
            span,
            label: "never reached",
            help: "write a `displacement`, or a lower force",
        });
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
