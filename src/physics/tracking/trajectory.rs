//! A smooth trajectory of an actuator: Hermite's cubic between two positions with a velocity each. In: the ends and the time between
//! them. Out: position, velocity and acceleration at any time, peaks in closed form.

use crate::statistics::samples::peak;
use serde::{Deserialize, Serialize};

/// Hermite's cubic, in laboratory time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Path {
    /// \[m\]
    pub from: f64,
    /// \[m\]
    pub to: f64,
    /// \[m/s\]
    pub start_velocity: f64,
    /// \[m/s\]
    pub end_velocity: f64,
    /// \[s\]
    pub seconds: f64,
}

/// Velocity of a path at an instant, and its derivatives: m/s, m/s², m/s³.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rate {
    pub velocity: f64,
    pub acceleration: f64,
    pub jerk: f64,
}

/// Motion of an actuator at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActuatorMotion {
    /// \[m\]
    pub position: f64,
    /// \[m/s\]
    pub velocity: f64,
    /// \[m/s²\]
    pub acceleration: f64,
}

impl Path {
    /// From a motion on at its acceleration, for `seconds`.
    #[must_use]
    pub fn accelerated(start: ActuatorMotion, seconds: f64) -> Self {
        let end_velocity = start.velocity + start.acceleration * seconds;
        Self {
            from: start.position,
            to: start.position + 0.5 * (start.velocity + end_velocity) * seconds,
            start_velocity: start.velocity,
            end_velocity,
            seconds,
        }
    }

    /// \[m\]
    #[must_use]
    pub fn position(&self, time: f64) -> f64 {
        if time >= self.seconds {
            return self.to;
        }
        let Rate {
            velocity,
            acceleration,
            jerk,
        } = self.at_start();
        self.from + time * (velocity + time * (0.5 * acceleration + time * jerk / 6.0))
    }

    /// Velocity \[m/s\], acceleration \[m/s²\] and jerk (m/s³) `time` \[s\] after its start.
    #[must_use]
    pub fn rate(&self, time: f64) -> Rate {
        let Rate {
            velocity,
            acceleration,
            jerk,
        } = self.at_start();
        let ends = time >= self.seconds;
        Rate {
            velocity: if ends {
                self.end_velocity
            } else {
                velocity + time * (acceleration + 0.5 * time * jerk)
            },
            acceleration: acceleration + time * jerk,
            jerk,
        }
    }

    /// Peak speed \[m/s\]: at an end, or where the acceleration is zero.
    #[must_use]
    pub fn fastest(&self) -> f64 {
        let Rate {
            acceleration, jerk, ..
        } = self.at_start();
        let extremum = -acceleration / jerk;
        let inside = if extremum > 0.0 && extremum < self.seconds {
            self.rate(extremum).velocity.abs()
        } else {
            0.0
        };
        inside
            .max(self.start_velocity.abs())
            .max(self.end_velocity.abs())
    }

    /// Lowest and highest position \[m\]: at the ends, or where the velocity is zero.
    #[must_use]
    pub fn reach(&self) -> (f64, f64) {
        let Rate {
            velocity,
            acceleration,
            jerk,
        } = self.at_start();
        let (mut low, mut high) = (self.from.min(self.to), self.from.max(self.to));
        // ½jerk·t² + acceleration·t + velocity = 0, in the form that no cancellation spoils.
        let root = (acceleration * acceleration - 2.0 * jerk * velocity)
            .max(0.0)
            .sqrt();
        let sum = -(acceleration + root.copysign(acceleration));
        for reversal in [sum / jerk, 2.0 * velocity / sum] {
            if reversal > 0.0 && reversal < self.seconds {
                let position = self.position(reversal);
                (low, high) = (low.min(position), high.max(position));
            }
        }
        (low, high)
    }

    fn at_start(&self) -> Rate {
        let Self {
            from,
            to,
            start_velocity,
            end_velocity,
            seconds,
        } = *self;
        let chord = (to - from) / seconds;
        Rate {
            velocity: start_velocity,
            acceleration: (6.0 * chord - 4.0 * start_velocity - 2.0 * end_velocity) / seconds,
            jerk: (6.0 * (start_velocity + end_velocity) - 12.0 * chord) / (seconds * seconds),
        }
    }
}

/// Longest travel of an axis from one position of all axes to another \[m\].
#[must_use]
pub fn longest_travel(from: &[f64], to: &[f64]) -> f64 {
    peak(from.iter().zip(to).map(|(from, to)| to - from))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBIC: Path = Path {
        from: 1.0,
        to: 2.0,
        start_velocity: -1.0,
        end_velocity: 0.5,
        seconds: 2.0,
    };

    #[test]
    fn a_path_has_the_ends_it_was_given() {
        assert_eq!((CUBIC.position(0.0), CUBIC.rate(0.0).velocity), (1.0, -1.0));
        let near = CUBIC.seconds * (1.0 - 1e-12);
        assert!(
            (CUBIC.position(near) - 2.0).abs() < 1e-11
                && (CUBIC.rate(near).velocity - 0.5).abs() < 1e-11
        );
    }

    #[test]
    fn extremes_are_those_of_a_fine_sampling() {
        let jerky = Path {
            from: 0.0,
            to: 0.0,
            start_velocity: 1.0,
            end_velocity: 1.0,
            seconds: 1.0,
        };
        let even = Path {
            from: 0.0,
            to: 3.0,
            start_velocity: 1.0,
            end_velocity: 1.0,
            seconds: 3.0,
        };
        let back = Path::accelerated(
            ActuatorMotion {
                position: 0.0,
                velocity: 1.0,
                acceleration: -2.0,
            },
            1.5,
        );
        for path in [CUBIC, jerky, even, back] {
            let times = (0..=100_000).map(|part| path.seconds * f64::from(part) / 1e5);
            let (mut low, mut high, mut fastest) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
            for time in times {
                let position = path.position(time);
                (low, high) = (low.min(position), high.max(position));
                fastest = fastest.max(path.rate(time).velocity.abs());
            }
            let reach = path.reach();
            assert!(
                (reach.0 - low).abs() < 1e-8 && (reach.1 - high).abs() < 1e-8,
                "{path:?}: {reach:?}, {low} .. {high}"
            );
            assert!((path.fastest() - fastest).abs() < 1e-8, "{path:?}");
        }
    }

    /// x = 1·t − t² for 1.5 s: back to −0.75 m at −2 m/s, with the turn at ¼ m.
    #[test]
    fn constant_acceleration_is_a_path() {
        let path = Path::accelerated(
            ActuatorMotion {
                position: 0.0,
                velocity: 1.0,
                acceleration: -2.0,
            },
            1.5,
        );
        assert!((path.to + 0.75).abs() < 1e-15 && path.end_velocity == -2.0);
        assert!(
            (path.rate(0.7).acceleration + 2.0).abs() < 1e-12 && path.rate(0.7).jerk.abs() < 1e-12
        );
        assert!((path.reach().1 - 0.25).abs() < 1e-12);
    }
}
