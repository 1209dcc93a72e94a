//! When a study with `until` ends. In: its rows in the order of their runs. Out: the next look, and whether every probability is decided.
//! It runs nothing.
//!
//! The looks are at 128, 256, 512 … runs (`physics::study::probability::stopping`). A probability that is decided at a look stays
//! decided; the study goes on until all are.

pub mod rare;

use crate::study::counts::Counts;
use crate::study::data_set::{Event, Metadata, StudiedRequirement, StudyRow};
use psd_physics::study::Interval;
use psd_physics::study::probability::Decision;
use psd_physics::study::probability::stopping::{self, Look};
use psd_plan::Comparison;
use psd_plan::study::Runs;
use rare::RareRuns;

/// A probability that a study is run for.
#[derive(Clone, Debug)]
struct Watched {
    target: Target,
    requirement: usize,
    event: Event,
    concluded: bool,
}

/// What ends the study for a probability.
#[derive(Clone, Debug)]
enum Target {
    /// Its interval is on one side of the limit.
    Decided(StudiedRequirement),
    /// Half of its interval is at most this.
    HalfWidth(f64),
}

/// Counts the runs of a study, and looks at them when the rule says so.
#[derive(Clone, Debug)]
pub struct Looks {
    pub counts: Counts,
    watched: Vec<Watched>,
    /// Looks to come, the next one last; none for a fixed number of runs.
    to_come: Vec<Look>,
    at_most: u64,
    /// The levels of a subset simulation.
    rare: Option<RareRuns>,
}

impl Looks {
    /// The looks of a study with these metadata.
    #[must_use]
    pub fn of(runs: Runs, metadata: &Metadata) -> Self {
        let at_most = runs.at_most();
        // The looks are the same for every limit.
        let looks = |confidence| {
            let mut looks: Vec<Look> = stopping::looks(confidence, at_most).collect();
            looks.reverse();
            looks
        };
        let (watched, to_come) = match runs {
            Runs::Fixed(_) | Runs::Rare(_) => (Vec::new(), Vec::new()),
            Runs::Decided { confidence, .. } => {
                let studied = metadata.studied.iter();
                let watched = studied.map(|studied| Watched {
                    target: Target::Decided(studied.clone()),
                    requirement: studied.requirement,
                    event: studied.event,
                    concluded: false,
                });
                (watched.collect(), looks(confidence))
            }
            Runs::HalfWidth {
                half_width,
                confidence,
                ..
            } => {
                let watched = probabilities(metadata).map(|(requirement, event)| Watched {
                    target: Target::HalfWidth(half_width),
                    requirement,
                    event,
                    concluded: false,
                });
                (watched.collect(), looks(confidence))
            }
        };
        Self {
            counts: Counts::new(metadata.requirements.len()),
            watched,
            to_come,
            at_most,
            rare: RareRuns::of(metadata),
        }
    }

    /// The subset simulation of the study, if it is one.
    #[must_use]
    pub const fn rare(&self) -> Option<&RareRuns> {
        self.rare.as_ref()
    }

    /// Number of runs of the next look, or of the study: no run beyond it is needed before it.
    #[must_use]
    pub fn next(&self) -> u64 {
        if let Some(rare) = &self.rare {
            return self.counts.runs + rare.pending().len() as u64;
        }
        self.to_come.last().map_or(self.at_most, |look| look.runs)
    }

    /// The next look; None if there is no more.
    #[must_use]
    pub fn planned(&self) -> Option<Look> {
        self.to_come.last().copied()
    }

    /// Adds the next run, and looks if it is the last one before a look.
    pub fn add(&mut self, row: &StudyRow) {
        self.counts.add(row);
        if let Some(rare) = &mut self.rare {
            rare.add(row);
        }
        let runs = self.counts.runs;
        let Some(look) = self.to_come.pop_if(|look| look.runs == runs) else {
            return;
        };
        for watched in &mut self.watched {
            let outcomes = self.counts.of(watched.requirement, watched.event);
            let interval = outcomes.interval(look.confidence);
            watched.concluded |= match &watched.target {
                Target::Decided(studied) => decide(studied, interval) != Decision::Undecided,
                Target::HalfWidth(most) => interval.half_width() <= *most,
            };
        }
    }

    /// Whether no more runs are needed.
    #[must_use]
    pub fn are_over(&self) -> bool {
        if let Some(rare) = &self.rare {
            return rare.is_over();
        }
        self.counts.runs >= self.at_most
            || !self.watched.is_empty() && self.watched.iter().all(|watched| watched.concluded)
    }
}

/// The probabilities of a study: those that requirements read, else that each requirement of the plan fails.
pub(super) fn probabilities(metadata: &Metadata) -> impl Iterator<Item = (usize, Event)> + '_ {
    let studied = metadata.studied.iter();
    let studied = studied.map(|studied| (studied.requirement, studied.event));
    let others = if metadata.studied.is_empty() {
        metadata.requirements.len()
    } else {
        0
    };
    studied.chain((0..others).map(|requirement| (requirement, Event::Fails)))
}

/// Whether every probability in the interval satisfies the limit, or none.
#[must_use]
pub fn decide(studied: &StudiedRequirement, interval: Interval) -> Decision {
    let Interval { low, high } = interval;
    let limit = studied.limit;
    let (met, missed) = match studied.comparison {
        Comparison::Less => (high < limit, low >= limit),
        Comparison::LessEqual => (high <= limit, low > limit),
        Comparison::Greater => (low > limit, high <= limit),
        Comparison::GreaterEqual => (low >= limit, high < limit),
        // A probability is never known exactly.
        Comparison::Equal | Comparison::NotEqual => (false, false),
    };
    match (met, missed) {
        (true, _) => Decision::Met,
        (_, true) => Decision::NotMet,
        _ => Decision::Undecided,
    }
}

#[cfg(test)]
mod tests;
