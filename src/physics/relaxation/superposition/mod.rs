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

#[cfg(test)]
mod tests;

use crate::identification::StatedVariance;
use crate::relaxation::hold::{Extent, Hold, Unrelaxed, geometric};
use crate::relaxation::law::RelaxationLaw;
use crate::statistics::least_squares::{
    Covariance, FitSize, Residuals, central_jacobian, minimize,
};
use nalgebra::{DMatrix, DVector};

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

/// A move to a hold.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Move {
    /// Duration \[s\].
    pub took: f64,
    /// Instant of its end \[s\].
    pub ended: f64,
    /// Instant of the first reading after it \[s\].
    pub read_from: f64,
}

/// The moves to these holds, in time from the begin of the first.
fn moves(holds: &[Hold]) -> Vec<Move> {
    let mut now = 0.0;
    let moves = holds.iter().map(|hold| {
        let took = hold.moved_for.max(0.0);
        let ended = now + hold.waited_for + took;
        let read_from = ended + hold.settled_for;
        now = read_from + hold.duration();
        Move {
            took,
            ended,
            read_from,
        }
    });
    moves.collect()
}

/// Instantaneous forces of holds, in time.
struct ForceHistory<'a> {
    /// R̂ of each hold \[N\].
    pub reached: &'a [f64],
    pub moves: &'a [Move],
    /// Force before the first move \[N\].
    pub before: f64,
}

impl ForceHistory<'_> {
    /// Σ ΔR̂ⱼ·`kernel`(time since the end of move j, its duration) over the moves up to `hold`, `seconds` after its first reading.
    pub fn superposed(&self, hold: usize, seconds: f64, kernel: impl Fn(f64, f64) -> f64) -> f64 {
        let now = self.moves[hold].read_from + seconds;
        let increments = self.reached[..=hold]
            .iter()
            .scan(self.before, |last, reached| {
                let increment = reached - *last;
                *last = *reached;
                Some(increment)
            });
        increments
            .zip(self.moves)
            .map(|(increment, moved)| increment * kernel(now - moved.ended, moved.took))
            .sum()
    }
}

/// Times tried first, over the range that the readings resolve.
const TRIED: u32 = 14;
/// Scatter below this fraction of the largest force is rounding and not relaxation.
const ROUNDING: f64 = 1e-10;
/// The largest fraction of a force that is lost in the unit of a law.
const MAX_SHARE: f64 = 0.999;
/// Largest change of ln t in one step, half a decade: farther off the linearisation does not hold.
const LONGEST_STEP: f64 = 1.2;
/// Half widths of central differences, in share and ln t.
const WIDTHS: [f64; 2] = [1e-5, 1e-4];

/// Holds in time, and the errors of their readings.
struct Superposition<'a> {
    holds: &'a [Hold],
    moves: Vec<Move>,
    /// Force before the first move \[N\].
    before: f64,
    /// Rate of relaxation that is allowed \[N/s\].
    rate: f64,
    errors: StatedVariance,
    /// Number of readings.
    pub count: f64,
    extent: Extent,
}

/// Instantaneous forces, and the residuals of the readings \[N\].
struct Solved {
    reached: Vec<f64>,
    left: Vec<f64>,
}

/// Share \[1\] and time \[s\] of a law.
#[derive(Clone, Copy, Debug)]
struct Relaxation {
    share: f64,
    time: f64,
}

impl Relaxation {
    /// From the parameters share and ln t.
    fn new(parameters: &DVector<f64>) -> Self {
        Self {
            share: parameters[0],
            time: parameters[1].exp(),
        }
    }

    fn parameters(self) -> DVector<f64> {
        DVector::from_vec(vec![self.share, self.time.ln()])
    }
}

/// One law over share and ln t.
struct LawModel<'a> {
    problem: &'a Superposition<'a>,
    law: RelaxationLaw,
}

