//! The end of a step of a structure, with what its procedure keeps of it. In: the state of the structure. Out: its energy, and its report.

use crate::run::{AxisReport, StepReport};
use psd_physics::integrator::state::State;
use psd_physics::structure::matrix::Vector;
use psd_physics::tracking::monitor::Tracking;

/// The end of a step, which is kept with those before it.
pub(crate) trait EndOfStep {
    fn axes(&self) -> AxesState<'_>;

    /// Adds it to the results.
    fn sum_up(&mut self) -> Balance;

    /// Keeps it, with the tracking of each axis so far and the rig time \[s\].
    fn keep(&mut self, axes: &[Tracking], wall_time: f64);

    /// Whether a contact force acted in this step.
    fn is_struck(&self) -> bool;

    /// Steps of the procedure done before these.
    fn before(&self) -> u64 {
        0
    }
}

/// The energy of a test at the end of a step \[J\].
pub(crate) struct Balance {
    /// Energy error.
    pub error: f64,
    /// Reference of the relative errors.
    pub input: f64,
}

impl Balance {
    /// Energy error over its reference.
    pub(super) fn relative_error(&self) -> f64 {
        if self.error == 0.0 {
            0.0
        } else {
            self.error / self.input
        }
    }
}

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
    #[inline]
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

/// The errors of a step.
pub(crate) struct Errors {
    pub energy_error: f64,
    pub tracking: Tracking,
    pub tracking_energy_error: Option<f64>,
}

impl Errors {
    /// Sets the report of a step of all axes.
    pub(super) fn report(&self, state: &AxesState<'_>, report: &mut StepReport) {
        let axis = |axis: usize| AxisReport {
            command: state.target[axis],
            displacement: state.displacement[axis],
            velocity: Some(state.velocity[axis]),
            acceleration: Some(state.acceleration[axis]),
            force: state.force[axis],
        };
        (report.step, report.time) = (state.step, state.time);
        report.axes.clear();
        report.axes.extend((0..state.target.len()).map(axis));
        report.energy_error = Some(self.energy_error);
        report.tracking = Some(self.tracking);
        report.tracking_energy_error = self.tracking_energy_error;
    }
}
