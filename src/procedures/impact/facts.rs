//! What the drivers of check and report must know of a blow without carrying it out. In: it. Out: facts.

use super::{chart, report};
use crate::plan::{Dependence, Impact, StoreyImpact};
use crate::procedures::facts::{Facts, Recorded, Tests};
use crate::procedures::stepping;
use crate::record::ImpactHistory;

/// Of one degree of freedom.
pub(crate) fn on_specimen(blow: &Impact) -> Facts<'_> {
    Facts {
        stepping: Some(&blow.stepping),
        contact: Some(&blow.contact),
        dependence: Dependence {
            striker: Some(blow.striker),
            mass_uncertainty: Some(blow.mass_uncertainty),
            frame: None,
        },
        figures: chart::FIGURES,
        shared_figures: chart::SHARED,
        ..Facts::default()
    }
}

/// Of a storey.
pub(crate) fn on_storey(blow: &StoreyImpact) -> Facts<'_> {
    Facts {
        tests: Tests::Frame,
        stepping: Some(&blow.stepping),
        contact: Some(&blow.contact),
        frame_damping: Some((&blow.damping, blow.damping_uncertainty)),
        dependence: Dependence {
            striker: Some(blow.striker),
            mass_uncertainty: None,
            frame: Some(blow.specimen),
        },
        figures: chart::STOREY_FIGURES,
        ..Facts::default()
    }
}

pub(crate) fn recorded(history: &ImpactHistory) -> Recorded {
    let ends = history.steps.first().zip(history.steps.last());
    let of_frame = history.frame.is_some();
    Recorded {
        lists_are_tabled: of_frame,
        time_spans: ends
            .map(|(first, last)| (last.time - first.time, last.wall_time - first.wall_time)),
        budgeted: if of_frame {
            stepping::report::FRAME_BUDGET
        } else {
            report::BUDGET
        },
        uncertainty: stepping::report::UNCERTAINTY,
        ..Recorded::default()
    }
}
