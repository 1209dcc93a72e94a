//! A checked `unload`: the load is taken off until the specimen carries none.

use crate::formula::Formula;

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
