//! Facts that the guard reports about its rig: declared noise, datum, first reading. It moves nothing.

use crate::{DeclaredNoise, Guard, LineStatistics};

impl Guard<'_> {
    #[must_use]
    pub fn declared_noise(&self) -> DeclaredNoise {
        self.rig.declared_noise()
    }

    /// Communication errors recovered so far.
    #[must_use]
    pub fn line_statistics(&self) -> LineStatistics {
        self.rig.line_statistics()
    }

    /// The position of the plan's zero in the rig's own coordinate \[m\], one per axis, if the rig has one.
    #[must_use]
    pub fn datum(&self) -> Option<Vec<f64>> {
        self.rig.datum()
    }

    /// The first reading: displacements \[m\] and forces \[N\].
    #[must_use]
    pub fn found(&self) -> (&[f64], &[f64]) {
        (&self.found.0, &self.found.1)
    }

    /// Speed of a move without a requested speed \[m/s\]; None: the highest speed that the limits allow.
    #[must_use]
    pub fn own_speed(&self) -> Option<f64> {
        self.rig.own_speed()
    }
}
