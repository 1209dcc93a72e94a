//! By which law a reached force relaxes: exponentially, or with the logarithm of time. In: holds, each with its readings, how long it took
//! to get there, and the force before the first. Out: the law, what it takes and its time with their standard errors, how fast the worst
//! pause was still losing and how long it should have been. It knows no rig.
//!
//! Of the force R̂ that a specimen would have without relaxing, each move brings an increment ΔR̂, and by the time u after it the part
//! `share`·L(u) of that is lost ([`super::law`]); so, in hold h,
//!
//! R(t) = R̂_h − share·Σ_{j ≤ h} (R̂_j − R̂_{j−1})·L(t + T_h − T_j),
//!
//! with one `share` and one time for all holds: n + 2 numbers for n holds, whichever the law. The R̂_h follow one from the other: each by
//! least squares over the readings of its own hold. (That a hold also says a little of the forces before it is left out: it is a part of
//! `share`² of what they say themselves.) Share and time are those of the least squares over all readings.

use nalgebra::{Matrix2, Vector2};

use super::fit::{Hold, Unrelaxed};
use super::law::RelaxationLaw;
use crate::identification::StatedVariance;

/// What the readings tell of one law.
#[derive(Clone, Debug, PartialEq)]
pub struct LawFit {
    pub law: RelaxationLaw,
    /// Of a reached force: lost after long by the exponential, or at t = (e − 1)t₀ by the logarithm; with its standard error, as all that
    /// follow.
    pub share: (f64, f64),
    /// τ or t₀, s.
    pub time: (f64, f64),
    /// R̂ of each hold, N.
    pub reached: Vec<f64>,
    /// The hold that was losing fastest at its last reading.
    pub worst: usize,
    /// How fast, N/s.
    pub rate: (f64, f64),
    /// Force that it had still to lose, N: none by the logarithm, which has no end.
    pub remaining: Option<(f64, f64)>,
    /// s, until it would have lost no faster than asked.
    pub needed_pause: (f64, f64),
    /// Standard deviation of a reading about the fit, N.
    pub scatter: f64,
    /// Degrees of freedom of that scatter: the readings less all that was found.
    pub degrees: f64,
    /// BIC, as McQuarrie corrects it for few readings.
    pub criterion: f64,
    /// Whether the readings tell the time at all: it is neither shorter than they are nor longer than the holds.
    pub told: bool,
    /// Fraction of the standard errors that the scatter shows; the rest is stated.
    pub shown: f64,
    moves: Vec<Move>,
    before: f64,
}

/// One law, or the better one of both.
#[derive(Clone, Debug, PartialEq)]
pub struct ReachedFit {
    /// The best first.
    pub fits: Vec<LawFit>,
}

impl ReachedFit {
    /// Results that are known by its scatter.
    pub const RESULTS: [&str; 6] = [
        "time_constant",
        "remaining_relaxation",
        "needed_pause",
        "relaxation_share",
        "reference_time",
        "relaxation_rate",
    ];

    /// What the readings are told by.
    #[must_use]
    pub fn best(&self) -> &LawFit {
        &self.fits[0]
    }

    /// BIC of the exponential less that of the logarithm: above zero the logarithm tells the readings better. None of one law alone.
    #[must_use]
    pub fn margin(&self) -> Option<f64> {
        let of = |law| {
            self.fits
                .iter()
                .find(|fit| fit.law == law)
                .map(|fit| fit.criterion)
        };
        of(RelaxationLaw::Exponential)
            .zip(of(RelaxationLaw::Logarithmic))
            .map(|(one, other)| one - other)
    }
}

impl LawFit {
    /// Force of a hold `seconds` after its first reading, N.
    #[must_use]
    pub fn force(&self, hold: usize, seconds: f64) -> Option<f64> {
        let state = State {
            reached: &self.reached,
            moves: &self.moves,
            before: self.before,
        };
        let lost = |since, moved_for| self.law.lost(since, moved_for, self.time.0);
        self.reached
            .get(hold)
            .map(|reached| reached - self.share.0 * state.sum(hold, seconds, lost))
    }
}

