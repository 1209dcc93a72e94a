//! The facts about an unloading that the drivers of check and report need without carrying it out. In: nothing. Out: facts.

use crate::procedures::base_excitation::chart;
use crate::procedures::facts::{Facts, Recorded, Tests};

pub(crate) fn of_specimen() -> Facts<'static> {
    Facts {
        unloads: true,
        ..Facts::default()
    }
}

pub(crate) fn of_frame() -> Facts<'static> {
    Facts {
        tests: Tests::Frame,
        unloads: true,
        figures: chart::UNLOADING_FIGURES,
        ..Facts::default()
    }
}

pub(crate) fn recorded_frame() -> Recorded {
    Recorded {
        lists_are_tabled: true,
        ..Recorded::default()
    }
}
