//! Noise and resolution of the readings, as the rig declares them.

use serde::{Deserialize, Serialize};

/// Declared properties of the readings of a rig.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct DeclaredNoise {
    /// \[N\]
    pub force: f64,
    /// \[m\]
    pub resolution: f64,
}
