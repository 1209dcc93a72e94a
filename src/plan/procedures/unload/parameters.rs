//! A checked `unload`: the load is removed until the specimen carries zero force. One degree of freedom or a frame.

use crate::formula::Formula;

/// Moves to the position of zero restoring force; all floors or elements of a frame move together.
#[derive(Clone, Debug)]
pub struct Unload {
    /// Index into `Plan::specimens`.
    pub specimen: usize,
    /// The stiffness with which the force is expected to decrease \[N/m\]; the readings correct it. None for a frame, whose storeys
    /// have their own.
    pub stiffness: Option<Formula>,
    /// Largest abs(R), of a frame on a floor or element, that counts as zero \[N\]. None: the largest force that the readings cannot distinguish from zero.
    pub within: Option<Formula>,
    /// \[m/s\], of the floor with the longest move.
    pub speed: Option<Formula>,
    /// Whether the axial load of a `preload` stays on.
    pub keep_axial_load: bool,
}
