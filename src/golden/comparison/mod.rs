//! Comparison of runs. In: the summary of each run and the data of its figures. Out: a [`Comparison`]: differences or spread of results,
//! verdicts, and differences in plan, settings and rig. It does not read the report text.

mod console;
mod facts;
mod figures;
pub mod page;
mod statistics;
mod table;

use serde_json::Value;

pub use console::comparison_text;
pub use figures::{Sheet, sheets};
pub use statistics::{Difference, Spread};
pub use table::{TITLES, cells, csv, heads};

use crate::report::Figures;
use psd_text::units::{Dimension, unit};

/// One run in a comparison.
#[derive(Clone, Debug)]
pub struct Side {
    /// As the operator named it: `runs/beam-1`.
    pub name: String,
    /// The content of its `summary.json`.
    pub summary: Value,
    pub figures: Figures,
    /// The plan as it was run; None for accepted results, which do not contain it.
    pub plan: Option<String>,
}

/// One result over all runs.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedRow {
    /// For example `hit.max_displacement`, `quake.max_drift[0]`.
    pub name: String,
    pub dimension: Dimension,
    /// For each run: `Some(None)` if the result exists and has no value.
    pub cells: Vec<Option<Cell>>,
}

/// A result of one run, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    pub value: Option<f64>,
    /// Standard uncertainty.
    pub u: Option<f64>,
}

/// All data of the compared runs.
#[derive(Clone, Debug)]
pub struct Comparison {
    pub names: Vec<String>,
    pub verdicts: Vec<String>,
    /// Results that all runs have.
    pub shared: Vec<ComparedRow>,
    /// Results that only some runs have.
    pub partial: Vec<ComparedRow>,
    /// For each requirement: its verdict in each run.
    pub requirements: Vec<(String, Vec<Option<String>>)>,
    /// Differences in plan, settings and rig: name, and text in each run.
    pub facts: Vec<(String, Vec<String>)>,
    /// The plan lines that differ, each run against the first: the run, and the lines.
    pub plans: Vec<(String, Vec<String>)>,
}

impl Comparison {
    #[must_use]
    pub fn of(sides: &[Side]) -> Self {
        let (mut shared, partial): (Vec<ComparedRow>, Vec<ComparedRow>) = rows(sides)
            .into_iter()
            .partition(|row| row.cells.iter().all(Option::is_some));
        // A result without a value in any run is not informative.
        shared.retain(|row| row.cells.iter().flatten().any(|cell| cell.value.is_some()));
        Self {
            names: sides.iter().map(|side| side.name.clone()).collect(),
            verdicts: sides
                .iter()
                .map(|side| unquoted(&side.summary["verdict"]))
                .collect(),
            shared,
            partial,
            requirements: facts::requirements(sides),
            facts: facts::facts(sides),
            plans: facts::plans(sides),
        }
    }
}

/// Every result of every run, in the order of the first occurrence.
fn rows(sides: &[Side]) -> Vec<ComparedRow> {
    let mut rows: Vec<ComparedRow> = Vec::new();
    for (column, side) in sides.iter().enumerate() {
        for (name, dimension, cell) in results(&side.summary) {
            // One name may be of different quantities in different plans.
            let known = rows
                .iter_mut()
                .find(|row| row.name == name && row.dimension == dimension);
            if let Some(row) = known {
                row.cells[column] = Some(cell);
            } else {
                let mut cells = vec![None; sides.len()];
                cells[column] = Some(cell);
                rows.push(ComparedRow {
                    name,
                    dimension,
                    cells,
                });
            }
        }
    }
    rows
}

/// The results of one run.
fn results(summary: &Value) -> Vec<(String, Dimension, Cell)> {
    let mut found = Vec::new();
    for (procedure, recorded) in summary["procedures"].as_object().into_iter().flatten() {
        for (result, quantity) in recorded["results"].as_object().into_iter().flatten() {
            let name = format!("{procedure}.{result}");
            let unit = quantity["unit"].as_str().unwrap_or_default();
            let dimension = unit::parse(unit).map_or(Dimension::NUMBER, |unit| unit.dimension);
            match &quantity["value"] {
                Value::Array(entries) => {
                    found.extend(entries.iter().zip(0_usize..).map(|(entry, index)| {
                        let cell = Cell {
                            value: entry.as_f64(),
                            u: quantity["u"][index].as_f64(),
                        };
                        (format!("{name}[{index}]"), dimension, cell)
                    }));
                }
                value => found.push((
                    name,
                    dimension,
                    Cell {
                        value: value.as_f64(),
                        u: quantity["u"].as_f64(),
                    },
                )),
            }
        }
    }
    found
}

/// A value of a summary as a string.
fn unquoted(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Null => "—".to_owned(),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn side(name: &str, results: &Value) -> Side {
        let summary = json!({ "verdict": "pass", "procedures": { "hit": { "results": results } }, "plan": { "sha256": name },
            "requirements": [{ "name": "stays", "verdict": "pass" }], "parameters": {}, "rig": { "seed": 1 } });
        Side {
            name: name.to_owned(),
            summary,
            figures: Figures::default(),
            plan: Some(format!("let a = 1\nlet b = {name}\n")),
        }
    }

    #[test]
    fn plans_are_compared_in_what_they_share_and_the_rest_is_named() {
        let one = side(
            "1",
            &json!({ "x": { "value": 1.0, "unit": "m", "u": 0.3 }, "old": { "value": 2.0, "unit": "N", "u": null } }),
        );
        let two = side(
            "2",
            &json!({ "x": { "value": 1.5, "unit": "m", "u": 0.4 }, "d": { "value": [1.0, null], "unit": "m" } }),
        );
        let compared = Comparison::of(&[one, two]);
        let names =
            |rows: &[ComparedRow]| rows.iter().map(|row| row.name.clone()).collect::<Vec<_>>();
        assert_eq!(
            (names(&compared.shared), names(&compared.partial)),
            (
                vec!["hit.x".to_owned()],
                vec![
                    "hit.old".to_owned(),
                    "hit.d[0]".to_owned(),
                    "hit.d[1]".to_owned()
                ]
            )
        );
        let difference = Difference::of(&compared.shared[0]).unwrap();
        assert_eq!(
            (
                difference.absolute,
                difference.relative,
                difference.in_uncertainties
            ),
            (0.5, Some(0.5), Some(1.0))
        );
        assert_eq!(
            compared
                .facts
                .iter()
                .map(|(what, _)| what.as_str())
                .collect::<Vec<_>>(),
            ["plan.sha256"]
        );
        assert_eq!(
            compared.plans,
            [(
                "2".to_owned(),
                vec!["-let b = 1".to_owned(), "+let b = 2".to_owned()]
            )]
        );
        assert_eq!(
            compared.requirements,
            [(
                "stays".to_owned(),
                vec![Some("pass".to_owned()), Some("pass".to_owned())]
            )]
        );
    }
}
