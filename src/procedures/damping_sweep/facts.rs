//! What the drivers of check and report must know of a damping sweep without carrying it out. In: it. Out: facts.

use super::chart;
use crate::procedures::facts::{Facts, Recorded};
use crate::procedures::stiffness_ramp;

pub(crate) fn facts() -> Facts<'static> {
    Facts {
        figures: chart::FIGURES,
        ..Facts::default()
    }
}

pub(crate) fn recorded() -> Recorded {
    Recorded {
        uncertainty: stiffness_ramp::report::UNCERTAINTY,
        ..Recorded::default()
    }
}
