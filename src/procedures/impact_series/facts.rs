//! What the drivers of check and report must know of a row of blows without carrying it out. In: it. Out: facts.

use super::chart;
use crate::plan::{BlowOn, Escalate};
use crate::procedures::facts::{Facts, Recorded};
use crate::procedures::{impact, stepping};

pub(crate) fn facts(row: &Escalate) -> Facts<'_> {
    let (blow, figures) = match &row.blow {
        BlowOn::Specimen(blow) => (impact::facts::on_specimen(blow), chart::FIGURES),
        BlowOn::Storey(blow) => (impact::facts::on_storey(blow), chart::STOREY_FIGURES),
    };
    Facts {
        conditions: Some(&row.condition),
        frame_damping: None,
        figures,
        shared_figures: &[],
        ..blow
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
