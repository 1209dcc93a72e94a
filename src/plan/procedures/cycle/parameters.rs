//! A checked `cycle`: reversed or one-sided cycles of displacement, amplitude by amplitude.

use crate::BreakCount;
use crate::formula::Formula;

/// Repeated displacement cycles of a specimen about one position.
#[derive(Clone, Debug)]
pub struct Cycle {
    /// Index into `Plan::specimens`.
    pub specimen: usize,
    /// In the order of execution, at least one.
    pub levels: Vec<Level>,
    pub sides: Sides,
    /// The position from which the amplitudes are measured \[m\].
    pub about: Formula,
    /// Targets between `about` and an amplitude, the amplitude included; they are closer together near the reversal points.
    pub points: u32,
    /// Readings averaged at each target.
    pub samples: u32,
    /// Dwell \[s\] at each target; with a rate only at the reversal points.
    pub pause: Formula,
    /// Actuator speed \[m/s\].
    pub speed: Option<Formula>,
    /// Sampling rate \[Hz\]: the actuator moves without stopping between the reversal points. None: ramp-and-hold.
    pub rate: Option<Formula>,
    pub inspect: Vec<CycleInspection>,
    /// For the curve that is fitted to the backbone.
    pub fit: Option<BreakCount>,
}

/// One amplitude and its number of cycles.
#[derive(Clone, Debug)]
pub struct Level {
    /// \[m\], above 0.
    pub amplitude: Formula,
    /// At least 1.
    pub cycles: u32,
}

/// The directions of a cycle from its middle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// + then −.
    Both,
    /// + only.
    Push,
    /// − only.
    Pull,
}

/// When the operator is asked to inspect the specimen, between two amplitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CycleInspection {
    /// After every n amplitudes.
    Every(u32),
    /// The largest force of an amplitude is smaller by this fraction than the largest force before it.
    ForceDrop(f64),
}

/// Largest number of targets of one `cycle`.
pub const MOST_TARGETS: f64 = 1e6;

impl Sides {
    /// The end points of the moves of one cycle about zero, in amplitudes: the cycle begins and ends at 0.
    #[must_use]
    pub const fn ends(self) -> &'static [f64] {
        match self {
            Self::Both => &[1.0, -1.0, 0.0],
            Self::Push => &[1.0, 0.0],
            Self::Pull => &[-1.0, 0.0],
        }
    }

    /// For each of these end points, the start and end of the move to it, as fractions (0 to 1) of the path between two reversals.
    #[must_use]
    pub const fn stretches(self) -> &'static [[f64; 2]] {
        match self {
            Self::Both => &[[0.5, 1.0], [0.0, 1.0], [0.0, 0.5]],
            Self::Push | Self::Pull => &[[0.0, 1.0], [0.0, 1.0]],
        }
    }
}

impl Cycle {
    /// Total number of cycles.
    #[must_use]
    pub fn cycles(&self) -> u64 {
        self.levels
            .iter()
            .map(|level| u64::from(level.cycles))
            .sum()
    }

    /// Total number of targets with ramp-and-hold.
    #[must_use]
    pub fn targets(&self) -> u64 {
        let quarters = if self.sides == Sides::Both { 4 } else { 2 };
        self.cycles() * quarters * u64::from(self.points)
    }
}
