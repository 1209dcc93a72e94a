//! The exact interval of a probability. In: failures, independent runs, a level of confidence. Out: the interval.
//!
//! C. J. Clopper, E. S. Pearson, *The use of confidence or fiducial limits illustrated in the case of the binomial*, Biometrika 26 (1934)
//! 404–413. Each limit is the probability for which so many failures, or so few, occur with ½α. The interval contains the true
//! probability at least with its confidence, for any number of runs.

use super::binomial::{at_least, at_most, exactly};
use crate::study::{Confidence, Interval, number};

/// Of `failed` of `runs`. Without runs it is everything.
///
/// # Panics
/// If more failed than ran.
#[must_use]
pub fn interval(failed: u64, runs: u64, confidence: Confidence) -> Interval {
    assert!(failed <= runs, "{failed} of {runs} failed");
    let tail = 0.5 * confidence.error();
    Interval {
        low: lower_limit(failed, runs, tail),
        high: upper_limit(failed, runs, tail),
    }
}

/// Fewest runs without a failure that show a probability below `limit`, one-sided: 59 for 5 % with 95 % confidence (S. S. Wilks, 1941).
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a positive whole number; more than 2^64 are as many as can be counted"
)]
pub fn fewest_clean_runs(limit: f64, confidence: Confidence) -> u64 {
    (confidence.error().ln() / (-limit).ln_1p()).ceil() as u64
}

fn lower_limit(failed: u64, runs: u64, tail: f64) -> f64 {
    if failed == 0 {
        return 0.0;
    }
    if failed == runs {
        return tail.powf(1.0 / number(runs));
    }
    let k = number(failed);
    solved([0.0, k / number(runs)], true, |p| {
        let above = at_least(failed, runs, p);
        let slope = k / p * exactly(failed, runs, p);
        [(above / tail).ln(), slope / above]
    })
}

fn upper_limit(failed: u64, runs: u64, tail: f64) -> f64 {
    if failed == runs {
        return 1.0;
    }
    if failed == 0 {
        return -(tail.ln() / number(runs)).exp_m1();
    }
    let left = number(runs - failed);
    solved([number(failed) / number(runs), 1.0], false, |p| {
        let below = at_most(failed, runs, p);
        let slope = left / (1.0 - p) * exactly(failed, runs, p);
        [(below / tail).ln(), -slope / below]
    })
}

/// The root of a function that rises or falls, given with its slope, between two limits: Newton's method, by halves where it leaves them.
fn solved([mut low, mut high]: [f64; 2], rises: bool, function: impl Fn(f64) -> [f64; 2]) -> f64 {
    let mut at = 0.5 * (low + high);
    for _ in 0..200 {
        let [value, slope] = function(at);
        if (value < 0.0) == rises {
            low = at;
        } else {
            high = at;
        }
        let step = at - value / slope;
        let next = if step > low && step < high {
            step
        } else {
            0.5 * (low + high)
        };
        if (next - at).abs() <= 1e-14 * at {
            return next;
        }
        at = next;
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(level: f64) -> Confidence {
        Confidence::new(level).unwrap()
    }

    /// The limits are those of the paper's charts and of every later table; these were solved from the tails with forty digits (mpmath 1.3).
    #[test]
    fn limits_are_the_published_ones() {
        for (failed, runs, confidence, limits) in [
            (
                5,
                10,
                0.95,
                [0.187_086_028_447_398_52, 0.812_913_971_552_601_5],
            ),
            (
                2,
                100,
                0.95,
                [0.002_431_336_823_942_542_3, 0.070_383_932_471_070_12],
            ),
            (
                20,
                1000,
                0.99,
                [0.010_398_390_515_073_607, 0.034_413_768_123_025_6],
            ),
        ] {
            let found = interval(failed, runs, level(confidence));
            for (found, published) in [found.low, found.high].into_iter().zip(limits) {
                assert!(
                    (found / published - 1.0).abs() < 1e-11,
                    "{found} is not {published}"
                );
            }
        }
    }

    /// In closed form: 1 − (½α)^(1/n) without failures, (½α)^(1/n) without a success.
    #[test]
    fn no_failure_gives_an_upper_limit_above_zero() {
        let none = interval(0, 10, level(0.95));
        assert_eq!(none.low, 0.0);
        assert!((none.high - 0.308_497_107_818_760_8).abs() < 1e-15);
        let all = interval(10, 10, level(0.95));
        assert!((all.low - (1.0 - none.high)).abs() < 1e-15);
        assert_eq!(all.high, 1.0);
        assert_eq!(fewest_clean_runs(0.05, level(0.95)), 59);
        // One-sided at 95 %: 58 clean runs leave more than 5 %.
        assert!(interval(0, 59, level(0.9)).high < 0.05 && interval(0, 58, level(0.9)).high > 0.05);
    }

    /// The chance that the interval of a study misses p is at most α, summed exactly over all outcomes.
    #[test]
    fn coverage_is_at_least_nominal_for_every_probability() {
        let runs = 50;
        let intervals: Vec<Interval> = (0..=runs)
            .map(|failed| interval(failed, runs, level(0.95)))
            .collect();
        for part in 1..200 {
            let p = f64::from(part) / 200.0;
            let covered: f64 = (0..=runs)
                .zip(&intervals)
                .filter(|(_, interval)| interval.contains(p))
                .map(|(failed, _)| exactly(failed, runs, p))
                .sum();
            assert!(covered > 0.95, "{covered} at {p}");
        }
    }

    /// 20 million failures of a billion: the normal interval, 0.02 ± 1.96 √(0.0196/10⁹), to a thousandth of its width.
    #[test]
    fn a_billion_runs_have_an_interval() {
        let found = interval(20_000_000, 1_000_000_000, level(0.95));
        let half = 1.959_964 * (0.0196_f64 / 1e9).sqrt();
        assert!((found.half_width() / half - 1.0).abs() < 1e-3);
        assert!((found.low - (0.02 - half)).abs() < 1e-3 * half);
    }
}
