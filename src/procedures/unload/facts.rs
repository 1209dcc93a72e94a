//! The facts about an unloading that the drivers of check and report need without carrying it out. In: an unloading of the plan.
//! Out: facts.

use super::figures;
use crate::procedures::facts::{Facts, Leaves, Listed, Recorded, Tests};
use crate::procedures::frame::charts::{entries_of, members_of};
use psd_plan::procedures::unload::block as schema;
use psd_plan::record::Unloaded;
use psd_plan::{Specimen, Unload};

pub(crate) fn facts(unload: &Unload) -> Facts<'static> {
    let shared = Facts {
        unloads: true,
        ..Facts::default()
    };
    if unload.stiffness.is_some() {
        return shared;
    }
    Facts {
        tests: Tests::Frame,
        figures: figures::FIGURES,
        ..shared
    }
}

pub(crate) fn listed(unload: &Unload) -> Listed {
    let headline = match unload.stiffness {
        Some(_) => schema::RESIDUAL_DISPLACEMENT,
        None => schema::RESIDUAL_DRIFT,
    };
    Listed {
        headline: vec![headline.name],
        ..Listed::default()
    }
}

/// The tested elements of a matrix frame have no force where K and the computed elements may have some, and the springs of storeys have none
/// where P-Δ has.
pub(crate) fn leaves(unload: &Unload, specimens: &[Option<Specimen>]) -> Leaves<'static> {
    let specimen = specimens.get(unload.specimen).and_then(Option::as_ref);
    let frame = specimen.and_then(|specimen| specimen.frame.as_ref());
    let ends = match frame {
        Some(frame) if frame.has_elements() => {
            "unloads the tested elements alone: the computed structure is not in balance with them"
        }
        Some(frame) if frame.computes_p_delta() => {
            "unloads the storeys: P-Δ remains where they have a residual drift"
        }
        _ => return Leaves::AtRest,
    };
    Leaves::Unbalanced {
        ends,
        help: "let the frame come to rest instead of the unloading: a longer `duration`, with a `damping_ratio`",
    }
}

pub(crate) fn recorded(of: Unloaded) -> Recorded {
    let frame = Recorded {
        lists_are_tabled: true,
        entries: entries_of(false),
        ..Recorded::default()
    };
    match of {
        Unloaded::OneAxis => Recorded::default(),
        Unloaded::Floors => frame,
        Unloaded::Elements => Recorded {
            members: members_of(true),
            ..frame
        },
    }
}
