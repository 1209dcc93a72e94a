//! The tangent stiffness from the readings (Melo et al. 2006, eq. 6). In: pairs of displacement and force, one per step. Out: a stiffness
//! inside its bounds. Noise must never appear as a stiffness, nor preserve an old stiffness.
//!
//! A step whose change of displacement exceeds the noise gives the secant of eq. (6). A shorter step does not determine a slope alone.
//! The last readings then determine it together, by least squares over the fewest of them whose displacements span as much as one step
//! would need. With σ the noise of one reading and n readings spread evenly over the span S, the slope has a standard deviation of about
//! √(12/n)·σ/S, less than the secant's √2·σ/S for n > 6 and never more than it for two. Until a span exceeds the noise, the last
//! stiffness is kept.

use std::collections::VecDeque;

use crate::statistics::DeclaredNoise;

/// A tangent stiffness needs a change of force this many times the load cell's noise. With less, noise appears as a stiffness (at 10 a
/// secant errs by 14 %, one standard deviation); with more, it follows the specimen late. A ratio of forces.
pub const NOISE_MULTIPLE: f64 = 10.0;
/// Largest number of readings of a window: a longer window would lag too far behind.
const MOST_READINGS: usize = 4096;

/// The parameters for the update of tangents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Following {
    /// c of `K_t within [0, c·K0]`
    pub largest_ratio: f64,
    pub noise: DeclaredNoise,
}

/// The current tangent stiffness `K_t`.
#[derive(Clone, Debug)]
pub struct TangentStiffness {
    /// The smallest change of measured displacement that gives a stiffness \[m\]; 0 if readings are exact.
    least_change: f64,
    largest: f64,
    value: f64,
    last: (f64, f64),
    /// Readings since a span last determined the stiffness, newest last. Empty if readings are exact.
    window: VecDeque<(f64, f64)>,
}

impl TangentStiffness {
    /// Begins with `initial` \[N/m\] and the first reading \[m\], \[N\].
    #[must_use]
    pub fn new(initial: f64, following: Following, displacement: f64, force: f64) -> Self {
        let Following {
            largest_ratio,
            noise,
        } = following;
        let first = (displacement, force);
        let least_change = noise.resolution.max(NOISE_MULTIPLE * noise.force / initial);
        let window = if least_change > 0.0 {
            VecDeque::from([first])
        } else {
            VecDeque::new()
        };
        Self {
            least_change,
            largest: largest_ratio * initial,
            value: initial,
            last: first,
            window,
        }
    }

    /// \[N/m\]
    #[must_use]
    pub const fn value(&self) -> f64 {
        self.value
    }

    /// Adds the reading at the end of a step \[m\], \[N\]; returns the stiffness from there on \[N/m\].
    #[inline]
    pub fn take(&mut self, displacement: f64, force: f64) -> f64 {
        let change = displacement - self.last.0;
        let mut value = self.value;
        if change.abs() > self.least_change {
            // Eq. (6)
            value = ((force - self.last.1) / change).clamp(0.0, self.largest);
            self.value = value;
        }
        if self.least_change > 0.0 {
            self.widen(displacement, force, change.abs() > self.least_change);
            value = self.value;
        }
        self.last = (displacement, force);
        value
    }

    /// Keeps the fewest of the last readings that span enough; if the step alone does not, they determine the stiffness together.
    fn widen(&mut self, displacement: f64, force: f64, determined: bool) {
        self.window.push_back((displacement, force));
        if determined {
            self.window.drain(..self.window.len().saturating_sub(2));
            return;
        }
        if self.window.len() > MOST_READINGS {
            self.window.pop_front();
        }
        let (mut low, mut high) = (displacement, displacement);
        let needed = self.window.iter().rev().position(|(displacement, _)| {
            (low, high) = (low.min(*displacement), high.max(*displacement));
            high - low > self.least_change
        });
        if let Some(needed) = needed {
            self.window.drain(..self.window.len() - 1 - needed);
            if let Some(slope) = slope(&self.window) {
                self.value = slope.clamp(0.0, self.largest);
            }
        }
    }
}

/// Least squares of force on displacement, with an intercept.
fn slope(readings: &VecDeque<(f64, f64)>) -> Option<f64> {
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_READINGS")]
    let count = readings.len() as f64;
    let (x, r) = readings.iter().fold((0.0, 0.0), |sum, reading| {
        (sum.0 + reading.0, sum.1 + reading.1)
    });
    let (x, r) = (x / count, r / count);
    let (both, own) = readings.iter().fold((0.0, 0.0), |(both, own), reading| {
        let away = reading.0 - x;
        (both + away * (reading.1 - r), own + away * away)
    });
    (own > 0.0).then(|| both / own)
}

#[cfg(test)]
mod tests {
    use super::*;

    const INITIAL: f64 = 1000.0;

    /// The readings have no noise; the window follows from the stated one.
    fn followed(force: f64, readings: impl IntoIterator<Item = (f64, f64)>) -> f64 {
        let mut tangent = TangentStiffness::new(
            INITIAL,
            Following {
                largest_ratio: 2.0,
                noise: DeclaredNoise {
                    force,
                    resolution: 0.0,
                },
            },
            0.0,
            0.0,
        );
        for (displacement, force) in readings {
            tangent.take(displacement, force);
        }
        tangent.value()
    }

    #[test]
    fn exact_readings_give_the_secant_of_each_step() {
        assert_eq!(
            followed(0.0, [(1e-9, 0.5e-6), (2e-9, 0.8e-6)]),
            (0.8e-6 - 0.5e-6) / (2e-9 - 1e-9)
        );
        assert_eq!(followed(0.0, [(1e-3, 5.0)]), 2000.0, "clamped above");
        assert_eq!(followed(0.0, [(1e-3, -5.0)]), 0.0, "and below");
        assert_eq!(
            followed(0.0, [(0.0, 5.0)]),
            INITIAL,
            "without motion there is no tangent"
        );
    }

    /// 10 σ/K = 10 mm: no step of 1 mm determines a slope, eleven together do. The result is the line through the last ones.
    #[test]
    fn steps_too_short_to_be_significant_alone_are_significant_together() {
        let line =
            |steps: u32| (1..=steps).map(|step| (f64::from(step) * 1e-3, 0.4 * f64::from(step)));
        assert_eq!(followed(1.0, line(9)), INITIAL);
        assert!((followed(1.0, line(11)) - 400.0).abs() < 1e-9);
        // A corner at 20 mm is behind the window 11 steps after it.
        let kink = |steps: u32| {
            line(20).chain((1..=steps).map(|step| (0.02 + f64::from(step) * 1e-3, 8.0)))
        };
        let half_followed = followed(1.0, kink(5));
        assert!(
            half_followed > 50.0 && half_followed < 350.0,
            "{half_followed}"
        );
        assert!(followed(1.0, kink(12)).abs() < 1e-9);
    }

    /// A long step determines the slope alone. Earlier readings no longer contribute, but the long step supports the short ones after it.
    #[test]
    fn a_step_long_enough_forgets_the_window() {
        let short = || (1..=5).map(|step| (f64::from(step) * 1e-3, f64::from(step)));
        assert!((followed(1.0, short().chain([(0.025, 9.0)])) - 4.0 / 0.02).abs() < 1e-9);
        let on_the_line = [(0.025, 9.0), (0.026, 9.2), (0.027, 9.4)];
        assert!((followed(1.0, short().chain(on_the_line)) - 4.0 / 0.02).abs() < 1e-9);
    }
}
