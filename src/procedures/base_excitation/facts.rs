//! The facts about a ground-motion test that check and report need without running it. In: a test, or its history. Out: facts.

use super::chart;
use crate::plan::{Dependence, Plan, Shake};
use crate::procedures::facts::{Delay, Facts, Recorded, Tests};
use crate::procedures::stepping;
use crate::procedures::stepping::delay::of_frame;
use crate::record::ShakeHistory;

pub(crate) fn facts(shake: &Shake) -> Facts<'_> {
    Facts {
        tests: Tests::Frame,
        stepping: Some(&shake.stepping),
        frame_damping: Some((&shake.damping, shake.damping_uncertainty)),
        dependence: Dependence {
            frame: Some(shake.specimen),
            ..Dependence::default()
        },
        figures: chart::FIGURES,
        shared_figures: chart::SHARED,
        ..Facts::default()
    }
}

pub(crate) fn recorded(history: &ShakeHistory) -> Recorded {
    let ends = history.steps.first().zip(history.steps.last());
    Recorded {
        lists_are_tabled: true,
        time_spans: ends
            .map(|(first, last)| (last.time - first.time, last.wall_time - first.wall_time)),
        budgeted: stepping::report::FRAME_BUDGET,
        entries: "floor",
        uncertainty: stepping::report::UNCERTAINTY,
    }
}

/// The delay of the actuators under the frame.
pub(crate) fn delay(plan: &Plan, shake: &Shake) -> Option<Delay> {
    let Shake {
        specimen,
        damping,
        stepping,
        ..
    } = shake;
    of_frame(plan, *specimen, damping, stepping, |properties| {
        Some(properties.critical_time_step())
    })
}
