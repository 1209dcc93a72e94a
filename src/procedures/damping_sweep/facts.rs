//! The facts about a damping sweep that check and report need without running it. In: the sweep. Out: facts.

use super::figures;
use crate::procedures::facts::{Facts, Listed, Recorded};
use crate::procedures::stiffness_ramp;
use psd_plan::procedures::damping_sweep::block as schema;
use psd_plan::record::DampingSweepHistory;

pub(crate) fn facts() -> Facts<'static> {
    Facts {
        figures: figures::FIGURES,
        ..Facts::default()
    }
}

pub(crate) fn listed() -> Listed {
    Listed {
        headline: vec![
            schema::DAMPING.name,
            schema::COULOMB_FORCE.name,
            schema::DAMPING_RATIO.name,
        ],
        ..Listed::default()
    }
}

pub(crate) fn recorded(history: &DampingSweepHistory) -> Recorded {
    Recorded {
        strokes: Some(history.together),
        distinct_from_zero: Some(schema::DAMPING.name),
        uncertainty: stiffness_ramp::report::UNCERTAINTY,
        ..Recorded::default()
    }
}
