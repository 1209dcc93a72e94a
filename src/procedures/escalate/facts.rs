//! The facts about a series of impacts that the drivers of check and report need without carrying it out. In: the series of the plan.
//! Out: facts.

use super::figures;
use crate::procedures::facts::{Facts, Listed, Recorded};
use crate::procedures::{impact, stepping};
use psd_plan::procedures::escalate::block as schema;
use psd_plan::{Escalate, ImpactTarget};

pub(crate) fn facts(series: &Escalate) -> Facts<'_> {
    let figures = match &series.impact.target {
        ImpactTarget::Point(_) => figures::FIGURES,
        ImpactTarget::Storey(_) => figures::STOREY_FIGURES,
    };
    Facts {
        conditions: Some(&series.condition),
        frame_damping: None,
        unloads_storeys: true,
        figures,
        shared_figures: &[],
        ..impact::facts::facts(&series.impact)
    }
}

pub(crate) fn listed() -> Listed {
    Listed {
        headline: vec![
            schema::LAST_PASSED_ENERGY.name,
            schema::FIRST_FAILED_ENERGY.name,
            schema::MAX_DISPLACEMENT.name,
            schema::RESIDUAL_DISPLACEMENT.name,
            schema::ABSORBED_ENERGY.name,
            schema::MAX_DRIFT.name,
            schema::RESIDUAL_DRIFT.name,
        ],
        unprinted: stepping::report::TRACKING.to_vec(),
    }
}

pub(crate) fn recorded() -> Recorded {
    Recorded {
        lists_are_tabled: true,
        entries: "impact",
        uncertainty: stepping::report::UNCERTAINTY,
        ..Recorded::default()
    }
}
