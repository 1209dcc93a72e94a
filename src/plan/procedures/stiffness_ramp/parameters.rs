//! The parameters of a `stiffness ramp`, in SI. It fits nothing itself.

use crate::formula::Formula;
pub use psd_physics::identification::multilinear_fit::BreakCount;
pub use psd_physics::relaxation::law::RelaxationLaw;
pub use psd_physics::relaxation::time_constant::RelaxationModel;

/// Sec. 5 step 1: prescribed displacements, a dwell at each, the mean of several samples.
#[derive(Clone, Debug)]
pub struct StiffnessRamp {
    /// Index into `Plan::specimens`.
    pub specimen: usize,
    /// \[m\]
    pub displacements: Vec<Formula>,
    /// \[s\]
    pub pause: Formula,
    /// Readings averaged at each dwell, at least 1.
    pub samples: u32,
    /// Number of repetitions of the whole ramp, at least 1.
    pub repeats: u32,
    /// Also returns to the start through the same displacements.
    pub return_path: bool,
    pub fit: RampFit,
    /// Readings during the dwells of the first repetition.
    pub relaxation: Option<WatchedHold>,
    /// Actuator speed \[m/s\].
    pub speed: Option<Formula>,
}

impl StiffnessRamp {
    /// Number of targets, on all its paths out and back.
    #[must_use]
    pub const fn targets(&self) -> u64 {
        let paths = if self.return_path { 2 } else { 1 };
        self.displacements.len() as u64 * paths * self.repeats as u64
    }

    /// Number of outward steps in the fit, and degrees of freedom of their scatter about it. None if they are too few for a fit or not
    /// known before the run.
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

/// How the force is observed during relaxation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WatchedHold {
    pub model: WatchedModel,
    /// Number of readings in a dwell after the first reading.
    pub readings: u32,
}

/// The function that is fitted to the relaxing force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WatchedModel {
    /// A force that reaches a final value. `accuracy` \[N\] is the required uncertainty of that value; None: the noise of the rig's cell,
    /// if it declares one.
    Decay {
        model: RelaxationModel,
        accuracy: Option<f64>,
    },
    /// A fraction of the instantaneous force relaxes by a function of time; None: the function that fits the readings best. `rate`
    /// \[N/s\] is the largest relaxation rate allowed at the end of a dwell.
    Reached {
        law: Option<RelaxationLaw>,
        rate: f64,
    },
}

/// The function that is fitted to force against displacement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RampFit {
    Linear,
    /// Two lines that intersect.
    Bilinear,
    Multilinear(BreakCount),
}
