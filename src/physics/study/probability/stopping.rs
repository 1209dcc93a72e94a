//! When a study with a goal may stop. In: a level of confidence, the most runs. Out: the looks at which it may stop, each with the
//! confidence of its interval.
//!
//! A study that looks at its interval after every run and stops when the limit is outside decides wrongly far more often than α: it has many
//! chances. Here it looks at 128, 256, 512 … runs only, and look m may err with α/(m(m + 1)). Their sum is at most α, so the decision and
//! the interval hold however long the study runs, and also if the most runs are raised later.

use super::Confidence;

/// Runs at the first look.
pub const FIRST_LOOK: u64 = 128;

/// A planned look at the outcomes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// From 1.
    pub number: u32,
    /// Runs at which it is taken.
    pub runs: u64,
    /// Confidence of its interval.
    pub confidence: Confidence,
}

/// All looks of a study: the last one is at `at_most` runs.
pub fn looks(confidence: Confidence, at_most: u64) -> impl Iterator<Item = Look> {
    let look = move |number: u32| {
        let m = f64::from(number);
        let spent = confidence.error() / (m * (m + 1.0));
        Look {
            number,
            runs: (FIRST_LOOK << (number - 1)).min(at_most),
            confidence: Confidence(1.0 - spent),
        }
    };
    // A look is planned while the one before it is below `at_most`.
    (1..=57_u32)
        .take_while(move |number| *number == 1 || FIRST_LOOK << (number - 2) < at_most)
        .map(look)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looks_double_and_end_at_the_last_run() {
        let of = |at_most| looks(Confidence::new(0.95).unwrap(), at_most);
        let runs = |at_most| of(at_most).map(|look| look.runs).collect::<Vec<u64>>();
        assert_eq!(runs(1000), [128, 256, 512, 1000]);
        assert_eq!(runs(512), [128, 256, 512]);
        assert_eq!(runs(50), [50]);
        assert_eq!(runs(1 << 40).len(), 34);
        let spent: f64 = of(1 << 40).map(|look| look.confidence.error()).sum();
        assert!((spent - 0.05 * (1.0 - 1.0 / 35.0)).abs() < 1e-12);
    }
}
