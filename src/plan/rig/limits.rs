//! The limits of a rig, and the intervals that express them. It enforces nothing: that is done by the guard.

use crate::schema::limits;
use psd_physics::tracking::monitor;
use psd_text::units::Dimension;

/// A closed interval in SI units. An absent bound is infinite, so that `low <= x && x <= high` is the whole test.
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

    /// Whether `x` is inside; NaN never is.
    #[must_use]
    #[inline]
    pub fn contains(self, x: f64) -> bool {
        self.low <= x && x <= self.high
    }

    /// The common part of both; empty (`low` above `high`) where they have none.
    #[must_use]
    pub fn intersection(self, other: Self) -> Self {
        Self {
            low: self.low.max(other.low),
            high: self.high.min(other.high),
        }
    }

    /// Whether it has a finite bound on either side.
    #[must_use]
    pub fn is_bounded(self) -> bool {
        self.low > f64::NEG_INFINITY || self.high < f64::INFINITY
    }
}

/// The limits that no command may exceed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Every target and every displacement reading \[m\].
    pub displacement: Interval,
    /// Every force reading \[N\].
    pub force: Interval,
    /// Speed of the actuator \[m/s\]; 0 ≤ speed ≤ high.
    pub speed: Interval,
    /// Largest change of target in one step, absolute value \[m\].
    pub increment: Interval,
    /// abs(measured − target) after settling \[m\].
    pub tracking_error: Interval,
    /// abs(energy error) over the input energy.
    pub energy_error: Interval,
    /// abs(tracking-error energy) over the input energy; without a bound the default applies.
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

    /// The limits that the guard enforces: the tracking-error energy always has one.
    #[must_use]
    pub fn held(&self) -> Self {
        Self {
            tracking_energy_error: self.held_tracking_energy_error(),
            ..*self
        }
    }

    /// The limit of the tracking-error energy, as a fraction of the input energy: that of the plan, else the default.
    #[must_use]
    pub fn held_tracking_energy_error(&self) -> Interval {
        if self.tracking_energy_error.is_bounded() {
            return self.tracking_energy_error;
        }
        Interval {
            low: 0.0,
            high: monitor::HOLD,
        }
    }

    /// Every limit, by the name of its field.
    #[must_use]
    pub const fn named(&self) -> [(&'static str, Interval, Dimension); 8] {
        [
            (
                limits::DISPLACEMENT.name,
                self.displacement,
                Dimension::LENGTH,
            ),
            (limits::FORCE.name, self.force, Dimension::FORCE),
            (limits::SPEED.name, self.speed, Dimension::VELOCITY),
            (limits::INCREMENT.name, self.increment, Dimension::LENGTH),
            (
                limits::TRACKING_ERROR.name,
                self.tracking_error,
                Dimension::LENGTH,
            ),
            (
                limits::ENERGY_ERROR.name,
                self.energy_error,
                Dimension::NUMBER,
            ),
            (
                limits::TRACKING_ENERGY_ERROR.name,
                self.tracking_energy_error,
                Dimension::NUMBER,
            ),
            (limits::NRMS_ERROR.name, self.nrms_error, Dimension::NUMBER),
        ]
    }
}
