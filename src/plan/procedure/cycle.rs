//! A checked `cycle`: reversed or one-sided cycles of displacement, amplitude by amplitude.

use crate::plan::BreakCount;
use crate::plan::formula::Formula;

/// Displacements of a specimen about one place, over and over.
#[derive(Clone, Debug)]
pub struct Cycle {
    /// Index into `Plan::specimens`.
    pub specimen: usize,
    /// In the order run, at least one.
    pub levels: Vec<Level>,
    pub sides: Sides,
    /// Where the amplitudes count from, m.
    pub about: Formula,
    /// Targets between `about` and an amplitude, the amplitude included.
    pub points: u32,
    /// Readings averaged at each target.
    pub samples: u32,
    /// s, at each target; with a rate only at the ends of the ways.
    pub pause: Formula,
    /// Actuator speed, m/s.
    pub speed: Option<Formula>,
    /// Hz: moved without stopping between the ends, and read at this rate. None: step and pause.
    pub rate: Option<Formula>,
    pub inspect: Vec<CycleInspection>,
    /// Of the curve that is fitted to the backbone.
    pub fit: Option<BreakCount>,
    /// The targets stand evenly, as older versions placed them; else closer together towards the turns.
    pub evenly: bool,
}

/// One amplitude and how often it is run.
#[derive(Clone, Debug)]
pub struct Level {
    /// m, above 0.
    pub amplitude: Formula,
    /// At least 1.
    pub cycles: u32,
}

/// To which sides of the middle a cycle goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// + then −.
    Both,
    /// + only.
    Push,
    /// − only.
    Pull,
}

/// When a person is asked to look, between two amplitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CycleInspection {
    /// After every so many amplitudes.
    Every(u32),
    /// The largest force of an amplitude is less by this fraction than the largest before.
    ForceDrop(f64),
}

/// Targets of one `cycle`, at most.
pub const MOST_TARGETS: f64 = 1e6;

impl Sides {
    /// The ends of one cycle about nought, in amplitudes: it begins and ends at 0.
    #[must_use]
    pub const fn ends(self) -> &'static [f64] {
        match self {
            Self::Both => &[1.0, -1.0, 0.0],
            Self::Push => &[1.0, 0.0],
            Self::Pull => &[-1.0, 0.0],
        }
    }

    /// Of each end, where the move to it begins and ends on the stretch from one turn of the actuator to the next, from 0 to 1.
    #[must_use]
    pub const fn stretches(self) -> &'static [[f64; 2]] {
        match self {
            Self::Both => &[[0.5, 1.0], [0.0, 1.0], [0.0, 0.5]],
            Self::Push | Self::Pull => &[[0.0, 1.0], [0.0, 1.0]],
        }
    }
}

impl Cycle {
    /// Cycles in all.
    #[must_use]
    pub fn cycles(&self) -> u64 {
        self.levels
            .iter()
            .map(|level| u64::from(level.cycles))
            .sum()
    }

    /// Targets in all, of step and pause.
    #[must_use]
    pub fn targets(&self) -> u64 {
        let quarters = if self.sides == Sides::Both { 4 } else { 2 };
        self.cycles() * quarters * u64::from(self.points)
    }
}
