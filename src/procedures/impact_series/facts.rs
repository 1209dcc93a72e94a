//! The facts about a series of impacts that the drivers of check and report need without carrying it out. In: the series of the plan.
//! Out: facts.

use super::chart;
use crate::plan::{Escalate, ImpactTarget};
use crate::procedures::facts::{Facts, Recorded};
use crate::procedures::{impact, stepping};

pub(crate) fn facts(series: &Escalate) -> Facts<'_> {
    let figures = match &series.impact.target {
        ImpactTarget::Point(_) => chart::FIGURES,
        ImpactTarget::Storey(_) => chart::STOREY_FIGURES,
    };
    Facts {
        conditions: Some(&series.condition),
        frame_damping: None,
        figures,
        shared_figures: &[],
        ..impact::facts::facts(&series.impact)
    }
}

pub(crate) fn recorded() -> Recorded {
    Recorded {
        lists_are_tabled: true,
        entries: "blow",
        uncertainty: stepping::report::UNCERTAINTY,
        ..Recorded::default()
    }
}
