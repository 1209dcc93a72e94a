//! `behaviour = portal(…)`: a frame with plastic hinges. In: its arguments, and the material data of the specimen. Out: a
//! [`Portal`] in SI. The governing mechanism and the mass that moves with it are calculated in `physics`.

use crate::check::checker::{Checker, Context};
use crate::check::expressions::choice::Chosen;
use crate::check::violations::{MissingPartner, OneFormOnly};
use psd_plan::schema::behaviours::{STIFFNESS, argument};
use psd_plan::{Behaviour, FrameMasses, Loads, Portal, Sections};
use psd_text::source::Span;

/// The frame as the plan specifies it; `mass_per_length` \[kg/m\] comes from the material data of the specimen.
pub fn portal<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
    span: Span,
    mass_per_length: Option<f64>,
) -> Option<Behaviour> {
    let mut number = |name: &str| checker.constant_argument(chosen, name, context);
    let (length, height, plastic_moment) = (
        number(argument::SPAN),
        number(argument::HEIGHT),
        number(argument::PLASTIC_MOMENT),
    );
    let modulus = checker.optional_argument(chosen, argument::YOUNGS_MODULUS, context);
    let second_moment = checker.optional_argument(chosen, argument::SECOND_MOMENT, context);
    let column_moment = checker.optional_argument(chosen, argument::COLUMN_PLASTIC_MOMENT, context);
    let column_second = checker.optional_argument(chosen, argument::COLUMN_SECOND_MOMENT, context);
    let stiffness = checker.optional_argument(chosen, STIFFNESS.name, context);
    let masses = masses(checker, chosen, context, mass_per_length);
    let loads = checker.chosen_argument(chosen, argument::LOADS)?;
    let loads = match loads.variant.name {
        "sway" => Loads::Sway,
        "beam" => Loads::Beam,
        _ => {
            let mut number = |name: &str| checker.constant_argument(&loads, name, context);
            let (beam_load, sway_load) = (number(argument::BEAM_LOAD), number(argument::SWAY_LOAD));
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
        return checker.fail(MissingPartner {
            given: argument::COLUMN_SECOND_MOMENT,
            missing: argument::SECOND_MOMENT,
            span: chosen.span(argument::COLUMN_SECOND_MOMENT)?,
        });
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
            return checker.fail(MissingPartner {
                given: argument::YOUNGS_MODULUS,
                missing: argument::SECOND_MOMENT,
                span: chosen.span(argument::YOUNGS_MODULUS)?,
            });
        }
        (None, Some(_), None) => {
            return checker.fail(MissingPartner {
                given: argument::SECOND_MOMENT,
                missing: argument::YOUNGS_MODULUS,
                span: chosen.span(argument::SECOND_MOMENT)?,
            });
        }
        (modulus, second_moment, _) => {
            let given = usize::from(modulus.is_some() || second_moment.is_some()) * 2;
            let takes =
                "a `portal` requires either `youngs_modulus` with `second_moment`, or `stiffness`";
            return checker.fail(OneFormOnly {
                takes,
                example: "stiffness: 2 kN/mm",
                span,
                given,
            });
        }
    };
    Some(Behaviour::Portal(portal.with_masses(masses?)))
}

/// The masses of the frame; Some(None) where the plan does not state them.
#[expect(
    clippy::option_option,
    reason = "left out and faulty are different things here"
)]
fn masses<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
    of_specimen: Option<f64>,
) -> Option<Option<FrameMasses>> {
    let beam = checker.optional_argument(chosen, argument::MASS_PER_LENGTH, context);
    let column = checker.optional_argument(chosen, argument::COLUMN_MASS_PER_LENGTH, context);
    let midspan = checker.constant_argument(chosen, argument::MIDSPAN_MASS, context);
    let corner = checker.constant_argument(chosen, argument::CORNER_MASS, context);
    let (beam, column, midspan, corner) = (beam?.or(of_specimen), column?, midspan?, corner?);
    if let (None, Some(_)) = (beam, column) {
        let span = chosen.span(argument::COLUMN_MASS_PER_LENGTH)?;
        return checker.fail(MissingPartner {
            given: argument::COLUMN_MASS_PER_LENGTH,
            missing: argument::MASS_PER_LENGTH,
            span,
        });
    }
    let beam = beam.unwrap_or(0.0);
    let has_mass = beam + midspan + corner > 0.0;
    let per_length = Sections {
        beam,
        column: column.unwrap_or(beam),
    };
    Some(has_mass.then_some(FrameMasses {
        per_length,
        midspan,
        corner,
    }))
}