/// Holds times holds times readings of one, at most: what comes after that is left out.
const MOST_WORK: usize = 4_000_000;
/// Times tried first, over all that the readings could tell.
const TRIED: u32 = 14;
/// Steps of Gauss and Newton from the best of them.
const MOST_STEPS: usize = 40;
/// Scatter below this share of the largest force is rounding and no relaxation.
const ROUNDING: f64 = 1e-10;
/// No relaxation takes more than this of a force by a law's unit of share.
const MOST_SHARE: f64 = 0.999;

/// BIC with the correction of McQuarrie (*A small-sample correction for the Schwarz SIC model selection criterion*, Statistics &
/// Probability Letters 44 (1999) 79–86): n ln(S/n) + k ln n · n/(n − k − 2); without end where there are too few readings.
#[must_use]
pub fn corrected_bic(squares: f64, count: f64, numbers: f64) -> f64 {
    let left = count - numbers - 2.0;
    if left <= 0.0 {
        f64::INFINITY
    } else {
        count * (squares / count).ln() + numbers * count.ln() * count / left
    }
}

/// Fits the law `asked`, or both. `before` is the force before the first move, which had time to relax, N; `rate` (N/s) is how fast a pause
/// may still lose at its end.
///
/// # Errors
/// There are too few readings, nothing relaxes, or the better law's time is out of reach.
pub fn fit_reached(
    holds: &[Hold],
    before: f64,
    asked: Option<RelaxationLaw>,
    rate: f64,
) -> Result<ReachedFit, Unrelaxed> {
    fit_reached_stated(holds, before, asked, rate, StatedVariance::default())
}

/// The same of readings with stated errors.
///
/// # Errors
/// There are too few readings, nothing relaxes, or the better law's time is out of reach.
pub fn fit_reached_stated(
    holds: &[Hold],
    before: f64,
    asked: Option<RelaxationLaw>,
    rate: f64,
    stated: StatedVariance,
) -> Result<ReachedFit, Unrelaxed> {
    let most = holds
        .iter()
        .map(|hold| hold.readings.len())
        .max()
        .unwrap_or(0)
        .max(1);
    let used = (1..=holds.len())
        .rev()
        .find(|count| count * count * most <= MOST_WORK)
        .unwrap_or(1)
        .min(holds.len());
    let problem = Problem::new(&holds[..used], before, rate, stated);
    #[expect(clippy::cast_precision_loss, reason = "far fewer holds than 2^53")]
    let numbers = used as f64;
    if used == 0 || problem.count <= numbers + 5.0 || problem.longest <= 0.0 {
        return Err(Unrelaxed::TooFew);
    }
    let laws = RelaxationLaw::BOTH
        .into_iter()
        .filter(|law| asked.is_none_or(|asked| asked == *law));
    let mut fits: Vec<LawFit> = laws.filter_map(|law| problem.fit(law)).collect();
    fits.sort_by(|a, b| a.criterion.total_cmp(&b.criterion));
    let best = fits.first().ok_or(Unrelaxed::Steady)?;
    if best.criterion >= corrected_bic(problem.floored(problem.steady()), problem.count, numbers) {
        return Err(Unrelaxed::Steady);
    }
    if !best.told {
        return Err(Unrelaxed::OutOfReach);
    }
    Ok(ReachedFit { fits })
}

/// A move, its end, and the instant of the first reading after it, s.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Move {
    took: f64,
    ended: f64,
    read_from: f64,
}

/// Forces that were reached, in time.
struct State<'a> {
    reached: &'a [f64],
    moves: &'a [Move],
    before: f64,
}

impl State<'_> {
    /// Σ ΔR̂ⱼ·`of`(time since the end of move j, its length) over the moves up to `hold`, `seconds` after its first reading.
    fn sum(&self, hold: usize, seconds: f64, of: impl Fn(f64, f64) -> f64) -> f64 {
        let now = self.moves[hold].read_from + seconds;
        let steps = self.reached[..=hold]
            .iter()
            .scan(self.before, |last, reached| {
                let step = reached - *last;
                *last = *reached;
                Some(step)
            });
        steps
            .zip(self.moves)
            .map(|(step, moved)| step * of(now - moved.ended, moved.took))
            .sum()
    }
}

