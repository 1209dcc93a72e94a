//! The second page's results: those that a requirement reads, and the headline results of the procedures. In: a run. Out: a table.

use super::results::budget_table::{self, Scope};
use super::results::read::{ReadResult, exists, read_by_requirements};
use super::{Source, capitalised, entry_name, with_spaces};
use crate::procedures;
use crate::report::budget::coverage_factor;
use crate::report::document::{Block, Column, Table, Text};
use crate::report::number;
use crate::report::run::Run;
use crate::report::wording::{common, headline as wording};
use psd_plan::formula::{ProcedureId, ResultPart, ResultReference, ResultValue};
use psd_plan::uncertainty::{
    MeasurementUncertainty, measurement_uncertainties, measurement_uncertainty,
};
use psd_text::units::display::is_rounding;

/// Headline results of a plan that names none.
const MOST: usize = 6;

/// Results that requirements read, then headline results, with value and expanded uncertainty.
pub(super) fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    let run = source.run;
    body.push(Block::section(wording::TITLE));
    let rows = rows(run);
    if rows.is_empty() {
        body.push(Block::paragraph(if run.record.procedures.is_empty() {
            wording::NO_PROCEDURE
        } else {
            wording::NO_RESULT
        }));
        return;
    }
    let factors = rows
        .iter()
        .filter_map(|row| row.factor.as_deref())
        .any(|factor| factor != "2");
    let marked = rows.iter().any(|row| row.marked);
    let partial = Scope::of(run) == Scope::PartialReal;
    let mut columns = vec![
        Column::words(wording::RESULT, 2),
        Column::words(wording::PROCEDURE, 2),
        Column::numbers(if partial {
            wording::VALUE_WITH_U
        } else {
            wording::VALUE
        }),
    ];
    if factors {
        columns.push(Column::numbers(wording::FACTOR));
    }
    let cells = |row: HeadlineRow| {
        let mut cells = vec![row.name, row.procedure, row.value];
        if factors {
            cells.push(row.factor.map_or_else(|| "".into(), Text::from));
        }
        cells
    };
    body.push(Block::Table(Table {
        columns,
        rows: rows.into_iter().map(cells).collect(),
    }));
    body.push(Block::note(if partial {
        wording::STANDARD
    } else {
        wording::EXPANDED
    }));
    if marked && !super::requirements::prints_mark(run) {
        body.push(Block::note(common::MARKED));
    }
}

/// The rows of the results that exist.
fn rows(run: &Run<'_>) -> Vec<HeadlineRow> {
    let chosen = chosen(run);
    chosen
        .iter()
        .filter_map(|chosen| row(run, chosen))
        .collect()
}

/// The note on the mark † if only the annex with all results has a marked value.
pub(super) fn mark_of_the_annex(source: &Source<'_>, body: &mut Vec<Block>) {
    let run = source.run;
    let explained = super::requirements::prints_mark(run) || rows(run).iter().any(|row| row.marked);
    if !explained && run.record.procedures.iter().any(budget_table::is_marked) {
        body.push(Block::note(common::MARKED));
    }
}

/// A row of the table.
struct HeadlineRow {
    name: Text,
    procedure: Text,
    value: Text,
    /// k; None without U.
    factor: Option<String>,
    /// Whether the value has the mark †.
    marked: bool,
}

/// The results of the second page, in the order of the plan.
pub(super) fn chosen(run: &Run<'_>) -> Vec<ReadResult> {
    let mut chosen: Vec<ReadResult> = Vec::new();
    let add = |chosen: &mut Vec<ReadResult>, result: ReadResult| {
        if !chosen
            .iter()
            .any(|other| other.is_same_entry(result, run.record))
        {
            chosen.push(result);
        }
    };
    for read in read_by_requirements(run.plan) {
        add(&mut chosen, read);
    }
    if let Some(named) = &run.plan.report.results {
        for reference in named {
            add(
                &mut chosen,
                ReadResult {
                    reference: *reference,
                    entry: None,
                },
            );
        }
    } else {
        let mut left = MOST;
        for result in headlines(run) {
            let known = chosen.len();
            if left > 0 {
                add(&mut chosen, result);
            }
            left -= chosen.len() - known;
        }
    }
    chosen.sort_by_key(|chosen| chosen.reference.procedure.0);
    chosen
}

/// The headline results that exist: the first of every procedure, then the second of every procedure, and so on.
fn headlines(run: &Run<'_>) -> Vec<ReadResult> {
    let names: Vec<Vec<&'static str>> = run
        .plan
        .procedures
        .iter()
        .take(run.record.procedures.len())
        .map(|procedure| procedures::listed(&procedure.kind).headline)
        .collect();
    let longest = names.iter().map(Vec::len).max().unwrap_or(0);
    let of_rank = |rank: usize| {
        names.iter().enumerate().filter_map(move |(index, names)| {
            let name = *names.get(rank)?;
            let result = run.record.procedures.get(index)?.result(name)?;
            exists(result).then_some(ReadResult {
                reference: ResultReference {
                    procedure: ProcedureId(index),
                    name,
                    part: ResultPart::Value,
                },
                entry: None,
            })
        })
    };
    (0..longest).flat_map(of_rank).collect()
}

/// None if the procedure was not run, or the result does not exist.
fn row(run: &Run<'_>, chosen: &ReadResult) -> Option<HeadlineRow> {
    let index = chosen.reference.procedure.0;
    let procedure = run.record.procedures.get(index)?;
    let result = procedure.result(chosen.reference.name)?;
    let mut name = Text::from(capitalised(&with_spaces(result.name)));
    let (value, known, entry) = match &result.value {
        ResultValue::Number { value, .. } => {
            let contributions = result.contributions_of(chosen.reference);
            (
                *value,
                measurement_uncertainty(&contributions, run.record),
                0,
            )
        }
        ResultValue::List(values) => {
            let entry = chosen.entry_in(values).unwrap_or(0);
            name = Text::from(capitalised(&entry_name(result.name)));
            let all = measurement_uncertainties(&result.contributions, values.len(), run.record);
            name = name.and(wording::entry(
                budget_table::entry_kind(result.name, procedure),
                entry + 1,
            ));
            let known = if result.contributions.is_empty() {
                None
            } else {
                all.get(entry).copied().flatten()
            };
            (values.get(entry).copied(), known, entry)
        }
    };
    let known = known
        .filter(|known: &MeasurementUncertainty| !is_rounding(known.standard, result.dimension));
    let partial = Scope::of(run) == Scope::PartialReal;
    let text: Text = match (value, known) {
        (None, _) => return None,
        (Some(value), Some(known)) if partial => {
            number::with_uncertainty(value, Some(known.standard), result.dimension).into()
        }
        (Some(value), known) => {
            number::of_result(result.name, value, known, result.dimension).into()
        }
    };
    let marked = known.is_some() && !budget_table::is_reliable(result, entry);
    let mark = if marked { budget_table::MARK } else { "" };
    let factor = known.filter(|_| !partial);
    Some(HeadlineRow {
        name,
        procedure: Text::from(procedure.name.as_str()).soft(format!(" · {}", procedure.kind)),
        value: text.and(mark),
        factor: factor.map(coverage_factor::factor),
        marked,
    })
}
