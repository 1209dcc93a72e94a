//! The facts about a `cycle` that check and report need without running it. In: the `cycle`. Out: facts.

use super::{figures, report};
use crate::procedures::facts::{Facts, Listed, Recorded};
use psd_plan::procedures::cycle::block as schema;

pub(crate) fn facts() -> Facts<'static> {
    Facts {
        figures: figures::FIGURES,
        ..Facts::default()
    }
}

pub(crate) fn listed() -> Listed {
    Listed {
        headline: vec![
            schema::DISSIPATED_ENERGY.name,
            schema::EQUIVALENT_DAMPING_RATIO.name,
            schema::STIFFNESS.name,
            schema::YIELD_FORCE.name,
            schema::MAX_FORCE.name,
            schema::MIN_FORCE.name,
        ],
        ..Listed::default()
    }
}

pub(crate) fn recorded() -> Recorded {
    Recorded {
        lists_are_tabled: true,
        entries: "cycle",
        uncertainty: report::UNCERTAINTY,
        ..Recorded::default()
    }
}
