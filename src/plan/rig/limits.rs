//! The limits of a rig, declared once: the parameters here, the schema in `schema::limits`, the reader in
//! `language::check::declarations::limits`; and the intervals that express them. It enforces nothing: that is done by the guard.

use crate::{names, parameters};
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

#[macro_export]
macro_rules! limits_fields {
    ($into:ident) => {
        $into! {
            /// The limits that no command may exceed.
            #[derive(Clone, Copy, Debug, PartialEq)]
            struct Limits {
                /// Every target and every displacement reading \[m\].
                displacement: Interval = bounds(Dimension::LENGTH, true, "displacement of all targets and readings"),
                /// Every force reading \[N\].
                force: Interval = bounds(Dimension::FORCE, true, "force of all readings"),
                /// Speed of the actuator \[m/s\]; 0 ≤ speed ≤ high.
                speed: Interval = bounds(Dimension::VELOCITY, false, "speed of the actuator"),
                /// Largest change of target in one step, absolute value \[m\].
                increment: Interval = bounds(Dimension::LENGTH, false, "largest change of the target in one step"),
                /// abs(measured − target) after settling \[m\].
                tracking_error: Interval =
                    bounds(Dimension::LENGTH, false, "absolute tracking error after settling"),
                /// abs(energy error) over the input energy.
                energy_error: Interval =
                    bounds(Dimension::NUMBER, false, "absolute energy error relative to the input energy"),
                /// abs(tracking-error energy) over the input energy; without a bound the default applies.
                tracking_energy_error: Interval = bounds(
                    Dimension::NUMBER,
                    false,
                    "absolute tracking-error energy relative to the input energy"
                )
                .default_in_words("5 %"),
                /// Root mean square of the tracking error over that of the command.
                nrms_error: Interval =
                    bounds(Dimension::NUMBER, false, "rms tracking error relative to rms command, of the run"),
            }
        }
    };
}

limits_fields!(parameters);
limits_fields!(names);

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

    /// Every limit, by the name of its field.
    #[must_use]
    pub const fn named(&self) -> [(&'static str, Interval, Dimension); 8] {
        [
            (NAMES.displacement, self.displacement, Dimension::LENGTH),
            (NAMES.force, self.force, Dimension::FORCE),
            (NAMES.speed, self.speed, Dimension::VELOCITY),
            (NAMES.increment, self.increment, Dimension::LENGTH),
            (NAMES.tracking_error, self.tracking_error, Dimension::LENGTH),
            (NAMES.energy_error, self.energy_error, Dimension::NUMBER),
            (
                NAMES.tracking_energy_error,
                self.tracking_energy_error,
                Dimension::NUMBER,
            ),
            (NAMES.nrms_error, self.nrms_error, Dimension::NUMBER),
        ]
    }
}
