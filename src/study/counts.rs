//! Outcomes of runs, counted for each requirement. In: rows. Out: how many runs met it, did not, or have no result. It computes no
//! probability.

use super::data_set::{Event, Outcome, StudyRow};
use psd_physics::study::probability::Outcomes;

/// Counts of the runs so far.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// One for each requirement.
    requirements: Vec<Count>,
    /// All runs.
    pub runs: u64,
    /// Runs in which some requirement is not met.
    pub failed: u64,
    /// Runs in which none is known not to be met, and some has no result.
    pub no_result: u64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Count {
    met: u64,
    not_met: u64,
    no_result: u64,
}

impl Counts {
    /// Before the first run.
    #[must_use]
    pub fn new(requirements: usize) -> Self {
        Self {
            requirements: vec![Count::default(); requirements],
            ..Self::default()
        }
    }

    /// Adds a run.
    pub fn add(&mut self, row: &StudyRow) {
        self.runs += 1;
        for (count, outcome) in self.requirements.iter_mut().zip(&row.outcomes) {
            match outcome {
                Outcome::Met => count.met += 1,
                Outcome::NotMet => count.not_met += 1,
                Outcome::NoResult => count.no_result += 1,
            }
        }
        if row.outcomes.contains(&Outcome::NotMet) {
            self.failed += 1;
        } else if row.outcomes.contains(&Outcome::NoResult) {
            self.no_result += 1;
        }
    }

    /// The outcomes of an event: it counts as a failure.
    #[must_use]
    pub fn of(&self, requirement: usize, event: Event) -> Outcomes {
        let Count {
            met,
            not_met,
            no_result,
        } = self.requirements[requirement];
        let (failed, passed) = match event {
            Event::Fails => (not_met, met),
            Event::Holds => (met, not_met),
        };
        Outcomes {
            passed,
            failed,
            no_result,
        }
    }
}
