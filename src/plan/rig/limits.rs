//! What nothing may drive the rig past, and the intervals it is said in. In: SI. It knows neither who is held to it nor how: that is the
//! guard's.

use crate::physics::tracking::monitor;
use crate::units::Dimension;

/// Closed intervals (SI); an absent bound is infinite, so that `lo <= x && x <= hi` is the whole test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    pub low: f64,
    pub high: f64,
}

impl Interval {
    pub const ALL: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    /// Whether `x` lies inside; NaN never does.
    #[must_use]
    pub fn contains(self, x: f64) -> bool {
        self.low <= x && x <= self.high
    }

    /// What lies in both; empty (`low` above `high`) where nothing does.
    #[must_use]
    pub fn intersection(self, other: Self) -> Self {
        Self {
            low: self.low.max(other.low),
            high: self.high.min(other.high),
        }
    }

    /// Whether it ends on either side.
    #[must_use]
    pub fn is_bounded(self) -> bool {
        self.low > f64::NEG_INFINITY || self.high < f64::INFINITY
    }
}

/// What nothing may drive the rig past.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// m, of every target and every reading.
    pub displacement: Interval,
    /// N, of every reading.
    pub force: Interval,
    /// m/s, of the actuator; 0 ≤ speed ≤ high.
    pub speed: Interval,
    /// m, largest change of target in one step, by size.
    pub increment: Interval,
    /// m, |measured − target| after settling.
    pub tracking_error: Interval,
    /// |energy error| over the input energy.
    pub energy_error: Interval,
    /// |energy error of tracking| over the input energy; where it bounds nothing, the default holds.
    pub tracking_energy_error: Interval,
    /// Root mean square of the tracking error over that of the command.
    pub nrms_error: Interval,
}

impl Limits {
    pub const NONE: Self = Self {
        displacement: Interval::ALL,
        force: Interval::ALL,
        speed: Interval::ALL,
        increment: Interval::ALL,
        tracking_error: Interval::ALL,
        energy_error: Interval::ALL,
        tracking_energy_error: Interval::ALL,
        nrms_error: Interval::ALL,
    };

    /// As the guard holds them: what tracking does to the energy has a limit always.
    #[must_use]
    pub fn held(&self) -> Self {
        if self.tracking_energy_error.is_bounded() {
            return *self;
        }
        Self {
            tracking_energy_error: Interval {
                low: 0.0,
                high: monitor::HOLD,
            },
            ..*self
        }
    }

    /// Every limit by the name of its field.
    #[must_use]
    pub const fn named(&self) -> [(&'static str, Interval, Dimension); 8] {
        [
            ("displacement", self.displacement, Dimension::LENGTH),
            ("force", self.force, Dimension::FORCE),
            ("speed", self.speed, Dimension::VELOCITY),
            ("increment", self.increment, Dimension::LENGTH),
            ("tracking_error", self.tracking_error, Dimension::LENGTH),
            ("energy_error", self.energy_error, Dimension::NUMBER),
            (
                "tracking_energy_error",
                self.tracking_energy_error,
                Dimension::NUMBER,
            ),
            ("nrms_error", self.nrms_error, Dimension::NUMBER),
        ]
    }
}
