//! Runs that a study takes again, held against the run itself: what a small error makes of a way that is not stable against it
//! is no uncertainty. In: how far each run went. Out: what it came to, and whether anything may be told of the study. It knows
//! no specimen, be it of one degree of freedom or a frame.

use std::sync::atomic::{AtomicBool, Ordering};

use super::stop::Stop;
use super::study::{Taken, Unknown};
use crate::mechanics::extremes::farther;
use crate::uncertainty::Contribution;

/// How many times as far as the run itself one that is taken again may go.
const FARTHER: f64 = 10.0;
const GROWS: &str = "errors of its readings, taken along the recorded way, grow without bound";

/// Runs of one study.
pub(super) struct Bounded {
    /// The farthest place of the run itself from its zero, m.
    farthest: f64,
    /// Numbers that a run comes to.
    count: usize,
    grown: AtomicBool,
}

impl Bounded {
    pub(super) const fn new(farthest: f64, count: usize) -> Self {
        Self { farthest, count, grown: AtomicBool::new(false) }
    }

    /// What a run came to, which went so far from its zero (m); no numbers where it could not be taken.
    pub(super) fn taken(&self, found: Option<(f64, Taken)>) -> Taken {
        let Some((farthest, taken)) = found else { return Taken { values: vec![f64::NAN; self.count], seen: false } };
        if farthest.is_nan() || farthest > FARTHER * self.farthest {
            self.grown.store(true, Ordering::Relaxed);
        }
        taken
    }

    /// What the study found, unless a run grew without bound.
    pub(super) fn told(self, parts: Result<Vec<Vec<Contribution>>, Stop>) -> Result<Vec<Vec<Contribution>>, Unknown> {
        let parts = parts.map_err(Unknown::Stop)?;
        if self.grown.into_inner() { Err(GROWS.to_owned().into()) } else { Ok(parts) }
    }
}

/// The largest size of places, m; NaN where one is none.
pub(super) fn farthest(places: impl IntoIterator<Item = f64>) -> f64 {
    places.into_iter().fold(0.0, farther)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A way that a small error leads ten times as far is not told as uncertain: nothing is known of it.
    #[test]
    fn a_way_that_grows_without_bound_is_told_from_one_that_scatters() {
        let told = |places: [f64; 2]| {
            let runs = Bounded::new(farthest([0.01, -0.02]), 1);
            let taken = Taken { values: vec![1.0], seen: true };
            assert_eq!(runs.taken(Some((farthest(places), taken))).values, [1.0]);
            runs.told(Ok(Vec::new())).is_ok()
        };
        assert!(told([0.011, -0.021]) && told([-0.2, 0.2]));
        assert!(!told([0.01, 7e94]) && !told([f64::NAN, 0.0]) && !told([0.0, f64::NAN]) && !told([-0.21, 0.0]));
    }

    #[test]
    fn a_run_that_could_not_be_taken_has_no_numbers_and_is_no_growth() {
        let runs = Bounded::new(1.0, 3);
        let taken = runs.taken(None);
        assert!(taken.values.len() == 3 && taken.values.iter().all(|value| value.is_nan()) && !taken.seen);
        assert!(runs.told(Ok(Vec::new())).is_ok());
    }
}
