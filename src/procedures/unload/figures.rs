//! The figure of an unloaded frame, with its caption. In: the moves of an unloading. Out: a [`Chart`] in SI.

use crate::procedures::frame::captions::storey_shear;
use crate::procedures::frame::charts;
use crate::report::Run;
use crate::report::figures::chart::Chart;
use crate::report::wording::specimen::measured;
use psd_plan::FigureKind;
use psd_plan::record::{UnloadHistory, UnloadStep, Unloaded};

/// Figures of a frame that is unloaded.
pub(crate) const FIGURES: &[FigureKind] = &[FigureKind::Hysteresis];

/// The unloading path of a frame to zero restoring force, and its caption; None for one degree of freedom, and without a step.
pub(crate) fn chart(
    run: &Run<'_>,
    name: &str,
    UnloadHistory { of, steps }: &UnloadHistory,
    kind: FigureKind,
) -> Option<(Chart, String)> {
    if kind != FigureKind::Hysteresis || steps.is_empty() {
        return None;
    }
    match of {
        Unloaded::OneAxis => None,
        Unloaded::Floors => Some((
            charts::hysteresis(steps),
            format!(
                "{name}: {} against drift, from the start of the unloading to the unloaded position of each storey.",
                storey_shear(run)
            ),
        )),
        Unloaded::Elements => {
            let force = measured("force of each element", run.plan.frame_on_the_rig());
            let read = |step: &UnloadStep| {
                let deformation = step.displacement.iter().copied();
                deformation
                    .zip(step.restoring_force.iter().copied())
                    .collect()
            };
            Some((
                charts::loops(steps, true, read),
                format!(
                    "{name}: {force} against its deformation, from the start of the unloading to zero force."
                ),
            ))
        }
    }
}
