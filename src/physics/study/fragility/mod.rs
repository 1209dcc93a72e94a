//! Fragility curves: the probability that a limit is exceeded, by the intensity of the impact or ground motion. In: counts of exceedances at
//! some intensities. Out: the lognormal curve of the largest likelihood, with its confidence band, or the reason why there is none.
//!
//! ```text
//! P(exceeded | x) = Φ(ln(x/θ)/β)
//! ```
//!
//! θ is the median intensity, β the dispersion. The fit is J. W. Baker's for multiple stripes (*Efficient analytical fragility function
//! fitting using dynamic structural analysis*, Earthquake Spectra 31 (2015) 579–599, eq. 11).

mod likelihood;
mod profile;
mod split;

pub use split::Split;
use statrs::function::gamma::gamma_ur;
use thiserror::Error;

use super::distribution::normal;
use super::{Confidence, Interval, number};
use likelihood::{Count, log_likelihood, maximum};
use profile::Profile;

/// Runs at one intensity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stripe {
    /// In the unit of the curve, above 0.
    pub intensity: f64,
    pub exceeded: u64,
    pub not_exceeded: u64,
    pub no_result: u64,
}

/// How runs without a result are counted. The truth lies between the two curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoResult {
    AsExceeded,
    AsNotExceeded,
}

/// The reason why no curve fits.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum NoFit {
    #[error("intensity {0}: a fragility curve has intensities above 0")]
    Intensity(f64),
    #[error("all runs have one intensity")]
    OneIntensity,
    #[error("no run exceeds the limit: the curve begins above the largest intensity")]
    NoneExceeds,
    #[error("every run exceeds the limit: the curve ends below the smallest intensity")]
    AllExceed,
    #[error(
        "no run exceeds the limit up to {below}, every run from {above}: intensities between them are missing"
    )]
    Step { below: f64, above: f64 },
    /// The neighbours of the one intensity: 0 and infinity where it is the first or the last one.
    #[error(
        "only one intensity ({mixed}) has both outcomes: intensities between {below} and {above} are missing"
    )]
    OneMixed { mixed: f64, below: f64, above: f64 },
    #[error("the limit is not exceeded more often at larger intensities")]
    NotRising,
}

/// A lognormal fragility curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    /// θ, in the unit of the intensities.
    pub median: f64,
    /// β
    pub dispersion: f64,
}

impl Curve {
    /// The probability that the limit is exceeded at an intensity.
    #[must_use]
    pub fn probability(&self, intensity: f64) -> f64 {
        normal::below((intensity / self.median).ln() / self.dispersion)
    }
}

/// A fitted curve.
#[derive(Clone, Debug)]
pub struct Fit {
    pub curve: Curve,
    /// Probability of a deviance as large as this one if the curve is right (χ², stripes less two). None with two stripes. A small one
    /// says that the curve is not lognormal.
    pub goodness: Option<f64>,
    /// Some stripe has between 10 % and 90 % of exceedances. Without one, the dispersion is a guess.
    pub has_middle: bool,
    counts: Vec<Count>,
    /// Mean of ln x, the origin of the counts.
    origin: f64,
    coefficients: [f64; 2],
}

impl Fit {
    /// Of the largest likelihood.
    ///
    /// # Errors
    /// No curve has one.
    pub fn new(stripes: &[Stripe], counted: NoResult) -> Result<Self, NoFit> {
        let stripes: Vec<Stripe> = stripes.iter().map(|stripe| stripe.with(counted)).collect();
        let stripes: Vec<&Stripe> = stripes.iter().filter(|stripe| stripe.runs() > 0).collect();
        possible(&stripes)?;
        let logs = || stripes.iter().map(|stripe| stripe.intensity.ln());
        let origin = logs().sum::<f64>() / number(stripes.len() as u64);
        let counts: Vec<Count> = stripes
            .iter()
            .map(|stripe| Count {
                at: stripe.intensity.ln() - origin,
                exceeded: stripe.exceeded,
                not_exceeded: stripe.not_exceeded,
            })
            .collect();
        let coefficients = maximum(&counts, [0.0, 0.0]).ok_or(NoFit::NotRising)?;
        let [constant, slope] = coefficients;
        if slope <= 0.0 {
            return Err(NoFit::NotRising);
        }
        let curve = Curve {
            median: (origin - constant / slope).exp(),
            dispersion: 1.0 / slope,
        };
        let has_middle = stripes
            .iter()
            .any(|stripe| (0.1..=0.9).contains(&stripe.share()));
        Ok(Self {
            curve,
            goodness: goodness(&stripes, log_likelihood(&counts, coefficients)),
            has_middle,
            counts,
            origin,
            coefficients,
        })
    }

