//! Several axes in one step: the tracking of each, and the report to an observer of the run. In: targets, readings, the end of a step.
//! Out: numbers of each axis. It moves nothing.

use crate::physics::integrator::state::State;
use crate::physics::structure::matrix::Vector;
use crate::physics::tracking::monitor::{Monitor, TrackedStep, Tracking};
use crate::rig::Reading;
use crate::run::{AxisReport, StepReport};

/// The end of a step, one entry per axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AxesState<'a> {
    pub step: u64,
    /// \[s\]
    pub time: f64,
    /// \[m\]
    pub target: &'a [f64],
    /// Measured \[m\].
    pub displacement: &'a [f64],
    /// \[m/s\]
    pub velocity: &'a [f64],
    /// \[m/s²\]
    pub acceleration: &'a [f64],
    /// Measured \[N\].
    pub force: &'a [f64],
}

impl<'a> AxesState<'a> {
    pub(crate) fn of<V: Vector>(state: &'a State<V>) -> Self {
        Self {
            step: state.step,
            time: state.time,
            target: state.target.as_slice(),
            displacement: state.measured_displacement.as_slice(),
            velocity: state.velocity.as_slice(),
            acceleration: state.acceleration.as_slice(),
            force: state.restoring_force.as_slice(),
        }
    }
}

/// A tracking monitor for every axis.
pub(crate) struct Monitors(Vec<Monitor>);

impl Monitors {
    /// `effective_force` are the effective forces of the recursion at the commanded displacements \[N\].
    pub(crate) fn new(commanded: &[f64], reading: &Reading, effective_force: &[f64]) -> Self {
        let axes = tracked(commanded, reading, effective_force);
        Self(axes.map(|axis| Monitor::new(&axis)).collect())
    }

    /// The tracking of each axis so far.
    pub(crate) fn tracking(&self) -> Vec<Tracking> {
        self.0.iter().map(Monitor::tracking).collect()
    }

    /// Adds a step; `effective_force` are the effective forces of the recursion at the commanded displacements \[N\].
    pub(crate) fn take(
        &mut self,
        commanded: &[f64],
        reading: &Reading,
        effective_force: &[f64],
    ) -> Vec<Tracking> {
        let axes = self
            .0
            .iter_mut()
            .zip(tracked(commanded, reading, effective_force));
        axes.map(|(monitor, axis)| monitor.take(&axis)).collect()
    }
}

/// The step of each axis.
fn tracked<'a>(
    commanded: &'a [f64],
    reading: &'a Reading,
    effective_force: &'a [f64],
) -> impl Iterator<Item = TrackedStep> {
    let read = reading
        .displacement
        .iter()
        .zip(&reading.force)
        .zip(effective_force);
    let axes = commanded.iter().zip(read);
    axes.map(
        |(commanded, ((measured, force), effective_force))| TrackedStep {
            commanded: *commanded,
            measured: *measured,
            force: *force,
            effective_force: *effective_force,
        },
    )
}

/// The errors of a step.
pub(crate) struct Errors {
    pub energy_error: f64,
    pub tracking: Tracking,
    pub tracking_energy_error: Option<f64>,
}

/// The step of all axes.
pub(crate) fn report(state: &AxesState<'_>, errors: &Errors) -> StepReport {
    let axis = |axis: usize| AxisReport {
        command: state.target[axis],
        displacement: state.displacement[axis],
        velocity: Some(state.velocity[axis]),
        acceleration: Some(state.acceleration[axis]),
        force: state.force[axis],
    };
    StepReport {
        step: state.step,
        time: state.time,
        axes: (0..state.target.len()).map(axis).collect(),
        speed: None,
        energy_error: Some(errors.energy_error),
        tracking: Some(errors.tracking),
        tracking_energy_error: errors.tracking_energy_error,
    }
}
