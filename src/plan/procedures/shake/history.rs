//! The history of a frame under ground motion: one row per step, for all floors.

use crate::record::{FloorMotion, Floors, FloorsAt, FrameEnergies, Modes};

/// One row of a ground-motion test for all floors; step 0 is the start. Displacements are relative to the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct ShakeStep {
    pub step: u64,
    /// Rig time \[s\].
    pub wall_time: f64,
    /// \[m/s²\], as applied.
    pub ground_acceleration: f64,
    pub floors: FloorMotion,
    pub energies: FrameEnergies,
}

impl Floors for ShakeStep {
    fn at(&self) -> FloorsAt<'_> {
        self.floors.at()
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
    /// The storey, from 0, whose drift ended the run before its duration.
    pub drift_reached: Option<usize>,
    /// \[s\]
    pub critical_time_step: f64,
}
