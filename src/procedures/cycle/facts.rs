//! The facts about a `cycle` that check and report need without running it. In: the `cycle`. Out: facts.

use super::{chart, report};
use crate::procedures::facts::{Facts, Recorded};

pub(crate) fn facts() -> Facts<'static> {
    Facts {
        figures: chart::FIGURES,
        ..Facts::default()
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
