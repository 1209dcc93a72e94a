//! Distributions of inputs. In: mean and standard deviation or limits, as an engineer states them, and a probability. Out: the value below
//! which a draw lies with that probability. It draws nothing itself.
//!
//! A value is a monotone function of one uniform number. All designs of points then work alike, a correlation of ranks holds for
//! all distributions, and run i has the same value in every study.

mod gumbel;
mod lognormal;
pub mod normal;
mod triangular;
mod uniform;
mod weibull;

use std::ops::RangeInclusive;

use thiserror::Error;

use gumbel::Gumbel;
use lognormal::Lognormal;
use normal::Normal;
use triangular::Triangular;
use uniform::Uniform;
use weibull::Weibull;

/// Smallest probability of a truncated distribution before its truncation. Below it, the numbers are those of a far tail.
const LEAST_MASS: f64 = 1e-9;

/// A probability with its complement, so that neither tail loses digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tails {
    /// Probability of a smaller value.
    pub below: f64,
    /// Probability of a larger value.
    pub above: f64,
}

impl Tails {
    /// From a uniform number between 0 and 1.
    #[must_use]
    pub const fn of_uniform(below: f64) -> Self {
        Self {
            below,
            above: 1.0 - below,
        }
    }

    /// From a standard normal number.
    #[must_use]
    pub fn of_score(score: f64) -> Self {
        Self {
            below: normal::below(score),
            above: normal::below(-score),
        }
    }

    /// The standard normal number with these tails.
    #[must_use]
    pub fn score(self) -> f64 {
        if self.below < 0.5 {
            normal::quantile(self.below)
        } else {
            -normal::quantile(self.above)
        }
    }
}

/// The scatter of an input around its mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spread {
    /// Standard deviation, in the unit of the mean.
    Sd(f64),
    /// Coefficient of variation: standard deviation over |mean|.
    Cv(f64),
}

impl Spread {
    /// The standard deviation around this mean.
    ///
    /// # Errors
    /// It is not a positive number.
    pub fn sd(self, mean: f64) -> Result<f64, DistributionError> {
        let sd = match self {
            Self::Sd(sd) => sd,
            Self::Cv(cv) => cv * mean.abs(),
        };
        if sd > 0.0 && sd.is_finite() && mean.is_finite() {
            Ok(sd)
        } else {
            Err(DistributionError::NoSpread { mean, sd })
        }
    }
}

/// The reason why there is no such distribution.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum DistributionError {
    #[error(
        "mean {mean} with standard deviation {sd}: the standard deviation must be a positive number"
    )]
    NoSpread { mean: f64, sd: f64 },
    #[error("mean {0}: this distribution has positive values only")]
    NotPositive(f64),
    #[error("a Weibull distribution has a coefficient of variation from {least} to {most}, here {cv}", least = weibull::LEAST_CV, most = weibull::MOST_CV)]
    WeibullSpread { cv: f64 },
    #[error("limits {low} and {high}: the lower limit must be below the upper limit")]
    Limits { low: f64, high: f64 },
    #[error("mode {mode} is outside the limits {low} and {high}")]
    Mode { low: f64, mode: f64, high: f64 },
    #[error(
        "the distribution has almost no values between {low} and {high}: probability {mass:.2e}"
    )]
    NothingInside { low: f64, high: f64, mass: f64 },
}

/// A law in terms of its own parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Law {
    Normal(Normal),
    Lognormal(Lognormal),
    Uniform(Uniform),
    Triangular(Triangular),
    Weibull(Weibull),
    Gumbel(Gumbel),
}

/// What every law answers.
trait Continuous {
    /// The value with these tails.
    fn quantile(&self, tails: Tails) -> f64;

    /// The tails of a value.
    fn tails(&self, value: f64) -> Tails;
}

/// The limits of a truncated distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Limits {
    low: f64,
    high: f64,
    /// Probability below `low`.
    below: f64,
    /// Probability above `high`.
    above: f64,
    /// Probability between them.
    mass: f64,
}

/// The distribution of an input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distribution {
    law: Law,
    limits: Option<Limits>,
}

