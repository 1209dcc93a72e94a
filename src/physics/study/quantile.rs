//! Quantiles of a result, with intervals that hold for any distribution. In: the results of all runs. Out: the value below which a share of
//! the runs lies, and its interval. It fits no distribution.

use super::probability::binomial::{at_least, at_most};
use super::{Confidence, number};

/// A quantile with its interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantile {
    /// As estimated, if the runs without a result were all below, and if they were all above. Equal if every run has a result. None:
    /// beyond all results.
    pub estimates: [Option<f64>; 2],
    /// Lower and upper end. None: the study is too small to bound this side.
    pub interval: [Option<f64>; 2],
}

/// The quantile of `probability` of sorted `results`, beside `no_result` runs without one.
///
/// Each end is a result: with B failures of n runs at this probability, fewer than l of them lie below result l with ½α at most (H. A.
/// David, H. N. Nagaraja, *Order Statistics*, 2003, sec. 7.1). The interval contains the true quantile at least with its confidence.
///
/// # Panics
/// If the results are not sorted, or the probability is not between 0 and 1.
#[must_use]
pub fn quantile(
    results: &[f64],
    no_result: u64,
    probability: f64,
    confidence: Confidence,
) -> Quantile {
    assert!(results.is_sorted(), "results in their order");
    assert!(probability > 0.0 && probability < 1.0, "{probability}");
    let runs = results.len() as u64 + no_result;
    let tail = 0.5 * confidence.error();
    // The largest rank with P(B < rank) ≤ ½α, and the smallest with P(B ≥ rank) ≤ ½α.
    let low = first(runs, |rank| at_most(rank, runs, probability) > tail);
    let high = first(runs + 1, |rank| at_least(rank, runs, probability) <= tail);
    let middle = first(runs, |rank| number(rank) >= probability * number(runs)).max(1);
    // A run without a result counts as below all others for the lower end and as above them for the upper end.
    let at = |rank: u64| {
        let index = rank
            .checked_sub(1)
            .and_then(|index| usize::try_from(index).ok());
        index.and_then(|index| results.get(index).copied())
    };
    let below = |rank: u64| at(rank.saturating_sub(no_result));
    Quantile {
        estimates: [below(middle), at(middle)],
        interval: [below(low), at(high)],
    }
}

/// The smallest rank up to `last` that has a property which all larger ranks have too; `last` if none before it has.
fn first(last: u64, has: impl Fn(u64) -> bool) -> u64 {
    let (mut low, mut high) = (0, last);
    while low < high {
        let middle = low + (high - low) / 2;
        if has(middle) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::super::sampling::philox::{Philox, Purpose};
    use super::*;

    fn study(seed: u64, runs: u64) -> Vec<f64> {
        let stream = Philox::new(seed);
        let mut results: Vec<f64> = (0..runs)
            .map(|run| stream.uniform(Purpose::Value, run, 0))
            .collect();
        results.sort_by(f64::total_cmp);
        results
    }

    /// David and Nagaraja's ranks for the median of ten at 95 %: the second and the ninth, confidence 0.9785.
    #[test]
    fn ranks_are_the_published_ones() {
        let results: Vec<f64> = (1..=10).map(f64::from).collect();
        let confidence = Confidence::new(0.95).unwrap();
        let median = quantile(&results, 0, 0.5, confidence);
        assert_eq!(median.interval, [Some(2.0), Some(9.0)]);
        assert_eq!(median.estimates, [Some(5.0); 2]);
        // Ten runs bound no upper 95 % quantile.
        let upper = quantile(&results, 0, 0.95, confidence);
        assert_eq!((upper.interval[1], upper.estimates[1]), (None, Some(10.0)));
        assert_eq!(quantile(&[], 0, 0.5, confidence).interval, [None; 2]);
    }

    /// Uniform results have the quantile p. Of 1000 studies of 200 runs, at least 95 % of the intervals contain it.
    #[test]
    fn intervals_cover_the_truth() {
        let confidence = Confidence::new(0.95).unwrap();
        for p in [0.05, 0.5, 0.95] {
            let covered = (0..1000)
                .filter(|seed| {
                    let [low, high] = quantile(&study(*seed, 200), 0, p, confidence).interval;
                    low.is_some_and(|low| low <= p) && high.is_some_and(|high| high >= p)
                })
                .count();
            assert!(covered >= 950, "{covered} at {p}");
        }
    }

    /// With runs lost at random, the interval still holds, and it holds if only the largest results are lost.
    #[test]
    fn lost_runs_widen_the_interval() {
        let confidence = Confidence::new(0.95).unwrap();
        let all = study(1, 1000);
        let whole = quantile(&all, 0, 0.9, confidence);
        let lost = quantile(&all[..980], 20, 0.9, confidence);
        assert_eq!(lost.interval[1], whole.interval[1]);
        assert!(lost.interval[0] < whole.interval[0]);
        assert!(lost.estimates[0] < whole.estimates[0]);
        // 20 of 1000 lost: the quantile of 99 % may be one of them.
        assert_eq!(
            quantile(&all[..980], 20, 0.99, confidence).estimates[1],
            None
        );
    }
}
