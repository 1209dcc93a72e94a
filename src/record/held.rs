//! The changes of force and displacement while the rig held its position.

/// What the holds of a run tell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Held {
    /// Holds that were long enough to tell a slope.
    pub count: u64,
    /// s
    pub longest: f64,
    /// Of each axis, the fastest by size: N/s and m/s.
    pub slopes: Vec<(f64, f64)>,
    /// Largest growth of the force in one of them, away from the start, farther out than ever before, N. None: no such hold.
    pub grown: Option<f64>,
}
