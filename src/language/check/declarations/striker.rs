//! `striker NAME { … }`: mass, gap, and velocity, which may be stated as a height of fall or the swing of a pendulum.

use crate::language::check::checker::Checker;
use crate::language::check::messages::{names as message, values};
use crate::plan::Striker;
use crate::plan::formula::{Formula, Operator, Stated};
use crate::text::source::Span;
use crate::uncertainty::Source;
use crate::units::Dimension;

/// Standard gravity \[m/s²\].
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// The fields that each give the velocity; an angle needs its arm.
const FORMS: [&str; 3] = ["velocity", "drop_height", "angle"];

/// A striker whose entries are all valid; None where an error was reported.
pub fn striker(checker: &mut Checker, block: usize) -> Option<Striker> {
    let declared = &checker.scope.blocks[block];
    let (kind, name, head) = (declared.kind, declared.name, declared.block.head);
    let mass = checker.constant(block, "mass");
    let mut forms: Vec<(&str, Span)> = FORMS
        .into_iter()
        .filter_map(|form| {
            checker
                .field(block, form)
                .map(|(entry, written)| (entry, form, written.key.span))
        })
        .map(|(_, form, span)| (form, span))
        .collect();
    forms.sort_by_key(|(_, span)| span.start);
    match forms.as_slice() {
        [] if checker.field(block, "arm").is_some() || checker.misspelt(block, &FORMS) => {}
        [] => checker.diagnostics.push(message::missing_field(
            kind,
            name,
            head,
            "velocity",
            "velocity = 1 m/s",
        )),
        [_] => {}
        [(first, first_span), rest @ ..] => {
            for (again, span) in rest {
                checker
                    .diagnostics
                    .push(message::velocity_twice(again, *span, first, *first_span));
            }
        }
    }
    for (form, other, example) in [
        ("angle", "arm", "arm = 1 m"),
        ("arm", "angle", "angle = 60 deg"),
    ] {
        let pairless =
            checker.field(block, form).is_some() && checker.field(block, other).is_none();
        let lacking = form == "angle" || forms.is_empty();
        if pairless && lacking && !checker.misspelt(block, &[other]) {
            checker
                .diagnostics
                .push(message::missing_field(kind, name, head, other, example));
        }
    }
    // Every entry is read, so that every error is reported.
    for field in ["drop_height", "arm", "angle"] {
        checker.quantity(block, field);
    }
    let (velocity, gap, gravity) = (
        velocity(checker, block),
        checker.constant(block, "gap"),
        checker.constant(block, "gravity"),
    );
    let mass_uncertainty = uncertainty(checker, block, "mass_uncertainty", mass);
    let velocity_uncertainty = uncertainty(checker, block, "velocity_uncertainty", velocity);
    if let (Some(mass), Some(velocity)) = (mass, velocity)
        && !(0.5 * mass * velocity * velocity).is_finite()
    {
        return checker.fail(values::energy_not_finite(
            forms.first().map_or(head, |(_, span)| *span),
        ));
    }
    Some(Striker {
        name: name?.node.clone(),
        mass: mass?,
        mass_uncertainty: mass_uncertainty?,
        velocity: velocity?,
        velocity_uncertainty: velocity_uncertainty?,
        gap: gap?,
        gravity: gravity?,
    })
}

/// A standard uncertainty in SI units that is small relative to its `value`.
pub fn uncertainty(
    checker: &mut Checker,
    block: usize,
    field: &'static str,
    value: Option<f64>,
) -> Option<f64> {
    let uncertainty = checker.constant(block, field)?;
    match (value, checker.field(block, field)) {
        (Some(value), Some((_, entry))) if uncertainty > MOST_UNCERTAIN * value => {
            let dimension = entry_dimension(field);
            checker.fail(values::too_uncertain(
                field,
                uncertainty,
                value,
                dimension,
                entry.value.span,
            ))
        }
        _ => Some(uncertainty),
    }
}

/// Largest relative standard uncertainty of a value: beyond it first-order propagation fails, and 0 is within reach.
pub const MOST_UNCERTAIN: f64 = 0.2;

fn entry_dimension(field: &str) -> Dimension {
    if field == "velocity_uncertainty" {
        Dimension::VELOCITY
    } else {
        Dimension::MASS
    }
}

/// `velocity`, else √(2·gn·h), where a pendulum falls by h = L(1 − cos θ).
fn velocity(checker: &mut Checker, block: usize) -> Option<f64> {
    if checker.field(block, "velocity").is_some() {
        return checker.constant(block, "velocity");
    }
    let height = if checker.field(block, "drop_height").is_some() {
        checker.constant(block, "drop_height")?
    } else {
        let (arm, angle) = (
            checker.constant(block, "arm"),
            checker.constant(block, "angle"),
        );
        // 1 − cos θ = 2 sin²(θ/2), which keeps the digits of a small angle.
        arm? * 2.0 * (0.5 * angle?).sin().powi(2)
    };
    Some((2.0 * STANDARD_GRAVITY * height).sqrt())
}

/// `pendulum.energy` and the like, with their uncertainty contributions; None where the striker has an error that is reported
/// there.
pub fn exported(checker: &mut Checker, block: usize, name: &str) -> Option<Formula> {
    let index = checker.scope.index_in_kind(block);
    let stated = |checker: &mut Checker, field, source, value| {
        let uncertainty = checker.constant(block, field)?;
        Some(
            Stated {
                source,
                value,
                uncertainty,
            }
            .formula(),
        )
    };
    let mass = |checker: &mut Checker| {
        let value = checker.constant(block, "mass")?;
        stated(
            checker,
            "mass_uncertainty",
            Source::StrikerMass(index),
            value,
        )
    };
    let speed = |checker: &mut Checker, value| {
        stated(
            checker,
            "velocity_uncertainty",
            Source::StrikerVelocity(index),
            value,
        )
    };
    let times =
        |a: Formula, b: Formula| Formula::Binary(Operator::Multiply, Box::new(a), Box::new(b));
    let formula = match name {
        "mass" => mass(checker)?,
        "gap" => Formula::Constant(checker.constant(block, "gap")?),
        _ => {
            let value = velocity(checker, block)?;
            let velocity = speed(checker, value)?;
            match name {
                "velocity" => velocity,
                "drop_height" => {
                    let height = match checker.field(block, "drop_height") {
                        Some(_) => checker.constant(block, "drop_height")?,
                        None => value * value / (2.0 * STANDARD_GRAVITY),
                    };
                    // h (v/v₀)²: the stated height, with the uncertainty that follows from the velocity.
                    let ratio = Formula::Binary(
                        Operator::Divide,
                        Box::new(velocity),
                        Box::new(Formula::Constant(value)),
                    );
                    times(Formula::Constant(height), times(ratio.clone(), ratio))
                }
                _ => times(
                    times(Formula::Constant(0.5), mass(checker)?),
                    times(velocity.clone(), velocity),
                ),
            }
        }
    };
    Some(folded(formula))
}

/// A number without an uncertainty.
fn folded(formula: Formula) -> Formula {
    match formula.constant() {
        Some(value) if !formula.is_uncertain() => Formula::Constant(value),
        _ => formula,
    }
}
