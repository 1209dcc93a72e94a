//! The facts about an unloading that the drivers of check and report need without carrying it out. In: an unloading of the plan.
//! Out: facts.

use crate::procedures::facts::{Facts, Recorded, Tests};
use crate::procedures::shake::figures;
use crate::procedures::shake::figures::charts::{entries_of, members_of};
use psd_plan::Unload;
use psd_plan::procedures::unload::block as schema;

pub(crate) fn facts(unload: &Unload) -> Facts<'static> {
    let shared = Facts {
        unloads: true,
        headline: vec![schema::RESIDUAL_DISPLACEMENT.name],
        ..Facts::default()
    };
    if unload.stiffness.is_some() {
        return shared;
    }
    Facts {
        tests: Tests::Frame,
        figures: figures::UNLOADING_FIGURES,
        headline: vec![schema::RESIDUAL_DRIFT.name],
        ..shared
    }
}

pub(crate) fn recorded_frame() -> Recorded {
    Recorded {
        lists_are_tabled: true,
        entries: entries_of(false),
        ..Recorded::default()
    }
}

pub(crate) fn recorded_elements() -> Recorded {
    Recorded {
        members: members_of(true),
        ..recorded_frame()
    }
}