struct Problem<'a> {
    holds: &'a [Hold],
    moves: Vec<Move>,
    before: f64,
    /// N/s
    rate: f64,
    errors: StatedVariance,
    count: f64,
    /// First time after nothing, and last, of the readings, s.
    shortest: f64,
    longest: f64,
    largest: f64,
}

impl<'a> Problem<'a> {
    fn new(holds: &'a [Hold], before: f64, rate: f64, errors: StatedVariance) -> Self {
        let mut now = 0.0;
        let moves = holds.iter().map(|hold| {
            let took = hold.moved_for.max(0.0);
            let ended = now + hold.waited_for + took;
            let read_from = ended + hold.settled_for;
            now = read_from + hold.readings.last().map_or(0.0, |(time, _)| *time);
            Move {
                took,
                ended,
                read_from,
            }
        });
        let readings = || holds.iter().flat_map(|hold| &hold.readings);
        #[expect(clippy::cast_precision_loss, reason = "far fewer readings than 2^53")]
        let count = readings().count() as f64;
        Self {
            moves: moves.collect(),
            holds,
            before,
            rate,
            errors,
            count,
            shortest: readings()
                .map(|(time, _)| *time)
                .filter(|time| *time > 0.0)
                .fold(f64::INFINITY, f64::min),
            longest: readings().fold(0.0, |most: f64, (time, _)| most.max(*time)),
            largest: readings().fold(0.0, |most: f64, (_, force)| most.max(force.abs())),
        }
    }

    /// Σ of the squares of readings about the mean of their hold: forces that stay.
    fn steady(&self) -> f64 {
        let of = |hold: &Hold| {
            #[expect(clippy::cast_precision_loss, reason = "far fewer readings than 2^53")]
            let mean = hold.readings.iter().map(|(_, force)| force).sum::<f64>()
                / hold.readings.len().max(1) as f64;
            hold.readings
                .iter()
                .map(|(_, force)| (force - mean).powi(2))
                .sum::<f64>()
        };
        self.holds.iter().map(of).sum()
    }

    /// No squares are smaller than what rounding leaves.
    fn floored(&self, squares: f64) -> f64 {
        squares
            .max(self.count * (ROUNDING * self.largest).powi(2))
            .max(f64::MIN_POSITIVE)
    }