impl Residuals for LawModel<'_> {
    fn residuals(&self, parameters: &DVector<f64>) -> Option<DVector<f64>> {
        let solved = self.problem.solve(self.law, Relaxation::new(parameters));
        Some(DVector::from_vec(solved.left))
    }

    fn jacobian(&self, parameters: &DVector<f64>) -> Option<DMatrix<f64>> {
        central_jacobian(self, parameters, &WIDTHS)
    }

    fn longest_fraction(&self, step: &DVector<f64>) -> f64 {
        (LONGEST_STEP / step[1].abs()).min(1.0)
    }

    fn bounded(&self, parameters: DVector<f64>) -> DVector<f64> {
        let (low, high) = self.problem.extent.resolvable();
        DVector::from_vec(vec![
            parameters[0].clamp(-MAX_SHARE, MAX_SHARE),
            parameters[1].clamp(low.ln(), high.ln()),
        ])
    }
}

impl<'a> Superposition<'a> {
    pub fn new(holds: &'a [Hold], before: f64, rate: f64, errors: StatedVariance) -> Self {
        let extent = Extent::new(holds);
        #[expect(clippy::cast_precision_loss, reason = "far fewer readings than 2^53")]
        let count = extent.count as f64;
        Self {
            moves: moves(holds),
            holds,
            before,
            rate,
            errors,
            count,
            extent,
        }
    }

    /// The longest time after a first reading \[s\].
    pub fn longest(&self) -> f64 {
        self.extent.longest
    }

    /// Limits a sum of squares to at least the rounding error.
    pub fn floored(&self, squares: f64) -> f64 {
        squares
            .max(self.count * (ROUNDING * self.extent.largest_force).powi(2))
            .max(f64::MIN_POSITIVE)
    }

    fn history<'r>(&'r self, reached: &'r [f64]) -> ForceHistory<'r> {
        ForceHistory {
            reached,
            moves: &self.moves,
            before: self.before,
        }
    }

    /// R̂ of the holds one after the other, each by least squares over its own readings:
    /// R + share·(lost of earlier increments − L·R̂_{h−1}) = (1 − share·L)·R̂_h.
    fn solve(&self, law: RelaxationLaw, Relaxation { share, time }: Relaxation) -> Solved {
        let mut reached: Vec<f64> = Vec::with_capacity(self.holds.len());
        let mut left = Vec::with_capacity(self.extent.count);
        for (index, hold) in self.holds.iter().enumerate() {
            let last = reached.last().copied().unwrap_or(self.before);
            // R̂ of this hold is that of the last one at first, so that its increment is zero.
            reached.push(last);
            let history = self.history(&reached);
            let Move {
                took,
                ended,
                read_from,
            } = self.moves[index];
            let row = |(seconds, force): &(f64, f64)| {
                let lost = law.timed(time).lost(read_from - ended + seconds, took);
                let earlier = history.superposed(index, *seconds, |since, took| {
                    law.timed(time).lost(since, took)
                });
                (1.0 - share * lost, force + share * (earlier - lost * last))
            };
            let rows: Vec<(f64, f64)> = hold.readings.iter().map(row).collect();
            let size: f64 = rows.iter().map(|(by, _)| by * by).sum();
            let own = if size > 0.0 {
                rows.iter().map(|(by, force)| by * force).sum::<f64>() / size
            } else {
                last
            };
            left.extend(rows.iter().map(|(by, force)| force - by * own));
            reached[index] = own;
        }
        Solved { reached, left }
    }

    /// The share of least squares at one time, by three steps of Newton's method, and those squares.
    fn share_at(&self, law: RelaxationLaw, time: f64) -> (Relaxation, f64) {
        const WIDTH: f64 = 1e-4;
        let left = |share: f64| self.solve(law, Relaxation { share, time }).left;
        let mut share = 0.0;
        for _ in 0..3 {
            let (mut size, mut along) = (0.0, 0.0);
            for (left, shifted) in left(share).into_iter().zip(left(share + WIDTH)) {
                let by = (shifted - left) / WIDTH;
                size += by * by;
                along += by * left;
            }
            if size <= 0.0 {
                break;
            }
            share = (share - along / size).clamp(-MAX_SHARE, MAX_SHARE);
        }
        let squares = left(share).iter().map(|left| left * left).sum();
        (Relaxation { share, time }, squares)
    }

    /// Least squares over share and time; None if the readings do not determine them separately.
    pub fn fit(&self, law: RelaxationLaw) -> Option<LawFit> {
        let (low, high) = self.extent.resolvable();
        let (start, _) = geometric(low, high, TRIED)
            .map(|time| self.share_at(law, time))
            .min_by(|a, b| a.1.total_cmp(&b.1))?;
        let model = LawModel { problem: self, law };
        let optimum = minimize(&model, start.parameters())?;
        let Relaxation { share, time } = Relaxation::new(&optimum);
        let resolved = time > 1.02 * low && time < 0.98 * high && share > 0.0;
        self.described(&model, &optimum, resolved)
    }

