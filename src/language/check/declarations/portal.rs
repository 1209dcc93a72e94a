//! `behaviour = portal(…)`: a frame by plastic hinges. In: its arguments, and what the specimen says of its material. Out: a
//! [`Portal`] in SI. Which mechanism governs and what mass moves with it is reckoned elsewhere.

use crate::language::check::checker::{Checker, Place};
use crate::language::check::expressions::choice::Chosen;
use crate::language::check::messages::specimens as fault;
use crate::plan::{Behaviour, FrameMasses, Loads, Portal, Sections};
use crate::text::source::Span;

/// The frame that a plan writes; `mass_per_length` (kg/m) is what the specimen says of its material.
pub fn portal<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    place: Place,
    span: Span,
    mass_per_length: Option<f64>,
) -> Option<Behaviour> {
    let mut number = |name: &str| checker.constant_argument(chosen, name, place);
    let (length, height, plastic_moment) =
        (number("span"), number("height"), number("plastic_moment"));
    let modulus = checker.optional_argument(chosen, "youngs_modulus", place);
    let second_moment = checker.optional_argument(chosen, "second_moment", place);
    let column_moment = checker.optional_argument(chosen, "column_plastic_moment", place);
    let column_second = checker.optional_argument(chosen, "column_second_moment", place);
    let stiffness = checker.optional_argument(chosen, "stiffness", place);
    let masses = masses(checker, chosen, place, mass_per_length);
    let loads = checker.chosen_argument(chosen, "loads")?;
    let loads = match loads.variant.name {
        "sway" => Loads::Sway,
        "beam" => Loads::Beam,
        _ => {
            let mut number = |name: &str| checker.constant_argument(&loads, name, place);
            let (beam_load, sway_load) = (number("beam_load"), number("sway_load"));
            Loads::Combined {
                beam_load: beam_load?,
                sway_load: sway_load?,
            }
        }
    };
    let (length, height, plastic_moment) = (length?, height?, plastic_moment?);
    let plastic_moment = Sections {
        beam: plastic_moment,
        column: column_moment?.unwrap_or(plastic_moment),
    };
    let (second_moment, column_second) = (second_moment?, column_second?);
    if let (Some(_), None) = (column_second, second_moment) {
        return checker.fail(fault::missing_partner(
            "column_second_moment",
            "second_moment",
            chosen.span("column_second_moment")?,
        ));
    }
    let portal = match (modulus?, second_moment, stiffness?) {
        (Some(modulus), Some(beam), None) => {
            let bending = Sections {
                beam: modulus * beam,
                column: modulus * column_second.unwrap_or(beam),
            };
            Portal::of_sections(length, height, plastic_moment, bending, loads)
        }
        (None, None, Some(stiffness)) => Portal {
            span: length,
            height,
            plastic_moment,
            bending_stiffness: None,
            stiffness,
            loads,
            masses: None,
        },
        (Some(_), None, None) => {
            return checker.fail(fault::missing_partner(
                "youngs_modulus",
                "second_moment",
                chosen.span("youngs_modulus")?,
            ));
        }
        (None, Some(_), None) => {
            return checker.fail(fault::missing_partner(
                "second_moment",
                "youngs_modulus",
                chosen.span("second_moment")?,
            ));
        }
        (modulus, second_moment, _) => {
            let given = usize::from(modulus.is_some() || second_moment.is_some()) * 2;
            let takes =
                "a `portal` takes `youngs_modulus` with `second_moment`, or its `stiffness`";
            return checker.fail(fault::one_way_only(
                takes,
                "stiffness: 2 kN/mm",
                span,
                given,
            ));
        }
    };
    Some(Behaviour::Portal(portal.weighing(masses?)))
}

/// What the frame weighs; Some(None) where the plan does not say.
#[expect(
    clippy::option_option,
    reason = "left out and faulty are different things here"
)]
fn masses<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    place: Place,
    of_specimen: Option<f64>,
) -> Option<Option<FrameMasses>> {
    let beam = checker.optional_argument(chosen, "mass_per_length", place);
    let column = checker.optional_argument(chosen, "column_mass_per_length", place);
    let midspan = checker.constant_argument(chosen, "midspan_mass", place);
    let corner = checker.constant_argument(chosen, "corner_mass", place);
    let (beam, column, midspan, corner) = (beam?.or(of_specimen), column?, midspan?, corner?);
    if let (None, Some(_)) = (beam, column) {
        let span = chosen.span("column_mass_per_length")?;
        return checker.fail(fault::missing_partner(
            "column_mass_per_length",
            "mass_per_length",
            span,
        ));
    }
    let beam = beam.unwrap_or(0.0);
    let weighs = beam + midspan + corner > 0.0;
    let per_length = Sections {
        beam,
        column: column.unwrap_or(beam),
    };
    Some(weighs.then_some(FrameMasses {
        per_length,
        midspan,
        corner,
    }))
}
