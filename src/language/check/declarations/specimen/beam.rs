//! `beam(…)`: an elastic beam by its section and its ends. In: the variant as it is written. Out: a [`Behaviour`] in SI.

use crate::language::check::checker::{Checker, Context};
use crate::language::check::expressions::choice::Chosen;
use crate::language::check::messages::specimens as message;
use crate::physics::structure::beam::{self, Span};
use crate::plan::{Beam, Behaviour, Ends};

/// Stiffness of a beam at midspan or at its tip; the formulas are in `physics/structure/beam.rs`.
pub fn beam<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
    own_mass: Option<f64>,
) -> Option<Behaviour> {
    let length = checker.constant_argument(chosen, "length", context);
    let youngs_modulus = checker.constant_argument(chosen, "youngs_modulus", context);
    let second_moment = checker.constant_argument(chosen, "second_moment", context);
    let modulus = checker.optional_argument(chosen, "shear_modulus", context);
    let area = checker.optional_argument(chosen, "shear_area", context);
    let ends = checker.chosen_argument(chosen, "ends")?;
    let rotational_stiffness = match ends.variant.name {
        "partly_built_in" => {
            Some(checker.constant_argument(&ends, "rotational_stiffness", context)?)
        }
        _ => None,
    };
    let fixity = match ends.variant.name {
        "fixity" => Some(checker.constant_argument(&ends, "factor", context)?),
        _ => None,
    };
    let (length, youngs_modulus, second_moment) = (length?, youngs_modulus?, second_moment?);
    let shear = match (modulus?, area?) {
        (Some(modulus), Some(area)) => Some(modulus * area),
        (None, None) => None,
        (Some(_), None) => {
            return checker.fail(message::missing_partner(
                "shear_modulus",
                "shear_area",
                chosen.span("shear_modulus")?,
            ));
        }
        (None, Some(_)) => {
            return checker.fail(message::missing_partner(
                "shear_area",
                "shear_modulus",
                chosen.span("shear_area")?,
            ));
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
    let stiffness = beam::stiffness(span, ends, shear);
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
