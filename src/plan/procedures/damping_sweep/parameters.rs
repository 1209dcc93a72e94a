//! The parameters of a `damping sweep`, in SI.

use crate::formula::Formula;

/// Constant-velocity passes at increasing velocities (Melo et al. 2006, sec. 6 (b)).
#[derive(Clone, Debug)]
pub struct DampingSweep {
    /// Index into `Plan::specimens`.
    pub specimen: usize,
    /// \[m/s\]
    pub velocities: Vec<Formula>,
    /// \[m\]
    pub stroke: Formula,
    /// The middle of the passes \[m\]. None: they begin at the present position of the actuator.
    pub about: Option<Formula>,
    /// K of F_d = R − K·X \[N/m\].
    pub stiffness: Formula,
    /// Sampling rate \[Hz\]. None: at least 50 samples in the steady part of each ramp.
    pub rate: Option<Formula>,
}
