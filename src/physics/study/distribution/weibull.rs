//! Weibull's distribution from 0 on, by its mean and spread. Out: quantiles and tails.

use statrs::function::gamma::ln_gamma;

use super::{Continuous, DistributionError, Spread, Tails};

/// Smallest coefficient of variation: shape 1282.
pub(super) const LEAST_CV: f64 = 0.001;
/// Largest coefficient of variation: shape 0.22.
pub(super) const MOST_CV: f64 = 10.0;

/// The probability above x is exp(−(x/λ)ᵏ).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Weibull {
    /// k
    shape: f64,
    /// λ
    scale: f64,
}

impl Weibull {
    /// The shape solves 1 + cv² = Γ(1 + 2/k)/Γ(1 + 1/k)², by bisection: the right side falls as k grows. λ = m/Γ(1 + 1/k).
    pub(super) fn new(mean: f64, spread: Spread) -> Result<Self, DistributionError> {
        if mean.is_nan() || mean <= 0.0 {
            return Err(DistributionError::NotPositive(mean));
        }
        let cv = spread.sd(mean)? / mean;
        if !(LEAST_CV..=MOST_CV).contains(&cv) {
            return Err(DistributionError::WeibullSpread { cv });
        }
        let wanted = (cv * cv).ln_1p();
        let found = |shape: f64| ln_gamma(1.0 + 2.0 / shape) - 2.0 * ln_gamma(1.0 + 1.0 / shape);
        let (mut low, mut high) = (0.1_f64, 2000.0_f64);
        while high - low > 1e-14 * high {
            let middle = (low * high).sqrt();
            if middle <= low || middle >= high {
                break;
            }
            if found(middle) > wanted {
                low = middle;
            } else {
                high = middle;
            }
        }
        let shape = (low * high).sqrt();
        let scale = mean / ln_gamma(1.0 + 1.0 / shape).exp();
        Ok(Self { shape, scale })
    }
}

impl Continuous for Weibull {
    fn quantile(&self, tails: Tails) -> f64 {
        let exponent = if tails.below < 0.5 {
            -(-tails.below).ln_1p()
        } else {
            -tails.above.ln()
        };
        self.scale * exponent.powf(1.0 / self.shape)
    }

    fn tails(&self, value: f64) -> Tails {
        let exponent = (value.max(0.0) / self.scale).powf(self.shape);
        Tails {
            below: -(-exponent).exp_m1(),
            above: (-exponent).exp(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// k = 1 is exponential, cv = 1; k = 2 is Rayleigh's distribution, cv² = 4/π − 1.
    #[test]
    fn shape_and_scale_are_those_of_closed_forms() {
        let exponential = Weibull::new(3.0, Spread::Cv(1.0)).unwrap();
        assert!((exponential.shape - 1.0).abs() < 1e-12);
        assert!((exponential.scale - 3.0).abs() < 1e-12);
        let cv = (4.0 / std::f64::consts::PI - 1.0).sqrt();
        let rayleigh = Weibull::new(3.0, Spread::Cv(cv)).unwrap();
        assert!((rayleigh.shape - 2.0).abs() < 1e-12);
        assert!((rayleigh.scale - 6.0 / std::f64::consts::PI.sqrt()).abs() < 1e-12);
    }
}
