//! The probability that a requirement fails. In: how many runs failed, passed or had no result. Out: the probability with an exact
//! interval, and the verdict against a limit. It runs nothing and knows no requirement.
//!
//! A run without a result is neither a failure nor a success. It is not dropped: the probability lies between that of the failures and that
//! of the failures with the runs without a result.

pub(super) mod binomial;
pub mod clopper_pearson;
pub mod stopping;

use super::{Confidence, Interval, number};

/// Outcomes of runs, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcomes {
    pub passed: u64,
    pub failed: u64,
    pub no_result: u64,
}

/// What a study says about a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decision {
    /// The probability is below the limit.
    Met,
    /// It is not.
    NotMet,
    /// There are too few runs, or too many without a result.
    Undecided,
}

impl Outcomes {
    #[must_use]
    pub const fn runs(&self) -> u64 {
        self.passed + self.failed + self.no_result
    }

    /// The probability of failure as estimated, if no run without a result would have failed, and if all of them would have. Equal
    /// if every run has a result; None without runs.
    #[must_use]
    pub fn estimates(&self) -> Option<[f64; 2]> {
        let share = |count| number(count) / number(self.runs());
        (self.runs() > 0).then(|| [self.failed, self.failed + self.no_result].map(share))
    }

    /// The interval of the probability of failure, whatever the runs without a result would have shown. Without failures its lower end
    /// is 0, its upper end is not.
    #[must_use]
    pub fn interval(&self, confidence: Confidence) -> Interval {
        let runs = self.runs();
        let [least, most] = [self.failed, self.failed + self.no_result]
            .map(|failed| clopper_pearson::interval(failed, runs, confidence));
        Interval {
            low: least.low,
            high: most.high,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::sampling::philox::{Philox, Purpose};
    use super::*;

    const RUNS: u64 = 400;

    /// 400 runs of which some fail and some have no result, a failure among them as likely as among the others.
    fn study(seed: u64, probability: f64, lost: f64) -> Outcomes {
        let stream = Philox::new(seed);
        let mut outcomes = Outcomes::default();
        for run in 0..RUNS {
            let failed = stream.uniform(Purpose::Value, run, 0) < probability;
            match (stream.uniform(Purpose::Value, run, 1) < lost, failed) {
                (true, _) => outcomes.no_result += 1,
                (false, true) => outcomes.failed += 1,
                (false, false) => outcomes.passed += 1,
            }
        }
        outcomes
    }

    /// A draw below the tail of a normal distribution fails with a probability in closed form, Φ(−2) = 0.022750: of 1000 studies, at
    /// least the stated share of intervals contains it, with and without runs that have no result.
    #[test]
    fn intervals_cover_a_known_probability() {
        let truth = super::super::distribution::normal::below(-2.0);
        for (level, lost) in [(0.95, 0.0), (0.9, 0.0), (0.95, 0.02)] {
            let confidence = Confidence::new(level).unwrap();
            let covers = |seed: &u64| {
                study(*seed, truth, lost)
                    .interval(confidence)
                    .contains(truth)
            };
            let covered = (0..1000).filter(covers).count();
            assert!(
                number(covered as u64) >= 1000.0 * level,
                "{covered} at {level}"
            );
        }
    }

    #[test]
    fn runs_without_a_result_widen_the_answer() {
        let outcomes = Outcomes {
            passed: 90,
            failed: 2,
            no_result: 8,
        };
        let confidence = Confidence::new(0.95).unwrap();
        assert_eq!(outcomes.estimates(), Some([0.02, 0.1]));
        let interval = outcomes.interval(confidence);
        // 2 of 100: 0.00243 to 0.07038; 10 of 100: 0.04900 to 0.17622 (Clopper and Pearson).
        assert!((interval.low - 0.002_431_34).abs() < 1e-8);
        assert!((interval.high - 0.176_22).abs() < 1e-5);
        assert_eq!(Outcomes::default().estimates(), None);
        let whole = Outcomes::default().interval(confidence);
        assert_eq!([whole.low, whole.high], [0.0, 1.0]);
    }
}