    /// The band of the curve at an intensity: the probabilities that the runs do not contradict, by the ratio of their profile likelihood.
    ///
    /// # Panics
    /// If the intensity is not above 0.
    #[must_use]
    pub fn band(&self, intensity: f64, confidence: Confidence) -> Interval {
        assert!(intensity > 0.0, "intensity {intensity}");
        self.profile(confidence).band(intensity.ln() - self.origin)
    }

    /// The interval of the median. None if the runs do not show that the curve rises: the median may then be anything.
    #[must_use]
    pub fn median_interval(&self, confidence: Confidence) -> Option<Interval> {
        let logs = self.profile(confidence).median()?;
        Some(Interval {
            low: (self.origin + logs.low).exp(),
            high: (self.origin + logs.high).exp(),
        })
    }

    /// The interval of the dispersion. None if the runs do not show that the curve rises.
    #[must_use]
    pub fn dispersion_interval(&self, confidence: Confidence) -> Option<Interval> {
        let slopes = self.profile(confidence).slope()?;
        Some(Interval {
            low: 1.0 / slopes.high,
            high: 1.0 / slopes.low,
        })
    }

    fn profile(&self, confidence: Confidence) -> Profile<'_> {
        Profile::new(&self.counts, self.coefficients, confidence)
    }
}

impl Stripe {
    const fn runs(&self) -> u64 {
        self.exceeded + self.not_exceeded + self.no_result
    }

    fn share(&self) -> f64 {
        number(self.exceeded) / number(self.runs())
    }

    /// Every run counted.
    const fn with(self, counted: NoResult) -> Self {
        let [more, less] = match counted {
            NoResult::AsExceeded => [self.no_result, 0],
            NoResult::AsNotExceeded => [0, self.no_result],
        };
        Self {
            exceeded: self.exceeded + more,
            not_exceeded: self.not_exceeded + less,
            no_result: 0,
            ..self
        }
    }
}

/// Whether the likelihood has a maximum: it has none where one intensity separates the runs that exceed from those that do not (A. Albert, J.
/// A. Anderson, Biometrika 71 (1984) 1–10).
fn possible(stripes: &[&Stripe]) -> Result<(), NoFit> {
    let wrong = |stripe: &&&Stripe| !(stripe.intensity > 0.0 && stripe.intensity.is_finite());
    if let Some(stripe) = stripes.iter().find(wrong) {
        return Err(NoFit::Intensity(stripe.intensity));
    }
    let range = |of: fn(&Stripe) -> u64| {
        let with = stripes.iter().filter(|stripe| of(stripe) > 0);
        with.map(|stripe| [stripe.intensity; 2])
            .reduce(|range, next| [range[0].min(next[0]), range[1].max(next[1])])
    };
    let Some(exceeded) = range(|stripe| stripe.exceeded) else {
        return Err(NoFit::NoneExceeds);
    };
    let Some(not_exceeded) = range(|stripe| stripe.not_exceeded) else {
        return Err(NoFit::AllExceed);
    };
    if stripes
        .iter()
        .all(|stripe| stripe.intensity == stripes[0].intensity)
    {
        return Err(NoFit::OneIntensity);
    }
    if not_exceeded[1] == exceeded[0] {
        let mixed = exceeded[0];
        let intensities = || stripes.iter().map(|stripe| stripe.intensity);
        return Err(NoFit::OneMixed {
            mixed,
            below: intensities().filter(|it| *it < mixed).fold(0.0, f64::max),
            above: intensities()
                .filter(|it| *it > mixed)
                .fold(f64::INFINITY, f64::min),
        });
    }
    if not_exceeded[1] < exceeded[0] {
        return Err(NoFit::Step {
            below: not_exceeded[1],
            above: exceeded[0],
        });
    }
    if exceeded[1] <= not_exceeded[0] {
        return Err(NoFit::NotRising);
    }
    Ok(())
}

/// Twice the log-likelihood that a curve through every share has more, as a probability of χ².
fn goodness(stripes: &[&Stripe], fitted: f64) -> Option<f64> {
    let degrees = u64::try_from(stripes.len()).ok()?.checked_sub(2)?;
    if degrees == 0 {
        return None;
    }
    let part = |runs: u64, share: f64| {
        if runs == 0 {
            0.0
        } else {
            number(runs) * share.ln()
        }
    };
    let saturated: f64 = stripes
        .iter()
        .map(|stripe| {
            let share = stripe.share();
            part(stripe.exceeded, share) + part(stripe.not_exceeded, 1.0 - share)
        })
        .sum();
    Some(gamma_ur(
        0.5 * number(degrees),
        (saturated - fitted).max(0.0),
    ))
}

#[cfg(test)]
mod tests;
