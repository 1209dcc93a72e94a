//! The triangular distribution between two limits, with its mode. Out: quantiles and tails.

use std::ops::RangeInclusive;

use super::{Continuous, DistributionError, Tails};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Triangular {
    low: f64,
    mode: f64,
    high: f64,
}

impl Triangular {
    pub(super) fn new(limits: &RangeInclusive<f64>, mode: f64) -> Result<Self, DistributionError> {
        let (low, high) = (*limits.start(), *limits.end());
        if low.is_nan() || high.is_nan() || low >= high || !(high - low).is_finite() {
            return Err(DistributionError::Limits { low, high });
        }
        if (low..=high).contains(&mode) {
            Ok(Self { low, mode, high })
        } else {
            Err(DistributionError::Mode { low, mode, high })
        }
    }
}

impl Continuous for Triangular {
    /// With F = (x − a)²/((b − a)(m − a)) below the mode, and the same from above.
    fn quantile(&self, tails: Tails) -> f64 {
        let width = self.high - self.low;
        if tails.below * width < self.mode - self.low {
            self.low + (tails.below * width * (self.mode - self.low)).sqrt()
        } else {
            self.high - (tails.above * width * (self.high - self.mode)).sqrt()
        }
    }

    fn tails(&self, value: f64) -> Tails {
        let value = value.clamp(self.low, self.high);
        let width = self.high - self.low;
        if value < self.mode {
            let below = (value - self.low).powi(2) / (width * (self.mode - self.low));
            return Tails::of_uniform(below);
        }
        let above = if self.high > self.mode {
            (self.high - value).powi(2) / (width * (self.high - self.mode))
        } else {
            0.0
        };
        Tails {
            below: 1.0 - above,
            above,
        }
    }
}
