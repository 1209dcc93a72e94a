//! Studies: many runs of one plan with scattered inputs. In: distributions, outcomes and results of runs. Out: the inputs of run i, and
//! probabilities, quantiles, sensitivities and fragilities with their confidence intervals. It runs no model itself.

pub mod correlation;
pub mod distribution;
pub mod fragility;
pub mod inputs;
pub mod mean;
pub mod probability;
pub mod quantile;
pub mod sampling;
pub mod sensitivity;
pub mod subset_simulation;

use thiserror::Error;

/// An interval that contains the true value with its confidence, at least.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    pub low: f64,
    pub high: f64,
}

impl Interval {
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    #[must_use]
    pub fn half_width(&self) -> f64 {
        0.5 * (self.high - self.low)
    }
}

/// A level of confidence between 0 and 1, both excluded, such as 0.95.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Confidence(f64);

/// There is no such level of confidence.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("a level of confidence lies between 0 and 1, both excluded, here {0}")]
pub struct NoConfidence(pub f64);

impl Confidence {
    /// # Errors
    /// The level is not between 0 and 1.
    pub fn new(level: f64) -> Result<Self, NoConfidence> {
        if level > 0.0 && level < 1.0 {
            Ok(Self(level))
        } else {
            Err(NoConfidence(level))
        }
    }

    /// α, the accepted probability of an error.
    #[must_use]
    pub const fn error(self) -> f64 {
        1.0 - self.0
    }

    /// The number of standard deviations on either side of the mean of a normal distribution.
    #[must_use]
    pub fn normal_factor(self) -> f64 {
        -distribution::normal::quantile(0.5 * self.error())
    }
}

/// A count as a number.
#[expect(
    clippy::cast_precision_loss,
    reason = "a study has far fewer runs than 2^53"
)]
pub(crate) const fn number(count: u64) -> f64 {
    count as f64
}
