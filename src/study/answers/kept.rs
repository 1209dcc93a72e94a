//! The first runs of a study, kept for quantiles, sensitivities and figures. In: rows. Out: their values, column by column.

use super::KEPT;
use crate::study::data_set::{Metadata, StudyRow};

/// Columns of the first runs.
#[derive(Clone, Debug, Default)]
pub struct Kept {
    pub inputs: Vec<Vec<f64>>,
    pub results: Vec<Vec<Option<f64>>>,
    runs: usize,
}

impl Kept {
    pub fn new(metadata: &Metadata) -> Self {
        Self {
            inputs: vec![Vec::new(); metadata.inputs.len()],
            results: vec![Vec::new(); metadata.results.len()],
            runs: 0,
        }
    }

    pub fn add(&mut self, row: &StudyRow) {
        if self.runs >= KEPT {
            return;
        }
        self.runs += 1;
        for (column, value) in self.inputs.iter_mut().zip(&row.inputs) {
            column.push(*value);
        }
        for (column, value) in self.results.iter_mut().zip(&row.results) {
            column.push(*value);
        }
    }

    /// Number of kept runs.
    #[must_use]
    pub const fn runs(&self) -> usize {
        self.runs
    }

    /// The results of one column that exist, sorted, of every `replicates`-th run from `first` on; and how many do not exist.
    pub fn sorted(&self, result: usize, first: usize, replicates: usize) -> (Vec<f64>, u64) {
        let column = self.results[result].iter().skip(first).step_by(replicates);
        let (mut values, mut lost) = (Vec::new(), 0);
        for value in column {
            match value {
                Some(value) => values.push(*value),
                None => lost += 1,
            }
        }
        values.sort_by(f64::total_cmp);
        (values, lost)
    }
}
