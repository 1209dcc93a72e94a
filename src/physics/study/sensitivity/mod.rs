//! Which input matters: first-order indices and rank correlations, from the runs of any study. In: the values of an input and of a result.
//! Out: the index with its confidence interval. No special design of points is needed.

pub mod first_order;
pub mod spearman;

use super::Interval;

/// An index with its interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Index {
    pub value: f64,
    pub interval: Interval,
}

impl Index {
    /// The study is too small to distinguish the index from zero.
    #[must_use]
    pub fn may_be_zero(&self) -> bool {
        self.interval.contains(0.0)
    }
}

/// The order of the values, the smallest first. Equal values stay in the order of their runs.
fn order(values: &[f64]) -> Vec<usize> {
    let mut indices: Vec<usize> = (0..values.len()).collect();
    indices.sort_by(|first, second| values[*first].total_cmp(&values[*second]));
    indices
}
