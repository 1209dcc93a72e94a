//! Which input matters for a result. In: the kept runs. Out: for every input the first-order index by ranks and Spearman's correlation,
//! both with their intervals. With correlated inputs a first-order index has no meaning and is left out.

use serde::Serialize;

use super::RANKED;
use super::ends;
use super::kept::Kept;
use crate::study::data_set::Metadata;
use psd_physics::study::Confidence;
use psd_physics::study::sensitivity::{Index, first_order, spearman};

/// The influence of one input on one result.
#[derive(Clone, Debug, Serialize)]
pub struct Sensitivity {
    pub input: String,
    /// Fraction of the variance of the result that the input explains alone. None: fewer than fifty runs, a constant result, or
    /// correlated inputs.
    pub first_order: Option<IndexAnswer>,
    /// Spearman's, from −1 to 1.
    pub rank_correlation: Option<IndexAnswer>,
}

/// An index with its interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct IndexAnswer {
    pub value: f64,
    pub interval: [f64; 2],
    /// The study is too small to distinguish it from zero.
    pub may_be_zero: bool,
}

impl From<Index> for IndexAnswer {
    fn from(index: Index) -> Self {
        Self {
            value: index.value,
            interval: ends(index.interval),
            may_be_zero: index.may_be_zero(),
        }
    }
}

/// Of every input, for one result. Runs without this result are left out.
pub fn answers(
    metadata: &Metadata,
    kept: &Kept,
    result: usize,
    confidence: Confidence,
) -> Vec<Sensitivity> {
    let runs = kept.runs().min(RANKED);
    let column = &kept.results[result][..runs];
    let results: Vec<f64> = column.iter().copied().flatten().collect();
    let of_input = |(input, described): (&Vec<f64>, &crate::study::data_set::Column)| {
        let inputs: Vec<f64> = input[..runs]
            .iter()
            .zip(column)
            .filter_map(|(input, result)| result.map(|_| *input))
            .collect();
        let is_constant = inputs.windows(2).all(|pair| pair[0] == pair[1]);
        let first_order = (!metadata.is_correlated && !is_constant)
            .then(|| first_order::index(&inputs, &results, confidence));
        Sensitivity {
            input: described.name.clone(),
            first_order: first_order.flatten().map(IndexAnswer::from),
            rank_correlation: spearman::index(&inputs, &results, confidence).map(IndexAnswer::from),
        }
    };
    kept.inputs
        .iter()
        .zip(&metadata.inputs)
        .map(of_input)
        .collect()
}
