//! The worst runs of a requirement, each with the `--set` values that reproduce it bit for bit. In: rows. Out: up to ten runs, the worst
//! first: those that miss the limit by the most, then those that keep it by the least. Without a limit of one result, the first runs that
//! do not meet the requirement.

use serde::Serialize;

use crate::study::data_set::{Column, Metadata, Outcome, StudyKind, StudyRow};
use psd_text::units::{Dimension, Quantity};

/// Runs that are listed.
const MOST: usize = 10;

/// A run that is listed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WorstRun {
    pub run: u64,
    /// `met` or `not_met`.
    pub outcome: &'static str,
    /// The result that is compared, SI; None if several are.
    pub value: Option<f64>,
    /// In the order of the inputs, SI.
    pub inputs: Vec<f64>,
    /// `NAME="VALUE UNIT"` for each `--set` of the whole study and each input.
    pub settings: Vec<String>,
}

/// A run that may be listed. Smaller is worse.
struct Candidate {
    is_met: bool,
    /// Distance from the limit, negative for a run that is beyond it.
    distance: f64,
    row: StudyRow,
}

impl Candidate {
    fn is_worse_than(&self, other: &Self) -> bool {
        let key = |it: &Self| (it.is_met, it.distance, it.row.run);
        key(self) < key(other)
    }
}

/// The worst runs so far, for each requirement.
pub struct WorstRuns(Vec<Vec<Candidate>>);

impl WorstRuns {
    pub fn new(metadata: &Metadata) -> Self {
        Self(metadata.requirements.iter().map(|_| Vec::new()).collect())
    }

    pub fn add(&mut self, metadata: &Metadata, row: &StudyRow) {
        if matches!(metadata.kind, StudyKind::Fragility(_)) {
            return;
        }
        let decisions = metadata.requirements.iter().zip(&row.outcomes);
        for ((decision, outcome), worst) in decisions.zip(&mut self.0) {
            let margin = decision.limit.and_then(|limit| {
                Some((row.results.get(limit.result)?.as_ref()? - limit.value).abs())
            });
            let (is_met, distance) = match (outcome, margin) {
                // Without a value its peak was not reached: it may be any worse.
                (Outcome::NotMet, margin) => (false, -margin.unwrap_or(f64::INFINITY)),
                (Outcome::Met, Some(margin)) => (true, margin),
                (Outcome::Met, None) | (Outcome::NoResult, _) => continue,
            };
            let is_full = worst.len() == MOST;
            // Most runs are far from the worst ten: compared before anything is copied.
            let last = worst.last().map(|last| (last.is_met, last.distance));
            if is_full && last.is_some_and(|last| (is_met, distance) >= last) {
                continue;
            }
            let candidate = Candidate {
                is_met,
                distance,
                row: row.clone(),
            };
            let index = worst.partition_point(|other| !candidate.is_worse_than(other));
            worst.insert(index, candidate);
            worst.truncate(MOST);
        }
    }

    /// The lists, in the order of the requirements.
    pub fn finish(self, metadata: &Metadata) -> Vec<Vec<WorstRun>> {
        let listed = |decision: Option<usize>, candidate: Candidate| WorstRun {
            run: candidate.row.run,
            outcome: if candidate.is_met {
                Outcome::Met.word()
            } else {
                Outcome::NotMet.word()
            },
            value: decision.and_then(|result| candidate.row.results.get(result).copied().flatten()),
            settings: settings(metadata, &candidate.row.inputs),
            inputs: candidate.row.inputs,
        };
        let decisions = metadata.requirements.iter();
        let results = decisions.map(|decision| decision.limit.map(|limit| limit.result));
        results
            .zip(self.0)
            .map(|(result, worst)| worst.into_iter().map(|it| listed(result, it)).collect())
            .collect()
    }
}

/// The `--set` values of a run: those of the whole study, then its inputs.
fn settings(metadata: &Metadata, values: &[f64]) -> Vec<String> {
    let fixed = metadata.settings.iter();
    let fixed = fixed.map(|setting| format!("{}=\"{}\"", setting.name, setting.text));
    let inputs = metadata.inputs.iter().zip(values);
    let inputs = inputs.map(|(column, value)| setting(column, *value));
    fixed.chain(inputs).collect()
}

/// `NAME="VALUE UNIT"`, as `--set` takes it. The value is the same again, to the last bit.
#[must_use]
pub fn setting(column: &Column, value: f64) -> String {
    let Column { name, unit, .. } = column;
    let number = Quantity::new(value, Dimension::NUMBER).in_plan_syntax();
    match unit.as_str() {
        "1" => format!("{name}={number}"),
        unit => format!("{name}=\"{number} {unit}\""),
    }
}
