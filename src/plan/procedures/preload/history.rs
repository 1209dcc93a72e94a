//! The history of an axial load: one entry for each reading of each axial axis, during every procedure. In: numbers of a run, SI. It
//! moves nothing.

/// An axial axis at one reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxialReading {
    /// From 1.
    pub storey: u64,
    /// Rig time \[s\].
    pub wall_time: f64,
    /// Target of the force \[N\].
    pub target: f64,
    /// Measured \[N\].
    pub force: f64,
    /// Measured \[m\].
    pub displacement: f64,
}
