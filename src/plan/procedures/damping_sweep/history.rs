//! The history of a damping sweep: one row per reading, and the fit of its pairs.

use crate::record::LineFit;

/// One reading of a damping sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepStep {
    pub step: u64,
    /// Rig time \[s\].
    pub wall_time: f64,
    /// Commanded velocity, signed \[m/s\].
    pub velocity: f64,
    /// \[m\]
    pub displacement: f64,
    /// \[N\]
    pub restoring_force: f64,
    /// F_d = R − K·X, N.
    pub damping_force: f64,
    /// Whether it is in the steady part, which the fit uses.
    pub steady: bool,
}

/// A damping sweep, reading by reading, and the line through its pairs.
#[derive(Clone, Debug)]
pub struct DampingSweepHistory {
    pub steps: Vec<SweepStep>,
    /// The data of the fit: velocity \[m/s\], and half the difference of `F_d` \[N\] between the two directions at one
    /// position.
    pub pairs: Vec<(f64, f64)>,
    pub together: BroughtTogether,
    /// K of the passes and its standard error \[N/m\], if it contradicts the K above. The damping ratio is then reported with it.
    pub own_stiffness: Option<(f64, f64)>,
    /// F_d = intercept·sign v + slope·v: intercept is the Coulomb force.
    pub fit: Option<LineFit>,
}

/// Correction of the two readings of each pair of a sweep to one position, because they differ with a lagging actuator.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BroughtTogether {
    /// K of the passes \[N/m\]; that of the plan if the passes do not determine it.
    pub stiffness: f64,
    /// Its standard error \[N/m\]; None for the K of the plan.
    pub error: Option<f64>,
    /// ∂c/∂K \[s\] and ∂F_c/∂K \[m\]: 0 if the positions of all pairs agree.
    pub effects: [f64; 2],
}
