//! The parameters of a `preload`, in SI.

/// The axial axis of a storey loads it and holds the force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preload {
    /// From 0.
    pub storey: usize,
    /// On the specimen on the rig \[N\].
    pub force: f64,
}
