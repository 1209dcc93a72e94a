//! Several axes in one step: how each was followed, and how they are told to whoever watches. In: targets, readings, the
//! state of a frame. Out: numbers of each axis. It drives nothing.

use super::{AxisReport, StepReport};
use crate::mechanics::frame::{FrameState, SymmetricBand};
use crate::mechanics::monitor::{Monitor, Tracking};
use crate::rig::Reading;

/// A monitor of tracking for every axis.
pub(super) struct Monitors(Vec<Monitor>);

impl Monitors {
    /// `operator` is the K of a correction r − K(d_m − d_c), where there is one.
    pub(super) fn new(commanded: &[f64], reading: &Reading, operator: Option<&SymmetricBand>) -> Self {
        let mut taken = reading.force.clone();
        if let Some(operator) = operator {
            let off: Vec<f64> = reading.displacement.iter().zip(commanded).map(|(measured, asked)| measured - asked).collect();
            operator.mul_add(-1.0, &off, &mut taken);
        }
        let axes = commanded.iter().zip(reading.displacement.iter().zip(reading.force.iter().zip(&taken)));
        let monitor = |(commanded, (measured, (force, taken))): (&f64, (&f64, (&f64, &f64)))| {
            Monitor::new_as(*commanded, *measured, *force, *taken)
        };
        Self(axes.map(monitor).collect())
    }

    /// What each axis has come to; `taken` is what the recursion takes for the forces at the commands, N.
    pub(super) fn take(&mut self, commanded: &[f64], reading: &Reading, taken: &[f64]) -> Vec<Tracking> {
        let read = reading.displacement.iter().zip(&reading.force).zip(taken);
        let axes = self.0.iter_mut().zip(commanded).zip(read);
        axes.map(|((monitor, to), ((measured, force), taken))| monitor.take_as(*to, *measured, *force, *taken)).collect()
    }
}

/// The errors of a step.
pub(super) struct Told {
    pub energy_error: f64,
    pub tracking: Tracking,
    pub tracking_energy_error: Option<f64>,
}

/// A step of all axes, the first one first.
pub(super) fn report(state: &FrameState, told: &Told) -> StepReport {
    let axis = |floor: usize| AxisReport {
        command: state.target[floor],
        displacement: state.measured_displacement[floor],
        velocity: state.velocity[floor],
        acceleration: state.acceleration[floor],
        force: state.restoring_force[floor],
    };
    let first = axis(0);
    StepReport {
        step: state.step,
        time: state.time,
        command: first.command,
        displacement: first.displacement,
        velocity: Some(first.velocity),
        acceleration: Some(first.acceleration),
        force: first.force,
        speed: None,
        energy_error: Some(told.energy_error),
        tracking: Some(told.tracking),
        tracking_energy_error: told.tracking_energy_error,
        others: (1..state.target.len()).map(axis).collect(),
    }
}
