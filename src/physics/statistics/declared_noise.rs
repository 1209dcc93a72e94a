//! The errors of a reading that an instrument declares. In: numbers in SI. Out: data. It knows no instrument.

use serde::{Deserialize, Serialize};

/// Errors of a reading that are known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DeclaredNoise {
    /// Standard deviation of a force \[N\].
    pub force: f64,
    /// Resolution of a displacement \[m\].
    pub resolution: f64,
}

impl DeclaredNoise {
    /// Exact readings.
    pub const NONE: Self = Self {
        force: 0.0,
        resolution: 0.0,
    };
}
