//! The last reading of a rig, also during its motion, for display beside the run. In: every reading. Out: the newest. It is
//! not part of the run log and has no effect on the run.

use std::sync::{Arc, Mutex, PoisonError};

/// The last reading; all clones share it.
#[derive(Clone, Debug, Default)]
pub struct Live(Arc<Mutex<Option<Feedback>>>);

/// Displacement \[m\] and force \[N\] of every axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Feedback {
    /// Number of readings before it.
    pub number: u64,
    pub displacement: Vec<f64>,
    pub force: Vec<f64>,
}

impl Live {
    /// Stores a newer reading.
    pub fn show(&self, displacement: &[f64], force: &[f64]) {
        let mut feedback = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let number = feedback.as_ref().map_or(0, |feedback| feedback.number + 1);
        *feedback = Some(Feedback {
            number,
            displacement: displacement.to_vec(),
            force: force.to_vec(),
        });
    }

    /// The newest reading.
    #[must_use]
    pub fn newest(&self) -> Option<Feedback> {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }
}

#[cfg(test)]
mod tests {
    use super::Live;

    #[test]
    fn the_newest_reading_is_what_all_see() {
        let live = Live::default();
        assert_eq!(live.newest(), None);
        let seen = live.clone();
        live.show(&[1e-3], &[10.0]);
        live.show(&[2e-3], &[20.0]);
        let newest = seen.newest().unwrap();
        assert_eq!(
            (newest.number, newest.displacement, newest.force),
            (1, vec![2e-3], vec![20.0])
        );
    }
}
