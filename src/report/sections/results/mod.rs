//! Results of each procedure with unit and uncertainty, then the procedure's own report, then its uncertainty budgets. In: a
//! run. Out: blocks, procedure by procedure.

pub(crate) mod actuators;
pub(crate) mod budget_table;
pub(crate) mod line_fit;
pub(crate) mod tracking;

use super::{Source, with_spaces};
use crate::plan::formula::{Estimate, Part, ProcedureId, ResultReference, ResultValue};
use crate::procedures;
use crate::record::{NamedResult, ProcedureRecord};
use crate::report::budget::coverage_factor;
use crate::report::document::{Block, Column, Table, Text};
use crate::report::number;
use crate::report::run::Run;
use crate::report::wording::results as wording;
use crate::uncertainty::{Known, known};
use crate::units::Dimension;

/// Every procedure that was run, in order.
pub(super) fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    let run = source.run;
    body.push(Block::section(wording::TITLE));
    if run.record.procedures.is_empty() {
        body.push(Block::paragraph(wording::NO_PROCEDURE));
    }
    for (index, procedure) in run.record.procedures.iter().enumerate() {
        let state = if procedure.complete {
            ""
        } else {
            wording::NOT_COMPLETE
        };
        body.push(Block::part(
            Text::from(procedure.name.as_str()).soft(format!(" · {}{state}", procedure.kind)),
        ));
        inputs(procedure, body);
        results(run, index, procedure, body);
        procedures::report(run, index, procedure, body);
        budget_table::append(run, index, procedure, body);
    }
}

/// A note with the input values of the procedure.
fn inputs(procedure: &ProcedureRecord, body: &mut Vec<Block>) {
    let text = |(name, estimate, dimension): &(&'static str, Estimate, Dimension)| {
        let value = match estimate.uncertainty {
            Some(_) => number::with_uncertainty(estimate.value, estimate.uncertainty, *dimension),
            None => number::stated(estimate.value, *dimension),
        };
        format!("{} {value}", with_spaces(name))
    };
    let texts: Vec<String> = procedure.inputs.iter().map(text).collect();
    if !texts.is_empty() {
        let uncertain = procedure
            .inputs
            .iter()
            .any(|(_, estimate, _)| estimate.uncertainty.is_some());
        let kind = if uncertain {
            wording::U_IN_BRACKETS
        } else {
            ""
        };
        body.push(Block::note(wording::run_with(kind, texts.join("; "))));
    }
}

/// The table of results, without lists that have a separate table. Results without a value are named below it.
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
            Text::from(wording::NONE_IN_THIS_RUN_OF),
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
    body.extend(budget_table::mark_note(procedure));
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
    // The column of k is omitted if k is 2 throughout.
    let partial = budget_table::Scope::of(run) == budget_table::Scope::PartialReal;
    let factors = !partial
        && all
            .iter()
            .flatten()
            .any(|known| coverage_factor::differs_from_two(*known));
    let mut columns = vec![
        Column::words(wording::RESULT, 1),
        Column::numbers(wording::VALUE),
        Column::numbers("u"),
        Column::numbers(if factors { "U = k·u" } else { "U (k = 2)" }),
        Column::short(wording::UNIT),
        Column::short(wording::IN_THE_PLAN),
    ];
    // On a real rig, a partial budget gives no U.
    if partial {
        columns[3] = Column::numbers(wording::NO_U_PARTIAL);
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
        // The number of digits of R² depends on the number of nines.
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
        ResultValue::Number { value: None, .. } => [
            Text::missing(wording::NONE_IN_THIS_RUN),
            dash(),
            dash(),
            dash(),
        ],
        ResultValue::List(values) if values.is_empty() => [
            Text::missing(wording::NONE_IN_THIS_RUN),
            dash(),
            dash(),
            dash(),
        ],
        ResultValue::List(values) => {
            let text = |value: &f64| {
                if value.is_finite() {
                    number::text(*value, result.dimension)
                } else {
                    wording::NONE.to_owned()
                }
            };
            let texts: Vec<String> = values.iter().map(text).collect();
            [texts.join(", ").into(), dash(), dash(), dash()]
        }
    };
    let reliable =
        !matches!(result.value, ResultValue::Number { .. }) || budget_table::is_reliable(result, 0);
    let mark = if reliable { "" } else { budget_table::MARK };
    let name = Text::from(with_spaces(result.name)).and(mark);
    vec![
        name,
        value,
        standard,
        expanded,
        unit,
        Text::new().code(result.name),
    ]
}
