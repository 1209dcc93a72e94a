//! Gumbel's distribution of maxima, by its mean and spread. Out: quantiles and tails.

use std::f64::consts::PI;

use super::{Continuous, DistributionError, Spread, Tails};

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

/// The probability below x is exp(−exp(−(x − μ)/β)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Gumbel {
    /// μ, the mode.
    location: f64,
    /// β
    scale: f64,
}

impl Gumbel {
    /// sd = πβ/√6, mean = μ + γβ.
    pub(super) fn new(mean: f64, spread: Spread) -> Result<Self, DistributionError> {
        let scale = spread.sd(mean)? * 6.0_f64.sqrt() / PI;
        Ok(Self {
            location: mean - EULER * scale,
            scale,
        })
    }
}

impl Continuous for Gumbel {
    fn quantile(&self, tails: Tails) -> f64 {
        let exponent = if tails.below < 0.5 {
            -tails.below.ln()
        } else {
            -(-tails.above).ln_1p()
        };
        self.location - self.scale * exponent.ln()
    }

    fn tails(&self, value: f64) -> Tails {
        let exponent = (-(value - self.location) / self.scale).exp();
        Tails {
            below: (-exponent).exp(),
            above: -(-exponent).exp_m1(),
        }
    }
}
