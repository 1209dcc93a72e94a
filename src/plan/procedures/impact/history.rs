//! The history of an impact, on one degree of freedom or on a floor of a frame: one row per step.

use crate::record::{StepState, StruckFrame};
use psd_physics::impact::energy::Energies;
use psd_physics::impact::summary::ImpactEnding;
use psd_physics::tracking::monitor::Tracking;

/// One row of an impact's table; step 0 is the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactStep {
    pub step: u64,
    /// Simulated time \[s\].
    pub time: f64,
    /// Rig time \[s\].
    pub wall_time: f64,
    pub state: StepState,
    /// Commanded to the actuator \[m\].
    pub command: f64,
    /// Computed displacement X \[m\]: the command; under α-OS the command corrected by the force read there.
    pub computed: f64,
    /// Measured \[m\].
    pub displacement: f64,
    pub velocity: f64,
    pub acceleration: f64,
    pub restoring_force: f64,
    /// Mean over the step \[N\]; zero at step 0.
    pub contact_force: f64,
    pub striker_displacement: f64,
    pub striker_velocity: f64,
    pub tangent_stiffness: f64,
    /// Permanent \[m\].
    pub indentation: f64,
    pub energies: Energies,
    /// The tracking errors.
    pub tracking: Tracking,
}

/// An impact, step by step: on one degree of freedom, or on one floor of a frame.
#[derive(Clone, Debug)]
pub struct ImpactHistory {
    /// The striker and the struck point. For a frame: the struck floor and storey, with the energies of the whole frame and
    /// the tracking of all axes together.
    pub steps: Vec<ImpactStep>,
    pub ending: ImpactEnding,
    /// None for one degree of freedom.
    pub frame: Option<StruckFrame>,
    /// \[s\]
    pub time_step: f64,
    /// \[s\]
    pub critical_time_step: f64,
}
