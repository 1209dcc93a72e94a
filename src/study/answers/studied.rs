//! Requirements on probabilities, decided. In: counts, at the end or at every look of the stopping rule. Out: met, not met or undecided.
//!
//! A study with a stopping rule chooses its own end, so each look has an interval of its own, wider than that of a fixed number of runs; a
//! requirement is decided by the first look that can. An incomplete study decides nothing: whoever ends it early could wait for a good
//! moment.

use serde::Serialize;

use super::looks::{CountsAtLook, CountsWithLooks};
use super::probability::Probability;
use super::subset::SubsetAnswer;
use super::{ends, is_independent};
use crate::study::counts::Counts;
use crate::study::data_set::{Metadata, StudiedRequirement};
use crate::study::stopping::{decide, probabilities};
use psd_physics::study::probability::Decision;
use psd_physics::study::{Confidence, Interval};

/// A requirement on a probability.
#[derive(Clone, Debug, Serialize)]
pub struct StudiedAnswer {
    pub label: String,
    /// The condition as the plan writes it.
    pub text: String,
    /// `met`, `not_met` or `undecided`.
    #[serde(serialize_with = "word_of")]
    pub decision: Decision,
    /// The probability that is compared, from all runs.
    pub probability: Option<Probability>,
    pub limit: f64,
    /// Number of the look that decided; None without a stopping rule, or if none did.
    pub look: Option<u32>,
}

/// A look of the stopping rule.
#[derive(Clone, Debug, Serialize)]
pub struct LookAnswer {
    pub number: u32,
    pub runs: u64,
    /// Confidence of its intervals.
    pub confidence: f64,
    /// One for each studied requirement; without one, that each requirement of the plan is not met.
    pub intervals: Vec<[f64; 2]>,
}

/// All of them.
pub struct Studied {
    pub answers: Vec<StudiedAnswer>,
    pub looks: Vec<LookAnswer>,
    pub complete: bool,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde gives a reference")]
fn word_of<S: serde::Serializer>(decision: &Decision, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(word(*decision))
}

/// The word in the summary.
pub const fn word(decision: Decision) -> &'static str {
    match decision {
        Decision::Met => "met",
        Decision::NotMet => "not_met",
        Decision::Undecided => "undecided",
    }
}

pub fn answers(
    metadata: &Metadata,
    counts: &CountsWithLooks,
    subset: Option<&SubsetAnswer>,
    confidence: Confidence,
) -> Studied {
    let complete = counts.are_complete();
    let of_probabilities = counts.confidence(confidence);
    let answer = |studied: &StudiedRequirement| {
        let outcomes = counts.counts().of(studied.requirement, studied.event);
        let is_exact = is_independent(metadata.sampling);
        let is_rare = counts.rare().is_some();
        let rare = subset.map(|subset| subset.of(studied.event));
        let (decision, look) = if let Some(rare) = &rare {
            let [low, high] = rare.interval;
            (decide(studied, Interval { low, high }), None)
        } else if complete && !is_rare {
            decided(studied, counts, confidence)
        } else {
            (Decision::Undecided, None)
        };
        StudiedAnswer {
            label: studied.label.clone(),
            text: studied.text.clone(),
            decision,
            probability: match rare {
                Some(rare) => Some(rare),
                None if is_rare => None,
                None => Probability::of(&outcomes, of_probabilities, is_exact),
            },
            limit: studied.limit,
            look,
        }
    };
    let look = |counted: &CountsAtLook| {
        let interval = |(requirement, event)| {
            let outcomes = counted.counts.of(requirement, event);
            ends(outcomes.interval(counted.look.confidence))
        };
        LookAnswer {
            number: counted.look.number,
            runs: counted.look.runs,
            confidence: 1.0 - counted.look.confidence.error(),
            intervals: probabilities(metadata).map(interval).collect(),
        }
    };
    Studied {
        answers: metadata.studied.iter().map(answer).collect(),
        looks: counts.evaluated.iter().map(look).collect(),
        complete,
    }
}

/// By the first look that decides; by all runs if their number is fixed.
fn decided(
    studied: &StudiedRequirement,
    counts: &CountsWithLooks,
    confidence: Confidence,
) -> (Decision, Option<u32>) {
    let at = |counts: &Counts, confidence| {
        let outcomes = counts.of(studied.requirement, studied.event);
        decide(studied, outcomes.interval(confidence))
    };
    if counts.evaluated.is_empty() {
        return (at(counts.counts(), confidence), None);
    }
    let mut looks = counts.evaluated.iter().map(|counted| {
        let decision = at(&counted.counts, counted.look.confidence);
        (decision, Some(counted.look.number))
    });
    let first = looks.find(|(decision, _)| *decision != Decision::Undecided);
    first.unwrap_or((Decision::Undecided, None))
}
