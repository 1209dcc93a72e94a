//! Why runs have no result. In: rows. Out: each reason with the number of its runs and the first of them. Only so many different reasons
//! are distinguished; the rest is counted together.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::study::data_set::StudyRow;

/// Reasons that are distinguished.
const MOST: usize = 50;

/// A reason and its runs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ReasonCount {
    pub reason: String,
    pub runs: u64,
    pub first_run: u64,
}

/// Reasons so far.
#[derive(Default)]
pub struct Reasons {
    by_text: BTreeMap<String, ReasonCount>,
    others: Option<ReasonCount>,
}

impl Reasons {
    pub fn add(&mut self, row: &StudyRow) {
        let Some(reason) = &row.reason else { return };
        let new = |reason: &str| ReasonCount {
            reason: reason.to_owned(),
            runs: 0,
            first_run: row.run,
        };
        let counted = if self.by_text.contains_key(reason) || self.by_text.len() < MOST {
            let entry = self.by_text.entry(reason.clone());
            entry.or_insert_with(|| new(reason))
        } else {
            self.others.get_or_insert_with(|| new("other reasons"))
        };
        counted.runs += 1;
    }

    /// The commonest first, the others last.
    pub fn answers(self) -> Vec<ReasonCount> {
        let mut reasons: Vec<ReasonCount> = self.by_text.into_values().collect();
        reasons.sort_by_key(|reason| (std::cmp::Reverse(reason.runs), reason.first_run));
        reasons.extend(self.others);
        reasons
    }
}
