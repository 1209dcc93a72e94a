//! Results of each procedure with unit and uncertainty, and below them what the procedure itself adds. In: a run. Out: blocks, a
//! procedure at a time.

use super::super::document::{Block, Column, Table, Text};
use super::super::{Run, number};
use super::{budget, words};
use crate::plan::formula::{Part, ProcedureId, ResultReference, ResultValue};
use crate::procedures;
use crate::record::{NamedResult, ProcedureRecord};
use crate::report::coverage_factor;
use crate::uncertainty::{Known, known};
use crate::units::Dimension;

/// Every procedure that was run, in order.
pub(super) fn all(run: &Run<'_>, body: &mut Vec<Block>) {
    body.push(Block::section("Results"));
    if run.record.procedures.is_empty() {
        body.push(Block::paragraph("No procedure was run."));
    }
    for (index, procedure) in run.record.procedures.iter().enumerate() {
        let state = if procedure.complete {
            ""
        } else {
            " · not complete"
        };
        body.push(Block::part(
            Text::from(procedure.name.as_str()).soft(format!(" · {}{state}", procedure.kind)),
        ));
        inputs(procedure, body);
        results(run, index, procedure, body);
        procedures::report(run, index, procedure, body);
        budget::table(run, index, procedure, body);
    }
}

fn inputs(procedure: &ProcedureRecord, body: &mut Vec<Block>) {
    let text = |(name, estimate, dimension): &(
        &'static str,
        crate::plan::formula::Estimate,
        Dimension,
    )| {
        let value = match estimate.uncertainty {
            Some(_) => number::with_uncertainty(estimate.value, estimate.uncertainty, *dimension),
            None => number::stated(estimate.value, *dimension),
        };
        format!("{} {value}", words(name))
    };
    let texts: Vec<String> = procedure.inputs.iter().map(text).collect();
    if !texts.is_empty() {
        let kind = if procedure
            .inputs
            .iter()
            .any(|(_, estimate, _)| estimate.uncertainty.is_some())
        {
            " (u in brackets)"
        } else {
            ""
        };
        body.push(Block::note(format!(
            "Run with{kind}: {}.",
            texts.join("; ")
        )));
    }
}

/// Lists whose numbers stand in a table of their own are not printed twice, and what the run did not give is named below.
fn results(run: &Run<'_>, index: usize, procedure: &ProcedureRecord, body: &mut Vec<Block>) {
    let tabled = procedures::recorded(&procedure.history).lists_are_tabled;
    let printed = procedure
        .results
        .iter()
        .filter(|result| !(tabled && matches!(result.value, ResultValue::List(_))));
    let (found, none): (Vec<&NamedResult>, Vec<&NamedResult>) =
        printed.partition(|result| match &result.value {
            ResultValue::Number { value, .. } => value.is_some(),
            ResultValue::List(values) => !values.is_empty(),
        });
    if !found.is_empty() {
        body.push(table(run, index, &found));
    }
    if !none.is_empty() {
        let named = none.iter().enumerate().fold(
            Text::from("None in this run: "),
            |text, (index, result)| {
                if index == 0 {
                    text.code(result.name)
                } else {
                    text.and(", ").code(result.name)
                }
            },
        );
        body.push(Block::note(named.and(".")));
    }
    body.extend(budget::marked(procedure));
}

fn table(run: &Run<'_>, index: usize, results: &[&NamedResult]) -> Block {
    let known = |result: &NamedResult| {
        let reference = ResultReference {
            procedure: ProcedureId(index),
            name: result.name,
            part: Part::Value,
        };
        known(&result.contributions_of(reference), run.record)
    };
    let all: Vec<Option<Known>> = results.iter().map(|result| known(result)).collect();
    // A column of twos says nothing.
    let partial = budget::Partial::of(run) == budget::Partial::Real;
    let factors = !partial
        && all
            .iter()
            .flatten()
            .any(|known| coverage_factor::is_more(*known));
    let mut columns = vec![
        Column::words("Result", 1),
        Column::numbers("Value"),
        Column::numbers("u"),
        Column::numbers(if factors { "U = k·u" } else { "U (k = 2)" }),
        Column::short("Unit"),
        Column::short("In the plan"),
    ];
    // A partial budget of a real rig gives no U.
    if partial {
        columns[3] = Column::numbers("U: none, partial");
    }
    if factors {
        columns.insert(3, Column::numbers("k (ν)"));
    }
    let rows = results.iter().zip(&all).map(|(result, known)| {
        let mut row = row(result, *known);
        if partial {
            row[3] = "—".into();
        }
        if factors {
            let text = known.filter(|known| {
                known.standard > 0.0 && matches!(result.value, ResultValue::Number { .. })
            });
            let text = text.map(|known| {
                format!(
                    "{} ({})",
                    coverage_factor::factor(known),
                    coverage_factor::degrees_text(known)
                )
            });
            row.insert(3, text.map_or_else(|| "—".into(), Text::from));
        }
        row
    });
    Block::Table(Table {
        columns,
        rows: rows.collect(),
    })
}

fn row(result: &NamedResult, known: Option<Known>) -> Vec<Text> {
    let dash = || Text::from("—");
    let [value, standard, expanded, unit] = match &result.value {
        // A goodness of fit is told by how many nines it has.
        ResultValue::Number {
            value: Some(value), ..
        } if result.name == "r_squared" => [format!("{value:.6}").into(), dash(), dash(), dash()],
        ResultValue::Number {
            value: Some(value),
            uncertainty,
        } => {
            let uncertainty = uncertainty.filter(|standard| *standard > 0.0);
            let known = uncertainty.map(|standard| Known {
                standard,
                ..known.unwrap_or(Known::surely(standard))
            });
            let parts = number::parts(*value, known, result.dimension);
            let unit = if parts.unit.is_empty() {
                dash()
            } else {
                parts.unit.into()
            };
            [
                parts.value.into(),
                parts.standard.map_or_else(dash, Text::from),
                parts.expanded.map_or_else(dash, Text::from),
                unit,
            ]
        }
        ResultValue::Number { value: None, .. } => {
            [Text::missing("none in this run"), dash(), dash(), dash()]
        }
        ResultValue::List(values) if values.is_empty() => {
            [Text::missing("none in this run"), dash(), dash(), dash()]
        }
        ResultValue::List(values) => {
            let text = |value: &f64| {
                if value.is_finite() {
                    number::text(*value, result.dimension)
                } else {
                    "none".to_owned()
                }
            };
            let texts: Vec<String> = values.iter().map(text).collect();
            [texts.join(", ").into(), dash(), dash(), dash()]
        }
    };
    let sure = !matches!(result.value, ResultValue::Number { .. }) || budget::is_sure(result, 0);
    let name = Text::from(words(result.name)).and(if sure { "" } else { budget::MARK });
    vec![
        name,
        value,
        standard,
        expanded,
        unit,
        Text::new().code(result.name),
    ]
}
