//! What an unloading of a frame records: the floors after every move. In: numbers of a run, SI. It moves nothing.

use super::Floors;
use crate::mechanics::monitor::Tracking;

/// All floors after one move, from the ground up; step 0 is where the unloading began.
#[derive(Clone, Debug, PartialEq)]
pub struct UnloadStep {
    pub step: u64,
    /// Rig time, s.
    pub wall_time: f64,
    /// Targets, m.
    pub command: Vec<f64>,
    /// Measured, m.
    pub displacement: Vec<f64>,
    /// Measured, of each floor, N.
    pub restoring_force: Vec<f64>,
    /// Secant of each storey from the step before, N/m; None where it did not drift, and of a frame that has no storeys.
    pub tangent_stiffness: Vec<Option<f64>>,
}

/// Nothing is computed here: a place is where it was measured, a time the rig's.
impl Floors for UnloadStep {
    fn time(&self) -> f64 {
        self.wall_time
    }

    fn computed(&self) -> &[f64] {
        &self.displacement
    }

    fn restoring_force(&self) -> &[f64] {
        &self.restoring_force
    }

    fn command(&self) -> &[f64] {
        &self.command
    }

    fn measured(&self) -> &[f64] {
        &self.displacement
    }

    /// Of a recursion, and none runs.
    fn tracking(&self) -> &[Tracking] {
        &[]
    }
}

/// Where a specimen came to rest, floor by floor; one degree of freedom is one floor.
#[derive(Clone, Debug, PartialEq)]
pub struct Rest {
    /// Measured, m.
    pub displacement: Vec<f64>,
    /// What it still carries, N.
    pub force: Vec<f64>,
}

impl Rest {
    /// Place (m) and force (N) of one floor.
    #[must_use]
    pub fn of(&self, floor: usize) -> (f64, f64) {
        (self.displacement[floor], self.force[floor])
    }

    /// Drift of each storey, m.
    #[must_use]
    pub fn drift(&self) -> Vec<f64> {
        let mut drift = vec![0.0; self.displacement.len()];
        crate::mechanics::frame::drifts(&self.displacement, &mut drift);
        drift
    }

    /// Shear of each storey, N.
    #[must_use]
    pub fn shear(&self) -> Vec<f64> {
        let mut shear = vec![0.0; self.force.len()];
        crate::mechanics::frame::shears(&self.force, &mut shear);
        shear
    }

    /// The place farthest out, m, and the largest force left, N, each with its sign.
    #[must_use]
    pub fn largest(&self) -> (f64, f64) {
        let most = |values: &[f64]| values.iter().copied().reduce(|most, next| if next.abs() > most.abs() { next } else { most });
        (most(&self.displacement).unwrap_or(0.0), most(&self.force).unwrap_or(0.0))
    }
}
