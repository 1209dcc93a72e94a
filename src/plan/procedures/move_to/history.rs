//! The history of a move: its steps. In: numbers of a run, SI. It moves nothing.

/// One increment of a move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoveStep {
    pub step: u64,
    /// Rig time \[s\].
    pub wall_time: f64,
    /// Target \[m\].
    pub command: f64,
    /// Measured \[m\].
    pub displacement: f64,
    /// Measured \[N\].
    pub restoring_force: f64,
    /// Secant from the previous step \[N/m\]; None for the first step, and without a change of displacement.
    pub tangent_stiffness: Option<f64>,
}
