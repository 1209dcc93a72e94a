//! The page of a comparison. In: the comparison, and its figures drawn. Out: HTML.

use super::{ComparedRow, Comparison, TITLES, cells, heads};
use crate::report::comparison;
use crate::report::comparison::{ComparisonPage, ResultTable};

/// The page; `figures` are captions with PNG bytes.
#[must_use]
pub fn page(compared: &Comparison, figures: &[(String, Vec<u8>)]) -> String {
    let table = |(title, rows): (&'static str, &Vec<ComparedRow>)| ResultTable {
        title,
        heads: heads(compared.names.len()),
        rows: rows
            .iter()
            .map(|row| (row.name.clone(), cells(row)))
            .collect(),
    };
    let results = TITLES
        .into_iter()
        .zip([&compared.shared, &compared.partial])
        .map(table)
        .collect();
    comparison::page(
        &ComparisonPage {
            names: &compared.names,
            verdicts: &compared.verdicts,
            results,
            requirements: &compared.requirements,
            facts: &compared.facts,
            plans: &compared.plans,
        },
        figures,
    )
}
