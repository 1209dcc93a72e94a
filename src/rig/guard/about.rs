//! What the guard tells of its rig: what it declares, where its zero lies, where it was found. It moves nothing.

use crate::rig::{DeclaredNoise, Guard, Tally};

impl Guard<'_> {
    #[must_use]
    pub fn declared_noise(&self) -> DeclaredNoise {
        self.rig.declared_noise()
    }

    /// What was mended on the lines of the rig so far.
    #[must_use]
    pub fn tally(&self) -> Tally {
        self.rig.tally()
    }

    /// Where the plan's zero lies in the rig's own coordinate, m, one an axis, where the rig has one.
    #[must_use]
    pub fn datum(&self) -> Option<Vec<f64>> {
        self.rig.datum()
    }

    /// What was read first: displacements, m, and forces, N.
    #[must_use]
    pub fn found(&self) -> (&[f64], &[f64]) {
        (&self.found.0, &self.found.1)
    }

    /// Speed of a move for which none is asked, m/s; None: as fast as the limits allow.
    #[must_use]
    pub fn own_speed(&self) -> Option<f64> {
        self.rig.own_speed()
    }
}
