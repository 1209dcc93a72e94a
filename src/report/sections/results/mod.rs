//! Every result of each procedure with its uncertainty and the text of its method; the uncertainty budgets. In: a run. Out:
//! blocks, procedure by procedure.

pub(crate) mod actuators;
pub(crate) mod budget_table;
pub(crate) mod line_fit;
pub(super) mod read;
pub(crate) mod tracking;

use super::{Source, with_spaces};
use crate::procedures;
use crate::report::budget::coverage_factor;
use crate::report::document::{Block, Column, Table, Text};
use crate::report::number;
use crate::report::run::Run;
use crate::report::wording::{common, results as wording};
use psd_plan::formula::{Estimate, ProcedureId, ResultPart, ResultReference, ResultValue};
use psd_plan::record::{NamedResult, ProcedureRecord};
use psd_plan::uncertainty::{MeasurementUncertainty, measurement_uncertainty};
use psd_text::units::Dimension;
use psd_text::units::display::is_rounding;

/// Every procedure that was run, in order, with the text of its method.
pub(super) fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    let run = source.run;
    for (index, procedure) in run.record.procedures.iter().enumerate() {
        let state = if procedure.complete {
            ""
        } else {
            wording::NOT_COMPLETE
        };
        body.push(Block::part(
            Text::from(procedure.name.as_str()).soft(format!(" · {}{state}", procedure.kind)),
        ));
        inputs(run, index, procedure, body);
        results(run, index, procedure, body);
        procedures::report(run, index, procedure, body);
    }
}

/// The uncertainty budgets of every procedure.
pub(super) fn budgets(source: &Source<'_>, body: &mut Vec<Block>) {
    budget_table::section(source.run, body);
}

/// The condition under which the series of impacts of a procedure goes on, in words; None for any other procedure.
pub(super) fn criterion(run: &Run<'_>, index: usize) -> Option<String> {
    let planned = run.plan.procedures.get(index)?;
    let conditions = procedures::facts_of(&planned.kind).conditions?;
    let texts: Vec<String> = conditions
        .iter()
        .map(|condition| with_spaces(&condition.text))
        .collect();
    Some(texts.join(" and "))
}

/// A note with the input values of the procedure.
fn inputs(run: &Run<'_>, index: usize, procedure: &ProcedureRecord, body: &mut Vec<Block>) {
    let text = |(name, estimate, dimension): &(&'static str, Estimate, Dimension)| {
        let value = match estimate.uncertainty {
            Some(_) => number::with_uncertainty(estimate.value, estimate.uncertainty, *dimension),
            None => number::stated(estimate.value, *dimension),
        };
        format!("{} {value}", with_spaces(name))
    };
    let criterion = criterion(run, index).map(wording::next_impact_while);
    let texts: Vec<String> = procedure.inputs.iter().map(text).chain(criterion).collect();
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

/// The table of the results that exist, without those that a separate table or a sentence states.
fn results(run: &Run<'_>, index: usize, procedure: &ProcedureRecord, body: &mut Vec<Block>) {
    let tabled = procedures::recorded(&procedure.history).lists_are_tabled;
    let unprinted = run
        .plan
        .procedures
        .get(index)
        .map_or_else(Vec::new, |planned| {
            procedures::listed(&planned.kind).unprinted
        });
    let printed: Vec<&NamedResult> = procedure
        .results
        .iter()
        .filter(|result| !(tabled && matches!(result.value, ResultValue::List(_))))
        .filter(|result| read::exists(result) && !unprinted.contains(&result.name))
        .collect();
    if !printed.is_empty() {
        body.push(table(run, index, &printed));
    }
}

/// Name, value, U, k where it differs from 2, and unit.
fn table(run: &Run<'_>, index: usize, results: &[&NamedResult]) -> Block {
    let known = |result: &NamedResult| {
        let reference = ResultReference {
            procedure: ProcedureId(index),
            name: result.name,
            part: ResultPart::Value,
        };
        measurement_uncertainty(&result.contributions_of(reference), run.record)
            .filter(|known| !is_rounding(known.standard, result.dimension))
            .filter(|_| matches!(result.value, ResultValue::Number { .. }))
    };
    let all: Vec<Option<MeasurementUncertainty>> =
        results.iter().map(|result| known(result)).collect();
    // On a real rig, a partial budget gives no U.
    let partial = budget_table::Scope::of(run) == budget_table::Scope::PartialReal;
    let differs = |known: &MeasurementUncertainty| coverage_factor::differs_from_two(*known);
    let factors = !partial && all.iter().flatten().any(differs);
    let mut columns = vec![
        Column::words(wording::RESULT, 1),
        Column::numbers(wording::VALUE),
    ];
    match (partial, all.iter().any(Option::is_some)) {
        (_, false) => {}
        (true, true) => columns.push(Column::numbers(wording::STANDARD)),
        (false, true) => columns.push(Column::numbers(if factors {
            wording::EXPANDED
        } else {
            wording::EXPANDED_BY_TWO
        })),
    }
    let with_uncertainty = columns.len() > 2;
    if factors {
        columns.push(Column::numbers(wording::FACTOR));
    }
    columns.push(Column::short(wording::UNIT));
    let rows = results.iter().zip(&all).map(|(result, known)| {
        let [name, value, standard, expanded, unit] = row(result, *known);
        let mut row = vec![name, value];
        if with_uncertainty {
            row.push(if partial { standard } else { expanded });
        }
        if factors {
            row.push(known.map_or_else(|| "".into(), factor));
        }
        row.push(unit);
        row
    });
    Block::Table(Table {
        columns,
        rows: rows.collect(),
    })
}

/// `2.37 (8)`
fn factor(known: MeasurementUncertainty) -> Text {
    let degrees = coverage_factor::degrees_text(known);
    format!("{} ({degrees})", coverage_factor::factor(known)).into()
}

/// Name, value, u, U and unit. A cell without a content is empty.
fn row(result: &NamedResult, known: Option<MeasurementUncertainty>) -> [Text; 5] {
    let none = || Text::from("");
    let [value, standard, expanded, unit] = match &result.value {
        ResultValue::Number {
            value: Some(value), ..
        } => {
            let parts = number::parts_of_result(result.name, *value, known, result.dimension);
            [
                parts.value.into(),
                parts.standard.map_or_else(none, Text::from),
                parts.expanded.map_or_else(none, Text::from),
                parts.unit.into(),
            ]
        }
        ResultValue::Number { value: None, .. } => {
            [Text::missing(common::NO_VALUE), none(), none(), none()]
        }
        ResultValue::List(values) => {
            let text = |value: &f64| {
                if value.is_finite() {
                    number::of_result(result.name, *value, None, result.dimension)
                } else {
                    wording::NONE.to_owned()
                }
            };
            let texts: Vec<String> = values.iter().map(text).collect();
            [texts.join(", ").into(), none(), none(), none()]
        }
    };
    let reliable =
        !matches!(result.value, ResultValue::Number { .. }) || budget_table::is_reliable(result, 0);
    let mark = if reliable { "" } else { budget_table::MARK };
    let name = Text::from(with_spaces(result.name)).and(mark);
    [name, value, standard, expanded, unit]
}
