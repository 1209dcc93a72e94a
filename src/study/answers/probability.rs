//! The probability that a requirement is not met. In: counts. Out: the probability between its bounds, with the interval of Clopper and
//! Pearson. Without failures the answer is an upper bound, never zero.

use serde::Serialize;

use super::worst::{WorstRun, WorstRuns};
use super::{ends, is_a_sample, is_independent};
use crate::study::counts::Counts;
use crate::study::data_set::{Event, Metadata};
use psd_physics::study::Confidence;
use psd_physics::study::probability::Outcomes;

/// What the runs say about a requirement of the plan.
#[derive(Clone, Debug, Serialize)]
pub struct RequirementAnswer {
    pub label: String,
    /// The condition as the plan writes it.
    pub text: String,
    /// Runs that meet it; for the condition of a fragility, runs that exceed.
    pub met: u64,
    pub not_met: u64,
    pub no_result: u64,
    /// That it is not met; None of a fragility, whose runs have several intensities, and of a subset simulation.
    pub probability: Option<Probability>,
    /// Up to ten: the runs that are farthest beyond the limit, then those that are nearest to it.
    pub worst: Vec<WorstRun>,
}

/// A probability with its interval.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Probability {
    /// The fraction of failures if no run without a result failed, and if all of them failed.
    pub bounds: [f64; 2],
    /// Of Clopper and Pearson, over both bounds.
    pub interval: [f64; 2],
    /// The runs are independent of each other, so the interval is exact. Otherwise it is that of as many independent runs, or that of the
    /// replicates of a subset simulation.
    pub is_exact: bool,
}

impl Probability {
    /// None without runs.
    pub fn of(outcomes: &Outcomes, confidence: Confidence, is_exact: bool) -> Option<Self> {
        Some(Self {
            bounds: outcomes.estimates()?,
            interval: ends(outcomes.interval(confidence)),
            is_exact,
        })
    }
}

pub fn answers(
    metadata: &Metadata,
    counts: &Counts,
    worst: WorstRuns,
    confidence: Confidence,
) -> Vec<RequirementAnswer> {
    let is_sample = is_a_sample(&metadata.kind);
    let requirements = metadata.requirements.iter().enumerate();
    requirements
        .zip(worst.finish(metadata))
        .map(|((index, decision), worst)| {
            let outcomes = counts.of(index, Event::Fails);
            let exact = is_independent(metadata.sampling);
            let probability = Probability::of(&outcomes, confidence, exact);
            RequirementAnswer {
                label: decision.label.clone(),
                text: decision.text.clone(),
                met: outcomes.passed,
                not_met: outcomes.failed,
                no_result: outcomes.no_result,
                probability: probability.filter(|_| is_sample),
                worst,
            }
        })
        .collect()
}
