//! The uniform distribution between two limits. Out: quantiles and tails.

use super::{Continuous, DistributionError, Tails};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Uniform {
    low: f64,
    high: f64,
}

impl Uniform {
    pub(super) fn new(low: f64, high: f64) -> Result<Self, DistributionError> {
        if low < high && (high - low).is_finite() {
            Ok(Self { low, high })
        } else {
            Err(DistributionError::Limits { low, high })
        }
    }
}

impl Continuous for Uniform {
    fn quantile(&self, tails: Tails) -> f64 {
        let width = self.high - self.low;
        if tails.below < 0.5 {
            self.low + tails.below * width
        } else {
            self.high - tails.above * width
        }
    }

    fn tails(&self, value: f64) -> Tails {
        let width = self.high - self.low;
        Tails {
            below: ((value - self.low) / width).clamp(0.0, 1.0),
            above: ((self.high - value) / width).clamp(0.0, 1.0),
        }
    }
}
