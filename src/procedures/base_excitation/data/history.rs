//! The history of a frame under ground motion: one row per step, for all floors.

use crate::physics::tracking::monitor::Tracking;
use crate::record::{Floors, FloorsAt, FrameEnergies, Modes};

/// One row of a ground-motion test for all floors; step 0 is the start. Displacements are relative to the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct ShakeStep {
    pub step: u64,
    /// Simulated time \[s\].
    pub time: f64,
    /// Rig time \[s\].
    pub wall_time: f64,
    /// \[m/s²\], as applied.
    pub ground_acceleration: f64,
    /// Targets \[m\].
    pub command: Vec<f64>,
    /// Measured \[m\].
    pub displacement: Vec<f64>,
    /// Computed X \[m\]: the target, except under α-OS.
    pub computed: Vec<f64>,
    /// \[m/s\]
    pub velocity: Vec<f64>,
    /// \[m/s²\]
    pub acceleration: Vec<f64>,
    /// Measured, of each floor \[N\].
    pub restoring_force: Vec<f64>,
    pub energies: FrameEnergies,
    /// For each axis.
    pub tracking: Vec<Tracking>,
}

impl Floors for ShakeStep {
    fn at(&self) -> FloorsAt<'_> {
        FloorsAt {
            time: self.time,
            command: &self.command,
            measured: &self.displacement,
            computed: &self.computed,
            velocity: &self.velocity,
            acceleration: &self.acceleration,
            restoring_force: &self.restoring_force,
            tracking: &self.tracking,
        }
    }
}

/// A frame under ground motion, step by step.
#[derive(Clone, Debug, Default)]
pub struct ShakeHistory {
    pub steps: Vec<ShakeStep>,
    /// None if the procedure did not begin.
    pub modes: Option<Modes>,
    /// Fraction of critical damping of each mode.
    pub damping_ratios: Vec<f64>,
    /// \[s\]
    pub time_step: f64,
    /// \[s\]
    pub critical_time_step: f64,
}
