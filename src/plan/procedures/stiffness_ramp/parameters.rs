//! The fields of a `stiffness ramp`, declared once: its parameters here, its schema in `block.rs`, its reader in
//! `procedures::stiffness_ramp::check`. It fits nothing itself.

use crate::formula::Formula;
use crate::parameters;
pub use psd_physics::identification::multilinear_fit::BreakCount;
pub use psd_physics::relaxation::law::RelaxationLaw;
pub use psd_physics::relaxation::time_constant::RelaxationModel;

#[macro_export]
macro_rules! stiffness_ramp_fields {
    ($into:ident) => {
        $into! {
            /// Sec. 5 step 1: prescribed displacements, a dwell at each, the mean of several samples.
            #[derive(Clone, Debug)]
            struct StiffnessRamp {
                /// Index into `Plan::specimens`.
                specimen: usize = specimen(),
                /// \[m\]
                displacements: Vec<Formula> = quantities(Dimension::LENGTH, "targets in order")
                    .required("displacements = 0.1 mm .. 1 mm step 0.1 mm"),
                /// \[s\]
                pause: Formula = quantity(Dimension::TIME, "dwell at each target before the samples")
                    .or(0.0, "s")
                    .at_least_zero(),
                /// Readings averaged at each dwell, at least 1.
                samples: u32 = count(1.0, 1e5, "readings averaged at each target").or(1.0, ""),
                /// Number of repetitions of the whole ramp, at least 1.
                repeats: u32 = count(1.0, 1e5, "number of repetitions of the ramp").or(1.0, ""),
                /// Also returns to the start through the same displacements.
                return_path as "return": bool = choice(TRUTH, "returns through the same targets")
                    .default_in_words("false"),
                fit: RampFit = choice(FITS, "curve fitted to force against displacement").default_in_words("linear"),
                /// Readings during the dwells of the first repetition.
                relaxation: Option<WatchedHold> = choice(
                    RELAXATION_MODELS,
                    "relaxation law fitted to the forces in the pauses of the first repeat"
                )
                .default_in_words("nothing"),
                /// Actuator speed \[m/s\].
                speed: Option<Formula> = speed(),
            }
        }
    };
}

stiffness_ramp_fields!(parameters);

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