    fn described(
        &self,
        model: &LawModel<'_>,
        optimum: &DVector<f64>,
        resolved: bool,
    ) -> Option<LawFit> {
        let law = model.law;
        #[expect(clippy::cast_precision_loss, reason = "far fewer holds than 2^53")]
        let parameters = self.holds.len() as f64 + 2.0;
        let degrees = self.count - parameters;
        let squares = model.residuals(optimum)?.norm_squared();
        let jacobian = model.jacobian(optimum)?;
        let (variance, shown) = self.errors.counted(squares / degrees, 0.0);
        let covariance = Covariance::of_normal(&jacobian.tr_mul(&jacobian), variance)?;
        let known = |result: &dyn Fn(Relaxation) -> f64| {
            let gradient = DVector::from_fn(2, |index, _| {
                let shifted = |by: f64| {
                    let mut shifted = optimum.clone();
                    shifted[index] += by;
                    result(Relaxation::new(&shifted))
                };
                (shifted(WIDTHS[index]) - shifted(-WIDTHS[index])) / (2.0 * WIDTHS[index])
            });
            (
                result(Relaxation::new(optimum)),
                covariance.error(&gradient),
            )
        };
        let found = Relaxation::new(optimum);
        let reached = self.solve(law, found).reached;
        let rate_at_end =
            |hold: usize| self.rate_of(law, found, &reached, hold, self.holds[hold].duration());
        let worst =
            (0..self.holds.len()).max_by(|a, b| rate_at_end(*a).total_cmp(&rate_at_end(*b)))?;
        let duration = self.holds[worst].duration();
        let rate = |relaxation: Relaxation| {
            let reached = self.solve(law, relaxation).reached;
            self.rate_of(law, relaxation, &reached, worst, duration)
        };
        let required_pause = |relaxation: Relaxation| {
            let reached = self.solve(law, relaxation).reached;
            slow_enough(self.rate, duration, |seconds| {
                self.rate_of(law, relaxation, &reached, worst, seconds)
            })
        };
        let remaining = |relaxation: Relaxation| {
            let reached = self.solve(law, relaxation).reached;
            let left = |since, took| 1.0 - law.timed(relaxation.time).lost(since, took);
            let history = self.history(&reached);
            (relaxation.share * history.superposed(worst, duration, left)).abs()
        };
        let ends = law == RelaxationLaw::Exponential;
        Some(LawFit {
            law,
            share: known(&|relaxation| relaxation.share),
            time: known(&|relaxation| relaxation.time),
            worst,
            rate: known(&rate),
            remaining: ends.then(|| known(&remaining)),
            required_pause: known(&required_pause),
            scatter: variance.sqrt(),
            degrees,
            criterion: FitSize {
                squares: self.floored(squares),
                count: self.count,
                parameters,
            }
            .corrected_bic(),
            resolved,
            shown,
            moves: self.moves.clone(),
            before: self.before,
            reached,
        })
    }

    /// Rate of relaxation of a hold `seconds` after its first reading, in absolute value \[N/s\].
    fn rate_of(
        &self,
        law: RelaxationLaw,
        Relaxation { share, time }: Relaxation,
        reached: &[f64],
        hold: usize,
        seconds: f64,
    ) -> f64 {
        let rate = |since, took| law.timed(time).rate(since, took);
        (share * self.history(reached).superposed(hold, seconds, rate)).abs()
    }
}

/// Seconds until `rate_after` is at most `rate` \[N/s\] and remains so: by doubling, then by bisection.
fn slow_enough(rate: f64, first: f64, rate_after: impl Fn(f64) -> f64) -> f64 {
    if rate_after(0.0) <= rate {
        return 0.0;
    }
    let mut high = first.max(f64::MIN_POSITIVE);
    while rate_after(high) > rate && high < 1e18 {
        high *= 2.0;
    }
    let mut low = 0.0;
    for _ in 0..90 {
        let middle = 0.5 * (low + high);
        if rate_after(middle) > rate {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}