impl Distribution {
    /// Normal.
    ///
    /// # Errors
    /// The standard deviation is not positive.
    pub fn normal(mean: f64, spread: Spread) -> Result<Self, DistributionError> {
        Normal::new(mean, spread).map(|law| Self::of(Law::Normal(law)))
    }

    /// Lognormal, by the mean and the spread of the value itself, not of its logarithm.
    ///
    /// # Errors
    /// Mean or standard deviation is not positive.
    pub fn lognormal(mean: f64, spread: Spread) -> Result<Self, DistributionError> {
        Lognormal::new(mean, spread).map(|law| Self::of(Law::Lognormal(law)))
    }

    /// Uniform between two limits.
    ///
    /// # Errors
    /// The lower limit is not below the upper one.
    pub fn uniform(low: f64, high: f64) -> Result<Self, DistributionError> {
        Uniform::new(low, high).map(|law| Self::of(Law::Uniform(law)))
    }

    /// Uniform, within √3 standard deviations of its mean.
    ///
    /// # Errors
    /// The standard deviation is not positive.
    pub fn uniform_around(mean: f64, spread: Spread) -> Result<Self, DistributionError> {
        let half = 3.0_f64.sqrt() * spread.sd(mean)?;
        Self::uniform(mean - half, mean + half)
    }

    /// Triangular between two limits, with this mode.
    ///
    /// # Errors
    /// The lower limit is not below the upper one, or the mode is outside.
    pub fn triangular(limits: &RangeInclusive<f64>, mode: f64) -> Result<Self, DistributionError> {
        Triangular::new(limits, mode).map(|law| Self::of(Law::Triangular(law)))
    }

    /// Weibull from 0 on (minima of strength).
    ///
    /// # Errors
    /// The mean is not positive, or the spread is too small or too large.
    pub fn weibull(mean: f64, spread: Spread) -> Result<Self, DistributionError> {
        Weibull::new(mean, spread).map(|law| Self::of(Law::Weibull(law)))
    }

    /// Gumbel's distribution of maxima (loads).
    ///
    /// # Errors
    /// The standard deviation is not positive.
    pub fn gumbel(mean: f64, spread: Spread) -> Result<Self, DistributionError> {
        Gumbel::new(mean, spread).map(|law| Self::of(Law::Gumbel(law)))
    }

    const fn of(law: Law) -> Self {
        Self { law, limits: None }
    }

    /// The same between two limits; either may be infinite. Mean and standard deviation are those before the truncation.
    ///
    /// # Errors
    /// The lower limit is not below the upper one, or nearly nothing lies between them.
    pub fn truncated(self, low: f64, high: f64) -> Result<Self, DistributionError> {
        if low.is_nan() || high.is_nan() || low >= high {
            return Err(DistributionError::Limits { low, high });
        }
        let [from, to] = [low, high].map(|limit| self.continuous().tails(limit));
        let mass = if from.below < 0.5 {
            to.below - from.below
        } else {
            from.above - to.above
        };
        if mass.is_nan() || mass < LEAST_MASS {
            return Err(DistributionError::NothingInside { low, high, mass });
        }
        let limits = Some(Limits {
            low,
            high,
            below: from.below,
            above: to.above,
            mass,
        });
        Ok(Self { limits, ..self })
    }

    /// The value with these tails.
    #[must_use]
    pub fn quantile(&self, tails: Tails) -> f64 {
        let Some(limits) = self.limits else {
            return self.continuous().quantile(tails);
        };
        let inside = Tails {
            below: limits.below + tails.below * limits.mass,
            above: limits.above + tails.above * limits.mass,
        };
        self.continuous()
            .quantile(inside)
            .clamp(limits.low, limits.high)
    }

    fn continuous(&self) -> &dyn Continuous {
        match &self.law {
            Law::Normal(law) => law,
            Law::Lognormal(law) => law,
            Law::Uniform(law) => law,
            Law::Triangular(law) => law,
            Law::Weibull(law) => law,
            Law::Gumbel(law) => law,
        }
    }
}

#[cfg(test)]
mod tests;
