//! `specimen NAME { … }`: equivalent mass and behaviour.

use super::checker::{Checker, Place};
use super::choice::Chosen;
use super::frame;
use super::faults::{frames, names as fault};
use crate::plan::{Behaviour, Ends, Specimen};
use crate::schema::FieldType;
use crate::source::Span;

/// A specimen whose entries are all right; None where a fault was reported.
pub fn specimen(checker: &mut Checker, block: usize) -> Option<Specimen> {
    let declared = &checker.scope.blocks[block];
    let (name, head) = (declared.name, declared.block.head);
    if frame::is_frame(checker, block) {
        let frame = frame::frame(checker, block)?;
        let (mass, frame) = (frame.total_mass(), Some((*frame).clone()));
        return Some(Specimen { name: name?.node.clone(), mass, frame, behaviour: None, damping: 0.0, coulomb: 0.0 });
    }
    let mass = mass(checker, block);
    if checker.misspelt(block, &["mass", "density", "area", "length"]) {
        // A misspelt field is said already.
    } else if mass.is_none() && !any_given(checker, block) {
        checker.faults.push(fault::missing_field(declared.kind, name, head, "mass", "mass = 0.73 kg"));
    } else if mass.is_none()
        && checker.given(block, "mass").is_none()
        && let Some(missing) = ["density", "area", "length"].into_iter().find(|field| checker.given(block, field).is_none())
    {
        checker.faults.push(fault::mass_incomplete(name, head, missing));
    }
    // Each number is looked at, also those that the mass does not need, so that all faults are seen at once.
    for field in ["length", "area", "density"] {
        checker.quantity(block, field);
    }
    // A real specimen bends as it does; a virtual one without a behaviour is said already.
    let behaviour = match checker.given(block, "behaviour") {
        None if checker.real_rig.is_some() => Some(None),
        _ => behaviour(checker, block, head).map(Some),
    };
    let (damping, coulomb) = (checker.constant(block, "damping"), checker.constant(block, "coulomb"));
    let frame = None;
    Some(Specimen { name: name?.node.clone(), mass: mass?, frame, behaviour: behaviour?, damping: damping?, coulomb: coulomb? })
}

fn any_given(checker: &Checker, block: usize) -> bool {
    ["mass", "density", "area", "length"].into_iter().any(|field| checker.given(block, field).is_some())
}

/// `mass`, else q·A·L/2, the equivalent mass at midspan (Melo et al. 2006, Fig. 5).
fn mass(checker: &mut Checker, block: usize) -> Option<f64> {
    if checker.given(block, "mass").is_some() {
        return checker.constant(block, "mass");
    }
    let (density, area, length) =
        (checker.constant(block, "density")?, checker.constant(block, "area")?, checker.constant(block, "length")?);
    Some(density * area * length / 2.0)
}

/// The value of `beam.mass` or `beam.stiffness`; None where the specimen has a fault that is reported in its place.
pub fn export(checker: &mut Checker, block: usize, name: &str, asked_at: Span) -> Option<f64> {
    match name {
        "mass" if frame::is_frame(checker, block) => frame::frame(checker, block).map(|frame| frame.total_mass()),
        "mass" => mass(checker, block),
        _ if frame::is_frame(checker, block) => {
            let name = checker.scope.blocks[block].name;
            checker.fail(frames::no_one_stiffness(name, asked_at))
        }
        // Known only of a behaviour; that a virtual specimen lacks it is said already.
        _ if checker.real_rig.is_some() && checker.given(block, "behaviour").is_none() => {
            let declared = &checker.scope.blocks[block];
            checker.fail(fault::stiffness_without_behaviour(declared.name, asked_at))
        }
        _ => behaviour(checker, block, asked_at).map(|behaviour| behaviour.initial_stiffness()),
    }
}

/// The behaviour; a fault in it is reported once, however often it is asked for.
pub fn behaviour(checker: &mut Checker, block: usize, asked_at: Span) -> Option<Behaviour> {
    let known = checker.faults.len();
    let behaviour = checker.within_entry(block, "behaviour", asked_at, |checker, written, place| {
        let FieldType::Choice(variants) = checker.scope.blocks[block].kind.field("behaviour")?.ty else { return None };
        let chosen = checker.chosen("behaviour", variants, written)?;
        bends(checker, &chosen, place)
    });
    checker.drop_repeated(known);
    behaviour
}

/// The behaviour that was chosen, of a specimen or of a storey.
pub fn bends<'a>(checker: &mut Checker<'a>, chosen: &Chosen<'a>, place: Place) -> Option<Behaviour> {
    match chosen.variant.name {
        "elastic" => Some(Behaviour::Elastic { stiffness: checker.constant_argument(chosen, "stiffness", place)? }),
        "bilinear" => {
            let stiffness = checker.constant_argument(chosen, "stiffness", place);
            let yield_force = checker.constant_argument(chosen, "yield_force", place);
            let hardening = checker.constant_argument(chosen, "hardening", place);
            Some(Behaviour::Bilinear { stiffness: stiffness?, yield_force: yield_force?, hardening: hardening? })
        }
        _ => beam(checker, chosen, place),
    }
}

/// Midspan or tip stiffness of a beam: cantilever 3EI/L³, simply supported 48EI/L³, built in 192EI/L³, partly built in
/// (192EI/L³)(r+2)/(r+8) with r = `k_θ`·L/EI at each end.
fn beam<'a>(checker: &mut Checker<'a>, chosen: &Chosen<'a>, place: Place) -> Option<Behaviour> {
    let length = checker.constant_argument(chosen, "length", place);
    let youngs_modulus = checker.constant_argument(chosen, "youngs_modulus", place);
    let second_moment = checker.constant_argument(chosen, "second_moment", place);
    let (field, written) = chosen.find("ends")?;
    let FieldType::Choice(variants) = field.ty else { return None };
    let ends = checker.chosen("ends", variants, written?)?;
    let ends = match ends.variant.name {
        "cantilever" => Ends::Cantilever,
        "simply_supported" => Ends::SimplySupported,
        "built_in" => Ends::BuiltIn,
        _ => Ends::PartlyBuiltIn { rotational_stiffness: checker.constant_argument(&ends, "rotational_stiffness", place)? },
    };
    let (length, youngs_modulus, second_moment) = (length?, youngs_modulus?, second_moment?);
    let bending = youngs_modulus * second_moment / length.powi(3);
    let stiffness = match ends {
        Ends::Cantilever => 3.0 * bending,
        Ends::SimplySupported => 48.0 * bending,
        Ends::BuiltIn => 192.0 * bending,
        Ends::PartlyBuiltIn { rotational_stiffness } => {
            let r = rotational_stiffness * length / (youngs_modulus * second_moment);
            192.0 * bending * (r + 2.0) / (r + 8.0)
        }
    };
    Some(Behaviour::Beam { stiffness, length, youngs_modulus, second_moment, ends })
}
