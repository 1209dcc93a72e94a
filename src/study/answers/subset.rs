//! The answer of a subset simulation: a probability with the interval of its replicates, and every level. In: the levels as they follow
//! from the rows. Out: plain data.

use serde::Serialize;

use super::looks::CountsWithLooks;
use super::probability::Probability;
use crate::study::data_set::Event;
use psd_physics::study::Confidence;
use psd_physics::study::subset_simulation::{Answer, Level, Replicate};

/// What a subset simulation found.
#[derive(Clone, Debug, Serialize)]
pub struct SubsetAnswer {
    /// That the requirement fails: the mean of the replicates.
    pub probability: f64,
    /// Student's, of the replicates. Without a failure it has an upper end above 0.
    pub interval: [f64; 2],
    /// Coefficient of variation of one replicate; None if no replicate reached the limit.
    pub variation: Option<f64>,
    pub replicates: usize,
    /// Runs without a result, which count as failures.
    pub no_result: u64,
    pub levels: Vec<LevelAnswer>,
}

/// A level, over all replicates that have it.
#[derive(Clone, Debug, Serialize)]
pub struct LevelAnswer {
    pub level: usize,
    pub replicates: usize,
    /// Smallest and largest distance of the threshold from the limit, in the unit of the result; 0 is the limit.
    pub thresholds: [f64; 2],
    /// Mean fraction of runs beyond the threshold.
    pub fraction: f64,
    /// Mean fraction of accepted moves; 1 at the first level.
    pub accepted: f64,
}

impl SubsetAnswer {
    /// The probability of an event.
    pub fn of(&self, event: Event) -> Probability {
        let other = |fraction: f64| 1.0 - fraction;
        let (value, interval) = match event {
            Event::Fails => (self.probability, self.interval),
            Event::Holds => {
                let [low, high] = self.interval;
                (other(self.probability), [other(high), other(low)])
            }
        };
        Probability {
            bounds: [value; 2],
            interval,
            is_exact: false,
        }
    }
}

/// None of another study, and before all replicates have ended.
pub fn answer(counts: &CountsWithLooks, confidence: Confidence) -> Option<SubsetAnswer> {
    let Answer {
        probability,
        variation,
        replicates,
    } = counts.rare()?.answer(confidence)?;
    let most = replicates.iter().map(|it| it.levels.len()).max()?;
    Some(SubsetAnswer {
        probability: probability.value,
        interval: [probability.interval.low, probability.interval.high],
        variation,
        replicates: replicates.len(),
        no_result: replicates.iter().map(|it| it.no_result).sum(),
        levels: (0..most).map(|at| level(at, &replicates)).collect(),
    })
}

fn level(at: usize, replicates: &[Replicate]) -> LevelAnswer {
    let levels: Vec<Level> = replicates
        .iter()
        .filter_map(|replicate| replicate.levels.get(at).copied())
        .collect();
    let mean =
        |of: fn(&Level) -> f64| psd_physics::statistics::samples::mean(levels.iter().map(of));
    let thresholds = levels.iter().map(|level| level.threshold);
    LevelAnswer {
        level: at + 1,
        replicates: levels.len(),
        thresholds: [
            thresholds.clone().fold(f64::INFINITY, f64::min),
            thresholds.fold(f64::NEG_INFINITY, f64::max),
        ],
        fraction: mean(|level| level.share),
        accepted: mean(|level| level.accepted),
    }
}
