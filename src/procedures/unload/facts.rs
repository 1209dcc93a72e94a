//! The facts about an unloading that the drivers of check and report need without carrying it out. In: nothing. Out: facts.

use crate::procedures::base_excitation::figures;
use crate::procedures::facts::{Facts, Recorded, Tests};
use crate::schema::procedures::unload as schema;

pub(crate) fn of_specimen() -> Facts<'static> {
    Facts {
        unloads: true,
        headline: vec![schema::RESIDUAL_DISPLACEMENT.name],
        ..Facts::default()
    }
}

pub(crate) fn of_frame() -> Facts<'static> {
    Facts {
        tests: Tests::Frame,
        unloads: true,
        figures: figures::UNLOADING_FIGURES,
        headline: vec![schema::RESIDUAL_DRIFT.name],
        ..Facts::default()
    }
}

pub(crate) fn recorded_frame() -> Recorded {
    Recorded {
        lists_are_tabled: true,
        ..Recorded::default()
    }
}