    /// R̂ of the holds, and what the readings have left, for a share and a time: hold by hold, R + share·(lost of earlier steps −
    /// L·R̂_{h−1}) = (1 − share·L)·R̂_h.
    fn solve(&self, law: RelaxationLaw, share: f64, time: f64) -> (Vec<f64>, Vec<f64>) {
        let mut reached: Vec<f64> = Vec::with_capacity(self.holds.len());
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a count"
        )]
        let mut left = Vec::with_capacity(self.count as usize);
        for (hold, readings) in self.holds.iter().enumerate() {
            let last = reached.last().copied().unwrap_or(self.before);
            reached.push(last);
            let state = State {
                reached: &reached,
                moves: &self.moves,
                before: self.before,
            };
            let row = |(seconds, force): &(f64, f64)| {
                let Move {
                    took,
                    ended,
                    read_from,
                } = self.moves[hold];
                let lost = law.lost(read_from - ended + seconds, took, time);
                // The own step counts nothing yet: its R̂ stands at the last one.
                let earlier = state.sum(hold, *seconds, |since, took| law.lost(since, took, time));
                (1.0 - share * lost, force + share * (earlier - lost * last))
            };
            let rows: Vec<(f64, f64)> = readings.readings.iter().map(row).collect();
            let size: f64 = rows.iter().map(|(by, _)| by * by).sum();
            let own = if size > 0.0 {
                rows.iter().map(|(by, of)| by * of).sum::<f64>() / size
            } else {
                last
            };
            left.extend(rows.iter().map(|(by, of)| of - by * own));
            reached[hold] = own;
        }
        (reached, left)
    }

    fn squares(&self, law: RelaxationLaw, share: f64, time: f64) -> f64 {
        self.solve(law, share, time)
            .1
            .iter()
            .map(|left| left * left)
            .sum()
    }

    /// What the readings have left, and how that changes with the share and with ln time.
    fn slopes(&self, law: RelaxationLaw, share: f64, time: f64) -> (Vec<f64>, [Vec<f64>; 2]) {
        let left = self.solve(law, share, time).1;
        let central = |[less, more]: [(f64, f64); 2], width: f64| -> Vec<f64> {
            let [less, more] = [less, more].map(|(share, time)| self.solve(law, share, time).1);
            more.iter()
                .zip(less)
                .map(|(more, less)| (more - less) / width)
                .collect()
        };
        let (by_share, by_time) = (1e-5_f64, 1e-4_f64);
        let first = central(
            [(share - by_share, time), (share + by_share, time)],
            2.0 * by_share,
        );
        let second = central(
            [
                (share, time * (-by_time).exp()),
                (share, time * by_time.exp()),
            ],
            2.0 * by_time,
        );
        (left, [first, second])
    }

    /// The share that leaves least at one time, and what it leaves.
    fn share_at(&self, law: RelaxationLaw, time: f64) -> (f64, f64) {
        let mut share = 0.0;
        for _ in 0..3 {
            let (less, more) = (
                self.solve(law, share, time).1,
                self.solve(law, share + 1e-4, time).1,
            );
            let (mut size, mut along) = (0.0, 0.0);
            for (left, more) in less.iter().zip(more) {
                let by = (more - left) / 1e-4;
                size += by * by;
                along += by * left;
            }
            if size <= 0.0 {
                break;
            }
            share = (share - along / size).clamp(-MOST_SHARE, MOST_SHARE);
        }
        (share, self.squares(law, share, time))
    }

    fn fit(&self, law: RelaxationLaw) -> Option<LawFit> {
        let (low, high) = (0.2 * self.shortest, 30.0 * self.longest);
        let tried = (0..TRIED)
            .map(|index| low * (high / low).powf(f64::from(index) / f64::from(TRIED - 1)));
        let solved = tried.map(|time| (time, self.share_at(law, time)));
        let (mut time, (mut share, mut squares)) = solved.min_by(|a, b| a.1.1.total_cmp(&b.1.1))?;
        for _ in 0..MOST_STEPS {
            let Some(step) = self.step(law, share, time) else {
                break;
            };
            // Half a decade at once, at most: far off, the slopes say little.
            let mut part = (1.2 / step[1].abs()).min(1.0);
            let better = (0..12).find_map(|_| {
                let next = (
                    (share + part * step[0]).clamp(-MOST_SHARE, MOST_SHARE),
                    (time * (part * step[1]).exp()).clamp(low, high),
                );
                part *= 0.5;
                Some((next, self.squares(law, next.0, next.1)))
                    .filter(|(_, found)| *found < squares)
            });
            let Some((next, found)) = better else { break };
            let still = (next.0 - share).abs() < 1e-10 && (next.1 / time).ln().abs() < 1e-9;
            ((share, time), squares) = (next, found);
            if still {
                break;
            }
        }
        let told = time > 1.02 * low && time < 0.98 * high && share > 0.0;
        self.stated(law, share, time, told)
    }

    /// Gauss and Newton's, in the share and ln time.
    fn step(&self, law: RelaxationLaw, share: f64, time: f64) -> Option<[f64; 2]> {
        let (left, by) = self.slopes(law, share, time);
        let along = Vector2::from_fn(|index, _| {
            by[index]
                .iter()
                .zip(&left)
                .map(|(by, left)| by * left)
                .sum::<f64>()
        });
        let step = -(inverse(&by)? * along);
        Some([step[0], step[1]])
    }

    fn stated(&self, law: RelaxationLaw, share: f64, time: f64, told: bool) -> Option<LawFit> {
        #[expect(clippy::cast_precision_loss, reason = "far fewer holds than 2^53")]
        let numbers = self.holds.len() as f64 + 2.0;
        let (left, by) = self.slopes(law, share, time);
        let squares: f64 = left.iter().map(|left| left * left).sum();
        let (variance, shown) = self.errors.counted(squares / (self.count - numbers), 0.0);
        let normal = inverse(&by)?;
        let effect = |of: &dyn Fn(f64, f64) -> f64| {
            let (by_share, by_time) = (1e-5_f64, 1e-4_f64);
            Vector2::new(
                (of(share + by_share, time) - of(share - by_share, time)) / (2.0 * by_share),
                (of(share, time * by_time.exp()) - of(share, time * (-by_time).exp()))
                    / (2.0 * by_time),
            )
        };
        let error = |of: &dyn Fn(f64, f64) -> f64| {
            let effect = effect(of);
            (effect.transpose() * normal * effect)[(0, 0)]
                .max(0.0)
                .sqrt()
                * variance.sqrt()
        };
        let (reached, _) = self.solve(law, share, time);
        let last = |hold: usize| {
            self.holds[hold]
                .readings
                .last()
                .map_or(0.0, |(time, _)| *time)
        };
        let losing = |share: f64, time: f64, hold: usize, reached: &[f64], seconds: f64| {
            let state = State {
                reached,
                moves: &self.moves,
                before: self.before,
            };
            (share * state.sum(hold, seconds, |since, took| law.rate(since, took, time))).abs()
        };
        let at_end = |hold: usize| losing(share, time, hold, &reached, last(hold));
        let worst = (0..self.holds.len()).max_by(|a, b| at_end(*a).total_cmp(&at_end(*b)))?;
        let rate = |share: f64, time: f64| {
            losing(
                share,
                time,
                worst,
                &self.solve(law, share, time).0,
                last(worst),
            )
        };
        let needed = |share: f64, time: f64| {
            let reached = self.solve(law, share, time).0;
            slow_enough(self.rate, last(worst), |seconds| {
                losing(share, time, worst, &reached, seconds)
            })
        };
        let remaining = |share: f64, time: f64| {
            let reached = self.solve(law, share, time).0;
            let state = State {
                reached: &reached,
                moves: &self.moves,
                before: self.before,
            };
            (share
                * state.sum(worst, last(worst), |since, took| {
                    1.0 - law.lost(since, took, time)
                }))
            .abs()
        };
        let ends = law == RelaxationLaw::Exponential;
        Some(LawFit {
            law,
            share: (share, error(&|share, _| share)),
            time: (time, error(&|_, time| time)),
            worst,
            rate: (rate(share, time), error(&rate)),
            remaining: ends.then(|| (remaining(share, time), error(&remaining))),
            needed_pause: (needed(share, time), error(&needed)),
            scatter: variance.sqrt(),
            degrees: self.count - numbers,
            criterion: corrected_bic(self.floored(squares), self.count, numbers),
            told,
            shown,
            moves: self.moves.clone(),
            before: self.before,
            reached,
        })
    }
}

