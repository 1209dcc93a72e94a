//! Checked identification procedures: a `stiffness ramp`. In: formulas from the check. Out: what is moved, read
//! and fitted. It fits nothing itself.

pub use crate::physics::identification::multilinear_fit::BreakCount;
pub use crate::physics::relaxation::law::RelaxationLaw;
pub use crate::physics::relaxation::time_constant::RelaxationModel;
use crate::plan::formula::Formula;

/// Sec. 5 step 1: prescribed displacements, a pause at each, the mean of some samples.
#[derive(Clone, Debug)]
pub struct StiffnessRamp {
    /// Index into `Plan::specimens`.
    pub specimen: usize,
    /// m
    pub displacements: Vec<Formula>,
    /// s
    pub pause: Formula,
    /// Readings averaged at each pause, at least 1.
    pub samples: u32,
    /// Times the whole ramp is run, at least 1.
    pub repeats: u32,
    /// Also back to the start through the same displacements.
    pub return_path: bool,
    pub fit: RampFit,
    /// Readings during the pauses of the first repeat.
    pub relaxation: Option<WatchedHold>,
    /// Actuator speed, m/s.
    pub speed: Option<Formula>,
}

impl StiffnessRamp {
    /// Outward steps that the fit is of, and degrees of freedom of their scatter about it; None where there is no fit of so few, or
    /// its numbers are not known before the run.
    #[must_use]
    pub fn degrees_of_freedom(&self) -> Option<(usize, usize)> {
        let of_first = self.displacements.len();
        let (points, numbers) = match self.fit {
            RampFit::Linear => (of_first * self.repeats as usize, 2),
            RampFit::Bilinear => (of_first, 4),
            RampFit::Multilinear(BreakCount::Exactly(breaks)) => (of_first, 2 * breaks + 2),
            RampFit::Multilinear(BreakCount::ByCriterion { .. }) => return None,
        };
        points
            .checked_sub(numbers)
            .filter(|degrees| *degrees > 0)
            .map(|degrees| (points, degrees))
    }
}

/// How the force is watched while it relaxes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WatchedHold {
    pub model: WatchedModel,
    /// In a pause, after the first.
    pub readings: u32,
}

/// What is fitted to the force while it relaxes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WatchedModel {
    /// A force that comes to rest. `accuracy` (N) is how near to that the force is to be known; None: the noise of the rig's cell, if it
    /// declares one.
    Decay {
        model: RelaxationModel,
        accuracy: Option<f64>,
    },
    /// A share of what is reached is lost by a law; None: by the one that the readings prefer. `rate` (N/s) is how fast a pause may still
    /// lose at its end.
    Reached {
        law: Option<RelaxationLaw>,
        rate: f64,
    },
}

/// What is fitted to force on displacement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RampFit {
    Linear,
    /// Two lines that meet.
    Bilinear,
    Multilinear(BreakCount),
}
