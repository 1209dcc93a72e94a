//! The subset simulation of a study. In: its metadata, then its rows in the order of their runs. Out: the points of the next runs, and the
//! probability of the rare event. It runs nothing: the rows of a data set give the same answer as those of the process that made them.

use crate::study::data_set::{Limit, Metadata, Outcome, Stopping, StudyKind, StudyRow};
use psd_physics::study::Confidence;
use psd_physics::study::subset_simulation::{Answer, Progress};
use psd_plan::study::RareEvent;

/// A subset simulation of runs of the plan.
#[derive(Clone, Debug)]
pub struct RareRuns {
    event: RareEvent,
    limit: Limit,
    progress: Progress,
}

impl RareRuns {
    /// None for another study, or if the metadata do not describe a subset simulation.
    #[must_use]
    pub fn of(metadata: &Metadata) -> Option<Self> {
        let StudyKind::Study(Stopping::Rare(event)) = metadata.kind else {
            return None;
        };
        let limit = metadata.requirements.get(event.requirement)?.limit?;
        // The response is the distance beyond the limit.
        let progress = event.simulation(metadata.seed).begin(0.0).ok()?;
        Some(Self {
            event,
            limit,
            progress,
        })
    }

    /// The points of the next runs in standard normal space; their order does not matter to their results.
    #[must_use]
    pub fn pending(&self) -> &[Vec<f64>] {
        self.progress.pending()
    }

    /// Adds the next run.
    pub fn add(&mut self, row: &StudyRow) {
        if self.is_over() {
            return;
        }
        let outcome = row.outcomes.get(self.event.requirement);
        let result = row.results.get(self.limit.result).copied().flatten();
        let sign = if self.event.falls { -1.0 } else { 1.0 };
        let beyond = result.map(|result| sign * (result - self.limit.value));
        // A limit is exceeded, and the peak was not reached: it fails by any distance.
        let fails = outcome == Some(&Outcome::NotMet);
        let beyond = beyond.or(fails.then_some(f64::MIN_POSITIVE));
        let known = outcome != Some(&Outcome::NoResult);
        self.progress.add(beyond.filter(|_| known));
    }

    #[must_use]
    pub const fn is_over(&self) -> bool {
        self.progress.is_over()
    }

    /// The probability of the failure; None before all replicates have ended.
    #[must_use]
    pub fn answer(&self, confidence: Confidence) -> Option<Answer> {
        let mut answer = self.progress.answer(confidence)?;
        // Runs without a result counted as failures: without them the probability may be any smaller one.
        if answer.replicates.iter().any(|it| it.no_result > 0) {
            answer.probability.interval.low = 0.0;
        }
        Some(answer)
    }
}