/// s until `losing` is no more than `rate` (N/s) and stays so: by doubling, then by halving.
fn slow_enough(rate: f64, pause: f64, losing: impl Fn(f64) -> f64) -> f64 {
    if losing(0.0) <= rate {
        return 0.0;
    }
    let mut high = pause.max(f64::MIN_POSITIVE);
    while losing(high) > rate && high < 1e18 {
        high *= 2.0;
    }
    let mut low = 0.0;
    for _ in 0..90 {
        let middle = 0.5 * (low + high);
        if losing(middle) > rate {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// Of Σ of the squares and products of two columns; None where they are one.
fn inverse(columns: &[Vec<f64>; 2]) -> Option<Matrix2<f64>> {
    let product = |one: usize, other: usize| {
        columns[one]
            .iter()
            .zip(&columns[other])
            .map(|(one, other)| one * other)
            .sum::<f64>()
    };
    let sizes = [product(0, 0).sqrt(), product(1, 1).sqrt()];
    if sizes.iter().any(|size| *size <= 0.0) {
        return None;
    }
    let together = product(0, 1) / (sizes[0] * sizes[1]);
    let unit = Matrix2::new(1.0, together, together, 1.0).try_inverse()?;
    let scale = Matrix2::from_diagonal(&Vector2::new(1.0 / sizes[0], 1.0 / sizes[1]));
    Some(scale * unit * scale)
}
