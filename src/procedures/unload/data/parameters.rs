//! A checked `unload`: the load is removed until the specimen carries zero force. One degree of freedom or a frame.

use crate::plan::formula::Formula;

/// Moves to the position of zero restoring force.
#[derive(Clone, Debug)]
pub struct Unload {
    /// Index into `Plan::specimens`.
    pub specimen: usize,
    /// The stiffness with which the force is expected to decrease \[N/m\]; the readings correct it.
    pub stiffness: Formula,
    /// Largest abs(R) that counts as zero \[N\]. None: the largest force that the readings cannot distinguish from zero.
    pub within: Option<Formula>,
    /// \[m/s\]
    pub speed: Option<Formula>,
}

/// The same for a frame: all floors move together to positions of zero load. The storeys give the stiffness with which the forces are
/// expected to decrease.
#[derive(Clone, Debug)]
pub struct FrameUnload {
    /// Index into `Plan::specimens`; it has a frame.
    pub specimen: usize,
    /// Largest abs(R) of a floor that counts as zero \[N\]. None: the largest force that the readings cannot distinguish from zero.
    pub within: Option<Formula>,
    /// Speed of the floor with the longest move \[m/s\].
    pub speed: Option<Formula>,
}
