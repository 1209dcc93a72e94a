//! The facts about a ground-motion test that check and report need without running it. In: a test, or its history. Out: facts.

use super::figures;
use crate::procedures::facts::{Delay, Facts, Listed, Recorded, Tests};
use crate::procedures::frame::charts::{entries_of, members_of};
use crate::procedures::stepping;
use crate::procedures::stepping::tracking::frame_delay;
use psd_plan::procedures::shake::block as schema;
use psd_plan::record::{Floors as _, ShakeHistory};
use psd_plan::{Dependence, Plan, Shake};

pub(crate) fn facts(shake: &Shake) -> Facts<'_> {
    Facts {
        tests: Tests::Frame,
        stepping: Some(&shake.stepping),
        frame_damping: Some((&shake.damping, shake.damping_uncertainty)),
        dependence: Dependence {
            frame: Some(shake.specimen),
            ..Dependence::default()
        },
        figures: figures::FIGURES,
        shared_figures: figures::SHARED,
        ..Facts::default()
    }
}

pub(crate) fn listed() -> Listed {
    Listed {
        headline: vec![
            schema::MAX_DRIFT.name,
            schema::MAX_BASE_SHEAR.name,
            schema::MAX_ELEMENT_FORCE.name,
            schema::FINAL_DRIFT.name,
            schema::MAX_DISPLACEMENT.name,
        ],
        unprinted: [
            &[schema::STEPS.name, schema::PERIODS.name][..],
            stepping::report::TRACKING,
        ]
        .concat(),
    }
}

pub(crate) fn recorded(history: &ShakeHistory) -> Recorded {
    let ends = history.steps.first().zip(history.steps.last());
    let elements = ends.is_some_and(|(first, _)| first.has_elements());
    Recorded {
        lists_are_tabled: true,
        time_spans: ends.map(|(first, last)| {
            (
                last.floors.time - first.floors.time,
                last.wall_time - first.wall_time,
            )
        }),
        budgeted: stepping::report::FRAME_BUDGET,
        entries: entries_of(elements),
        members: members_of(elements),
        uncertainty: stepping::report::UNCERTAINTY,
        ..Recorded::default()
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
    frame_delay(plan, *specimen, damping, stepping, |properties| {
        Some(properties.critical_time_step())
    })
}
