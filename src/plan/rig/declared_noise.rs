//! Noise and resolution of the readings of a rig, as it declares them.

use serde::{Deserialize, Serialize};

/// What the rig declares of its readings.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct DeclaredNoise {
    /// N
    pub force: f64,
    /// m
    pub resolution: f64,
}
