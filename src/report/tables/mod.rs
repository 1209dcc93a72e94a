//! Tables: one row per step, SI, with the column names of the schema. In: the record. Out: CSV and
//! Parquet, into the sink of the caller. It knows no display unit.

mod column;
mod csv;
mod table;
mod zero_drift;

use std::iter::once;
use std::rc::Rc;

pub(crate) use polars::prelude::Column;

use super::output::file::{OutputError, wants};
use super::output::paths::make_unique;
use super::output::sink::{FileDigest, OutputSink, put_chunks};
use super::run::Run;
use crate::procedures;
use TableColumn::{Integer, Number};
pub(crate) use column::{TableColumn, each_once, numeric, written, written_one_by_one};
use psd_plan::Format;
use psd_plan::record::Drift;
use psd_plan::record::remote::DrivenStep;
use psd_plan::schema::columns;
use psd_text::sanitize;
use table::Form;
pub(crate) use table::Table;

/// A table in one format, with its path.
pub(super) struct Unwritten<'a> {
    table: Rc<Table<'a>>,
    form: Form,
    path: String,
}

impl Unwritten<'_> {
    /// Writes the table into the sink.
    pub fn put(&self, sink: &mut dyn OutputSink) -> Result<FileDigest, OutputError> {
        put_one(&self.table, self.form, &self.path, sink)
    }
}

/// The tables of every procedure that recorded steps, in the formats that the plan requests.
pub(super) fn of_run<'a>(run: &Run<'a>) -> Vec<Unwritten<'a>> {
    let forms = [(Format::Csv, Form::Csv), (Format::Parquet, Form::Parquet)];
    let forms: Vec<Form> = forms
        .into_iter()
        .filter(|(format, _)| wants(run.plan, *format))
        .map(|(_, form)| form)
        .collect();
    let mut files = Vec::new();
    for table in all(run).into_iter().map(Rc::new) {
        let stem = sanitize::file_part(&table.name);
        let path = |form: &Form| format!("tables/{stem}.{}", form.ending());
        files.extend(forms.iter().map(|form| Unwritten {
            table: Rc::clone(&table),
            form: *form,
            path: path(form),
        }));
    }
    make_unique(files.iter_mut().map(|file| &mut file.path));
    files
}

fn all<'a>(run: &Run<'a>) -> Vec<Table<'a>> {
    let tables = |procedure| procedures::tables(run.plan, procedure);
    let of_procedures = run.record.procedures.iter().flat_map(tables);
    let zero_drift = run.record.drift.as_ref().map(zero_drift_table);
    of_procedures.chain(zero_drift).collect()
}

/// Writes the tables of a run that a client controlled: targets with readings, and the zero drift if it was measured.
///
/// # Errors
/// A table that cannot be encoded or kept.
pub fn put_driven(
    steps: &[DrivenStep],
    zero_drift: Option<&Drift>,
    sink: &mut dyn OutputSink,
) -> Result<Vec<FileDigest>, OutputError> {
    // One row per step and axis, with a column for the axis if there are several.
    let axes = steps
        .iter()
        .map(|step| step.command.len())
        .max()
        .unwrap_or(1);
    let table = Table::of_steps("served".to_owned(), steps.len(), axes, |range| {
        driven_rows(&steps[range], axes > 1)
    });
    let served = (table, "tables/served.csv");
    let drift = zero_drift.map(|drift| (zero_drift_table(drift), "tables/zero_drift.csv"));
    once(served)
        .chain(drift)
        .map(|(table, path)| put_one(&table, Form::Csv, path, sink))
        .collect()
}

fn zero_drift_table(drift: &Drift) -> Table<'_> {
    Table::of_steps("zero_drift".to_owned(), 1, 1, |_| {
        zero_drift::table_columns(drift)
    })
}

fn put_one(
    table: &Table<'_>,
    form: Form,
    path: &str,
    sink: &mut dyn OutputSink,
) -> Result<FileDigest, OutputError> {
    let failed = |error: std::io::Error| OutputError::Table {
        table: table.name.clone(),
        reason: error.to_string(),
    };
    put_chunks(sink, path, |out| table.write(form, out)).map_err(failed)
}

/// One axis of a target and its readings.
struct DrivenRow<'a> {
    step: &'a DrivenStep,
    axis: usize,
}

fn driven_rows(steps: &[DrivenStep], several: bool) -> Vec<Column> {
    let axes = |step| move |axis| DrivenRow { step, axis };
    let rows: Vec<DrivenRow<'_>> = steps
        .iter()
        .flat_map(|step| (0..step.command.len()).map(axes(step)))
        .collect();
    let step: TableColumn<DrivenRow<'_>> = Integer(columns::STEP, |row| row.step.step);
    let storey: TableColumn<DrivenRow<'_>> = Integer(columns::STOREY, |row| row.axis as u64 + 1);
    let readings: [TableColumn<DrivenRow<'_>>; 4] = [
        Number(columns::WALL_TIME, |row| row.step.time),
        Number(columns::COMMAND, |row| row.step.command[row.axis]),
        Number(columns::DISPLACEMENT, |row| row.step.displacement[row.axis]),
        Number(columns::RESTORING_FORCE, |row| row.step.force[row.axis]),
    ];
    let driven: Vec<TableColumn<DrivenRow<'_>>> = once(step)
        .chain(several.then_some(storey))
        .chain(readings)
        .collect();
    written(&driven, &rows)
}
