//! The lognormal distribution by the mean and the spread of the value itself. Out: quantiles and tails.

use super::{Continuous, DistributionError, Spread, Tails};

/// ln X is normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lognormal {
    /// Mean of ln X.
    mean_of_log: f64,
    /// Standard deviation of ln X.
    sd_of_log: f64,
}

impl Lognormal {
    /// σ² = ln(1 + cv²), μ = ln m − ½σ².
    pub(super) fn new(mean: f64, spread: Spread) -> Result<Self, DistributionError> {
        if mean.is_nan() || mean <= 0.0 {
            return Err(DistributionError::NotPositive(mean));
        }
        let cv = spread.sd(mean)? / mean;
        let variance = (cv * cv).ln_1p();
        Ok(Self {
            mean_of_log: mean.ln() - 0.5 * variance,
            sd_of_log: variance.sqrt(),
        })
    }
}

impl Continuous for Lognormal {
    fn quantile(&self, tails: Tails) -> f64 {
        (self.mean_of_log + self.sd_of_log * tails.score()).exp()
    }

    fn tails(&self, value: f64) -> Tails {
        Tails::of_score((value.max(0.0).ln() - self.mean_of_log) / self.sd_of_log)
    }
}
