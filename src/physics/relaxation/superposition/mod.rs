//! Relaxation of every increment of force with its own time: exponentially, or with the logarithm of time. In: dwells, each with its
//! readings, the duration of the move to it, and the force before the first. Out: the law, its parameters with standard errors, the rate
//! of the worst dwell and the dwell time that it required. It knows no rig.
//!
//! R̂ is the instantaneous force, which the specimen would have without relaxation. Each move adds an increment ΔR̂. By the time u after
//! it the part `share`·L(u) of this increment is lost ([`super::law`]; Boltzmann's superposition). In dwell h
//!
//! ```text
//! R(t) = R̂_h − share·Σ_{j ≤ h} (R̂_j − R̂_{j−1})·L(t + T_h − T_j)
//! ```
//!
//! with one `share` and one time for all dwells: n + 2 parameters for n dwells, for either law. Each R̂_h follows by least squares over
//! the readings of its own dwell. The effect of later dwells on it is of the order of `share`² and is neglected. Share and time follow by
//! least squares over all readings.

mod history;
mod model;
#[cfg(test)]
mod tests;

use super::hold::{Hold, Unrelaxed};
use super::law::RelaxationLaw;
use crate::identification::StatedVariance;
use crate::statistics::least_squares::FitSize;
use history::{ForceHistory, Move};
use model::Superposition;

/// The fit of one law. Each pair is a value and its standard error.
#[derive(Clone, Debug, PartialEq)]
pub struct LawFit {
    pub law: RelaxationLaw,
    /// Fraction of the instantaneous force: lost after a long time by the exponential, or at t = (e − 1)t₀ by the logarithm.
    pub share: (f64, f64),
    /// τ or t₀ \[s\].
    pub time: (f64, f64),
    /// Instantaneous force R̂ of each hold \[N\].
    pub reached: Vec<f64>,
    /// The hold with the largest rate at its last reading.
    pub worst: usize,
    /// That rate \[N/s\].
    pub rate: (f64, f64),
    /// Remaining relaxation \[N\]; None for the logarithm, which has no end.
    pub remaining: Option<(f64, f64)>,
    /// Dwell time until its rate is not larger than the requested one \[s\].
    pub required_pause: (f64, f64),
    /// Standard deviation of a reading about the fit \[N\].
    pub scatter: f64,
    /// Degrees of freedom of that scatter: number of readings minus number of parameters.
    pub degrees: f64,
    /// BIC, corrected for few readings (`corrected_bic`).
    pub criterion: f64,
    /// Whether the readings resolve the time: it is neither shorter than they are nor longer than the holds.
    pub resolved: bool,
    /// Fraction of the standard errors that the scatter shows; the rest is stated.
    pub shown: f64,
    moves: Vec<Move>,
    before: f64,
}

/// The fit of one law, or of both.
#[derive(Clone, Debug, PartialEq)]
pub struct SuperpositionFit {
    /// In order of their criterion, the best first.
    pub fits: Vec<LawFit>,
}

impl SuperpositionFit {
    /// The law with the smallest criterion.
    #[must_use]
    pub fn best(&self) -> &LawFit {
        &self.fits[0]
    }

    /// BIC of the exponential minus that of the logarithm: positive if the logarithm fits better. None for one law alone.
    #[must_use]
    pub fn margin(&self) -> Option<f64> {
        let criterion = |law| {
            self.fits
                .iter()
                .find(|fit| fit.law == law)
                .map(|fit| fit.criterion)
        };
        criterion(RelaxationLaw::Exponential)
            .zip(criterion(RelaxationLaw::Logarithmic))
            .map(|(exponential, logarithmic)| exponential - logarithmic)
    }
}

impl LawFit {
    /// Force of a hold `seconds` after its first reading \[N\].
    #[must_use]
    pub fn force(&self, hold: usize, seconds: f64) -> Option<f64> {
        let history = ForceHistory {
            reached: &self.reached,
            moves: &self.moves,
            before: self.before,
        };
        let lost = |since, moved_for| self.law.timed(self.time.0).lost(since, moved_for);
        self.reached
            .get(hold)
            .map(|reached| reached - self.share.0 * history.superposed(hold, seconds, lost))
    }
}

/// Largest value of the number of dwells squared times the readings of one: later dwells are left out.
const MAX_WORK: usize = 4_000_000;

/// Fits the law `asked`, or both. `before` is the relaxed force before the first move \[N\], `rate` the rate of relaxation that is
/// allowed at the end of a hold \[N/s\].
///
/// # Errors
/// There are too few readings, nothing relaxes, or the time of the better law is not resolved.
pub fn fit_superposition(
    holds: &[Hold],
    before: f64,
    asked: Option<RelaxationLaw>,
    rate: f64,
    stated: StatedVariance,
) -> Result<SuperpositionFit, Unrelaxed> {
    let most = holds
        .iter()
        .map(|hold| hold.readings.len())
        .max()
        .unwrap_or(0)
        .max(1);
    let used = (1..=holds.len())
        .rev()
        .find(|count| count * count * most <= MAX_WORK)
        .unwrap_or(1)
        .min(holds.len());
    let problem = Superposition::new(&holds[..used], before, rate, stated);
    #[expect(clippy::cast_precision_loss, reason = "far fewer holds than 2^53")]
    let steady_parameters = used as f64;
    if used == 0 || problem.count <= steady_parameters + 5.0 || problem.longest() <= 0.0 {
        return Err(Unrelaxed::TooFew);
    }
    let laws = RelaxationLaw::BOTH
        .into_iter()
        .filter(|law| asked.is_none_or(|asked| asked == *law));
    let mut fits: Vec<LawFit> = laws.filter_map(|law| problem.fit(law)).collect();
    fits.sort_by(|a, b| a.criterion.total_cmp(&b.criterion));
    let best = fits.first().ok_or(Unrelaxed::Steady)?;
    let steady = problem.floored(holds[..used].iter().map(Hold::squares_about_mean).sum());
    let of_steady = FitSize {
        squares: steady,
        count: problem.count,
        parameters: steady_parameters,
    }
    .corrected_bic();
    if best.criterion >= of_steady {
        return Err(Unrelaxed::Steady);
    }
    if !best.resolved {
        return Err(Unrelaxed::OutOfReach);
    }
    Ok(SuperpositionFit { fits })
}
