//! `beam(…)`: an elastic beam by its section and its ends. In: the variant as it is written. Out: a [`Behaviour`] in SI.

use crate::check::checker::{Checker, Context};
use crate::check::expressions::choice::Chosen;
use crate::check::violations::MissingPartner;
use crate::check::wording::shown;
use crate::codes::E401;
use psd_physics::structure::beam::{self, Span};
use psd_plan::schema::behaviours::argument;
use psd_plan::{Beam, Behaviour, Ends};
use psd_text::diagnostic::Violation;
use psd_text::units::Dimension;

#[derive(Violation)]
#[violation(
    E401,
    "the struck section is not inside this beam of {}",
    shown(length, Dimension::LENGTH)
)]
#[help("write the distance from a support, or from the fixed end of a cantilever")]
struct BeyondTheBeam {
    length: f64,
    #[label("too far")]
    span: psd_text::source::Span,
}

/// Stiffness of a beam at midspan, at its tip or at `at`; the formulas are in `physics/structure/beam.rs`.
pub fn beam<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
    own_mass: Option<f64>,
) -> Option<Behaviour> {
    let length = checker.constant_argument(chosen, argument::LENGTH, context);
    let youngs_modulus = checker.constant_argument(chosen, argument::YOUNGS_MODULUS, context);
    let second_moment = checker.constant_argument(chosen, argument::SECOND_MOMENT, context);
    let modulus = checker.optional_argument(chosen, argument::SHEAR_MODULUS, context);
    let area = checker.optional_argument(chosen, argument::SHEAR_AREA, context);
    let at = checker.optional_argument(chosen, argument::AT, context);
    let ends = checker.chosen_argument(chosen, argument::ENDS)?;
    let rotational_stiffness = match ends.variant.name {
        "partly_built_in" => {
            Some(checker.constant_argument(&ends, argument::ROTATIONAL_STIFFNESS, context)?)
        }
        _ => None,
    };
    let fixity = match ends.variant.name {
        "fixity" => Some(checker.constant_argument(&ends, argument::FACTOR, context)?),
        _ => None,
    };
    let (length, youngs_modulus, second_moment) = (length?, youngs_modulus?, second_moment?);
    let shear = match (modulus?, area?) {
        (Some(modulus), Some(area)) => Some(modulus * area),
        (None, None) => None,
        (Some(_), None) => {
            return checker.fail(MissingPartner {
                given: argument::SHEAR_MODULUS,
                missing: argument::SHEAR_AREA,
                span: chosen.span(argument::SHEAR_MODULUS)?,
            });
        }
        (None, Some(_)) => {
            return checker.fail(MissingPartner {
                given: argument::SHEAR_AREA,
                missing: argument::SHEAR_MODULUS,
                span: chosen.span(argument::SHEAR_AREA)?,
            });
        }
    };
    let span = Span {
        length,
        bending: youngs_modulus * second_moment,
    };
    let ends = match (ends.variant.name, rotational_stiffness, fixity) {
        (_, Some(rotational_stiffness), _) => Ends::PartlyBuiltIn {
            rotational_stiffness,
        },
        (_, _, Some(factor)) => beam::ends_of_fixity(factor, span),
        ("cantilever", ..) => Ends::Cantilever,
        ("simply_supported", ..) => Ends::SimplySupported,
        _ => Ends::BuiltIn,
    };
    let at = at?;
    let stiffness = match at {
        None => beam::stiffness(span, ends, shear),
        Some(at) if at < length || (at <= length && ends == Ends::Cantilever) => {
            beam::stiffness_at(span, ends, shear, at)
        }
        Some(_) => {
            return checker.fail(BeyondTheBeam {
                length,
                span: chosen.span(argument::AT)?,
            });
        }
    };
    Some(Behaviour::Beam(Beam {
        stiffness,
        length,
        youngs_modulus,
        second_moment,
        ends,
        shear,
        at,
        own_mass,
    }))
}
