//! Profile likelihoods of a fragility curve. In: its fit and a level of confidence. Out: the range of a probability, of the median or of the
//! slope for which some curve is likely enough. The largest log-likelihood is at most ½χ² below that of the fit, with one degree of freedom.

use super::super::distribution::normal;
use super::super::{Confidence, Interval};
use super::likelihood::{Count, log_likelihood, maximum_on_line};

/// Halvings of a bracket.
const HALVINGS: u32 = 40;
/// Doublings of a first step until a limit is passed.
const DOUBLINGS: u32 = 60;

/// The likelihood around a fit.
pub struct Profile<'a> {
    counts: &'a [Count],
    /// α₀ and α₁ of the fit.
    fit: [f64; 2],
    /// A log-likelihood below this is not likely enough.
    least: f64,
}

impl<'a> Profile<'a> {
    pub fn new(counts: &'a [Count], fit: [f64; 2], confidence: Confidence) -> Self {
        // χ² of one degree of freedom is the square of a normal number.
        let drop = 0.5 * confidence.normal_factor().powi(2);
        let least = log_likelihood(counts, fit) - drop;
        Self { counts, fit, least }
    }

    /// Of the probability at t: all curves through one η there, which differ in their slope.
    pub fn band(&self, at: f64) -> Interval {
        let fitted = self.fit[0] + self.fit[1] * at;
        let likely = |score: f64| self.likely([score, 0.0], [-at, 1.0], self.fit[1]);
        let [low, high] = [-1.0, 1.0].map(|side| limit(fitted, side, likely));
        Interval {
            low: low.map_or(0.0, normal::below),
            high: high.map_or(1.0, normal::below),
        }
    }

    /// Of t at the median: all curves through η = 0 there.
    pub fn median(&self) -> Option<Interval> {
        self.rises().then_some(())?;
        let likely = |at: f64| self.likely([0.0, 0.0], [-at, 1.0], self.fit[1]);
        let fitted = -self.fit[0] / self.fit[1];
        let [low, high] = [-1.0, 1.0].map(|side| limit(fitted, side, likely));
        Some(Interval {
            low: low?,
            high: high?,
        })
    }

    /// Of the slope α₁.
    pub fn slope(&self) -> Option<Interval> {
        self.rises().then_some(())?;
        let likely = |slope: f64| self.likely([0.0, slope], [1.0, 0.0], self.fit[0]);
        let [low, high] = [-1.0, 1.0].map(|side| limit(self.fit[1], side, likely));
        Some(Interval {
            low: low?,
            high: high?,
        })
    }

    /// A curve without a slope is not likely enough.
    fn rises(&self) -> bool {
        !self.likely([0.0, 0.0], [1.0, 0.0], 0.0)
    }

    fn likely(&self, through: [f64; 2], along: [f64; 2], start: f64) -> bool {
        maximum_on_line(self.counts, through, along, start).0 >= self.least
    }
}

/// Where a quantity stops being likely on one side of its fit. None: nowhere.
fn limit(fitted: f64, side: f64, likely: impl Fn(f64) -> bool) -> Option<f64> {
    let mut reach = 0.1;
    let mut inside = 0.0;
    let mut doublings = 0;
    while likely(fitted + side * reach) {
        doublings += 1;
        if doublings > DOUBLINGS {
            return None;
        }
        (inside, reach) = (reach, 2.0 * reach);
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (inside + reach);
        if likely(fitted + side * middle) {
            inside = middle;
        } else {
            reach = middle;
        }
    }
    // The end that is not likely: the interval is rather too wide than too narrow.
    Some(fitted + side * reach)
}
