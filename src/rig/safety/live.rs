//! The reading that a rig made last, on its way too, for whoever watches beside the run. In: every poll. Out: the newest. No part of the
//! record, and nothing comes of it but a picture.

use std::sync::{Arc, Mutex, PoisonError};

/// What was read last; all clones share it.
#[derive(Clone, Debug, Default)]
pub struct Live(Arc<Mutex<Option<Felt>>>);

/// Displacement (m) and force (N) of every axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Felt {
    /// How many readings came before it.
    pub number: u64,
    pub displacement: Vec<f64>,
    pub force: Vec<f64>,
}

impl Live {
    /// A newer reading.
    pub fn show(&self, displacement: &[f64], force: &[f64]) {
        let mut felt = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let number = felt.as_ref().map_or(0, |felt| felt.number + 1);
        *felt = Some(Felt {
            number,
            displacement: displacement.to_vec(),
            force: force.to_vec(),
        });
    }

    /// The newest.
    #[must_use]
    pub fn newest(&self) -> Option<Felt> {
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
