//! `striker NAME { … }`: mass, gap, and velocity, which may be stated as a drop height or the swing of a pendulum.

use crate::check::checker::Checker;
use crate::check::violations::{MissingField, TooUncertain};
use crate::codes::{E208, E407};
use psd_physics::impact::energy::kinetic_energy;
use psd_plan::Striker;
use psd_plan::formula::{Formula, Operator, Stated};
use psd_plan::schema::striker::{
    ANGLE, ARM, DROP_HEIGHT, GAP, GRAVITY, MASS, MASS_UNCERTAINTY, VELOCITY, VELOCITY_UNCERTAINTY,
};
use psd_plan::uncertainty::Source;
use psd_text::diagnostic::Violation;
use psd_text::source::Span;
use psd_text::units::unit::STANDARD_GRAVITY;

/// The fields of which each gives the velocity; an angle requires its arm.
const FORMS: [&str; 3] = [VELOCITY.name, DROP_HEIGHT.name, ANGLE.name];

/// Both, by the fields that give them, as written.
#[derive(Violation)]
#[violation(E208, "velocity given twice: by `{first_field}` and by `{again}`")]
#[help("remove one of them")]
struct VelocityTwice<'a> {
    again: &'a str,
    #[label("given again")]
    span: Span,
    first_field: &'a str,
    #[label("first given here")]
    first: Span,
}

#[derive(Violation)]
#[violation(E407, "the energy of the striker, ½ m v², is not a finite number")]
#[help("reduce its velocity or its mass")]
struct EnergyNotFinite {
    #[label("velocity or mass too large")]
    span: Span,
}

/// A striker whose entries are all valid; None where an error was reported.
pub fn striker(checker: &mut Checker, block: usize) -> Option<Striker> {
    let declared = &checker.scope.blocks[block];
    let (kind, name, head) = (declared.kind, declared.name, declared.block.head);
    let mass = checker.constant(block, MASS.name);
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
        [] if checker.field(block, ARM.name).is_some() || checker.misspelt(block, &FORMS) => {}
        [] => checker.report(MissingField {
            kind,
            name,
            head,
            field: VELOCITY.name,
            example: "velocity = 1 m/s",
        }),
        [_] => {}
        [(first, first_span), rest @ ..] => {
            for (again, span) in rest {
                checker.report(VelocityTwice {
                    again,
                    span: *span,
                    first_field: first,
                    first: *first_span,
                });
            }
        }
    }
    for (form, other, example) in [
        (ANGLE.name, ARM.name, "arm = 1 m"),
        (ARM.name, ANGLE.name, "angle = 60 deg"),
    ] {
        let pairless =
            checker.field(block, form).is_some() && checker.field(block, other).is_none();
        let missing = form == ANGLE.name || forms.is_empty();
        if pairless && missing && !checker.misspelt(block, &[other]) {
            checker.report(MissingField {
                kind,
                name,
                head,
                field: other,
                example,
            });
        }
    }
    // Every entry is read, so that every error is reported.
    for field in [DROP_HEIGHT.name, ARM.name, ANGLE.name] {
        checker.quantity(block, field);
    }
    let (velocity, gap, gravity) = (
        velocity(checker, block),
        checker.constant(block, GAP.name),
        checker.constant(block, GRAVITY.name),
    );
    let mass_uncertainty = uncertainty(checker, block, MASS_UNCERTAINTY.name, mass);
    let velocity_uncertainty = uncertainty(checker, block, VELOCITY_UNCERTAINTY.name, velocity);
    if let (Some(mass), Some(velocity)) = (mass, velocity)
        && !kinetic_energy(mass, velocity).is_finite()
    {
        return checker.fail(EnergyNotFinite {
            span: forms.first().map_or(head, |(_, span)| *span),
        });
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
            let kind = checker.scope.blocks[block].kind;
            let dimension = kind.field(field)?.dimension()?;
            checker.fail(TooUncertain {
                field,
                uncertainty,
                value,
                dimension,
                span: entry.value.span,
            })
        }
        _ => Some(uncertainty),
    }
}

/// Largest relative standard uncertainty of a value. Beyond it first-order propagation fails, and the value may be 0.
pub const MOST_UNCERTAIN: f64 = 0.2;

/// `velocity`, else √(2·gn·h); for a pendulum h = L(1 − cos θ).
fn velocity(checker: &mut Checker, block: usize) -> Option<f64> {
    if checker.field(block, VELOCITY.name).is_some() {
        return checker.constant(block, VELOCITY.name);
    }
    let height = if checker.field(block, DROP_HEIGHT.name).is_some() {
        checker.constant(block, DROP_HEIGHT.name)?
    } else {
        let (arm, angle) = (
            checker.constant(block, ARM.name),
            checker.constant(block, ANGLE.name),
        );
        // 1 − cos θ = 2 sin²(θ/2), which keeps the digits of a small angle.
        arm? * 2.0 * (0.5 * angle?).sin().powi(2)
    };
    Some((2.0 * STANDARD_GRAVITY * height).sqrt())
}

/// `pendulum.energy` and similar values, with their uncertainty contributions; None if the striker has an error that is reported there.
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
        let value = checker.constant(block, MASS.name)?;
        stated(
            checker,
            MASS_UNCERTAINTY.name,
            Source::StrikerMass(index),
            value,
        )
    };
    let speed = |checker: &mut Checker, value| {
        stated(
            checker,
            VELOCITY_UNCERTAINTY.name,
            Source::StrikerVelocity(index),
            value,
        )
    };
    let times =
        |a: Formula, b: Formula| Formula::Binary(Operator::Multiply, Box::new(a), Box::new(b));
    let formula = match name {
        _ if name == MASS.name => mass(checker)?,
        _ if name == GAP.name => Formula::Constant(checker.constant(block, GAP.name)?),
        _ => {
            let value = velocity(checker, block)?;
            let velocity = speed(checker, value)?;
            match name {
                _ if name == VELOCITY.name => velocity,
                _ if name == DROP_HEIGHT.name => {
                    let height = match checker.field(block, DROP_HEIGHT.name) {
                        Some(_) => checker.constant(block, DROP_HEIGHT.name)?,
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
