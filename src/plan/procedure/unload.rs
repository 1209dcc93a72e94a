//! A checked `unload`: the load is taken off until the specimen carries none, of one degree of freedom or of a frame.

use crate::plan::formula::Formula;

/// Moves to where the restoring force is 0, whatever displacement that is.
#[derive(Clone, Debug)]
pub struct Unload {
    /// Index into `Plan::specimens`.
    pub specimen: usize,
    /// With which the force is expected to fall, N/m; the readings correct it.
    pub stiffness: Formula,
    /// Largest |R| that counts as none, N. None: what the readings can tell from none.
    pub within: Option<Formula>,
    /// m/s
    pub speed: Option<Formula>,
}

/// The same of a frame: all floors move together to where none of them carries a load. With which stiffness its forces are
/// expected to fall, its storeys say.
#[derive(Clone, Debug)]
pub struct FrameUnload {
    /// Index into `Plan::specimens`; it has a frame.
    pub specimen: usize,
    /// Largest |R| of a floor that counts as none, N. None: what the readings can tell from none.
    pub within: Option<Formula>,
    /// m/s, of the floor that goes farthest.
    pub speed: Option<Formula>,
}
