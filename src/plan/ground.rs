//! The ground motion under a frame, and the damping of the frame.
//! In: numbers that `check` read from the plan and its data files. Out: SI numbers. It computes no motion.

use crate::formula::Formula;
use psd_physics::structure::Damping;

/// Most degrees of freedom of one frame: each has its own actuator and load cell.
pub const MOST_STOREYS: usize = 64;

/// The motion of the ground, from 0 s on.
#[derive(Clone, Debug, PartialEq)]
pub struct Ground {
    pub name: String,
    pub file: String,
    /// Scale factor of the record's numbers \[m/s²\], already in `accelerations`.
    pub unit: f64,
    /// Scale of the plan, already in `accelerations`.
    pub scale: f64,
    /// Relative standard uncertainty of the accelerations; 0 where none is stated.
    pub scale_uncertainty: f64,
    /// \[s\], from 0, increasing.
    pub times: Vec<f64>,
    /// \[m/s²\]
    pub accelerations: Vec<f64>,
}

impl Ground {
    /// Time of the last sample \[s\].
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// Shortest and longest time between two samples \[s\].
    #[must_use]
    pub fn spacing(&self) -> (f64, f64) {
        let spacings = self.times.windows(2).map(|pair| pair[1] - pair[0]);
        spacings.fold((f64::INFINITY, 0.0), |(low, high), spacing| {
            (low.min(spacing), high.max(spacing))
        })
    }

    /// Largest absolute acceleration \[m/s²\].
    #[must_use]
    pub fn peak(&self) -> f64 {
        self.accelerations
            .iter()
            .fold(0.0, |peak: f64, acceleration| peak.max(acceleration.abs()))
    }
}

/// Fractions of critical damping.
#[derive(Clone, Debug, PartialEq)]
pub enum ShakeDamping {
    /// C = a M + b K, with this ratio in the first two modes, or in the only mode of one storey.
    Rayleigh(Formula),
    /// A ratio for each mode, the longest period first.
    Modal(Vec<Formula>),
}

impl ShakeDamping {
    /// The ratios in the form that `physics` needs, if they are known before the run.
    #[must_use]
    pub fn known(&self) -> Option<Damping> {
        Some(match self {
            Self::Rayleigh(ratio) => rayleigh(ratio.constant()?),
            Self::Modal(ratios) => Damping::Modal(
                ratios
                    .iter()
                    .map(Formula::constant)
                    .collect::<Option<_>>()?,
            ),
        })
    }
}

/// Rayleigh damping with the same ratio in the first two modes; no damping if no ratio is given.
#[must_use]
pub fn rayleigh(ratio: f64) -> Damping {
    if ratio == 0.0 {
        Damping::None
    } else {
        Damping::rayleigh(ratio)
    }
}
