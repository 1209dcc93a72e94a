//! Tables: one row per step, SI, with the column names of the schema. In: the record. Out: CSV and
//! Parquet, into the sink of the caller. It knows no display unit.

mod drift;
mod table;

use std::iter::once;
use std::rc::Rc;

pub(crate) use polars::prelude::Column;

use super::sink::{Listed, Shelf, put_written};
use super::{OutputError, Run, tell_apart, wants};
use crate::plan::Format;
use crate::procedures;
use crate::record::Drift;
use crate::record::remote::DrivenStep;
use crate::text::sanitize;
use table::Form;
pub(crate) use table::Table;

/// A table in one of its forms, and where it is put.
pub(super) struct Unwritten<'a> {
    table: Rc<Table<'a>>,
    form: Form,
    path: String,
}

impl Unwritten<'_> {
    pub fn put(&self, shelf: &mut dyn Shelf) -> Result<Listed, OutputError> {
        put_one(&self.table, self.form, &self.path, shelf)
    }
}

/// The tables of every procedure that recorded steps, in the formats the plan asks for.
pub(super) fn of<'a>(run: &Run<'a>) -> Vec<Unwritten<'a>> {
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
    tell_apart(files.iter_mut().map(|file| &mut file.path));
    files
}

fn all<'a>(run: &Run<'a>) -> Vec<Table<'a>> {
    let of_procedures = run.record.procedures.iter().flat_map(procedures::tables);
    let drift = run.record.drift.as_ref().map(of_drift);
    of_procedures.chain(drift).collect()
}

/// Puts the targets of a client that drove the rig and what was read there; what its zeros did, where they were read.
pub(super) fn put_driven(
    steps: &[DrivenStep],
    found: Option<&Drift>,
    shelf: &mut dyn Shelf,
) -> Result<Vec<Listed>, OutputError> {
    // A row a step and axis; which axis it is, is said where there are several.
    let axes = steps
        .iter()
        .map(|step| step.command.len())
        .max()
        .unwrap_or(1);
    let table = Table::of_steps("served".to_owned(), steps.len(), axes, |range| {
        driven_rows(&steps[range], axes > 1)
    });
    let served = (table, "tables/served.csv");
    let drift = found.map(|found| (of_drift(found), "tables/drift.csv"));
    once(served)
        .chain(drift)
        .map(|(table, path)| put_one(&table, Form::Csv, path, shelf))
        .collect()
}

fn of_drift(found: &Drift) -> Table<'_> {
    Table::of_steps("drift".to_owned(), 1, 1, |_| drift::rows(found))
}

fn put_one(
    table: &Table<'_>,
    form: Form,
    path: &str,
    shelf: &mut dyn Shelf,
) -> Result<Listed, OutputError> {
    let failed = |error: std::io::Error| OutputError::Table {
        table: table.name.clone(),
        reason: error.to_string(),
    };
    put_written(shelf, path, |out| table.write(form, out)).map_err(failed)
}

fn driven_rows(steps: &[DrivenStep], several: bool) -> Vec<Column> {
    let rows: Vec<(&DrivenStep, usize)> = steps
        .iter()
        .flat_map(|step| (0..step.command.len()).map(move |axis| (step, axis)))
        .collect();
    let of = |name, read: fn(&(&DrivenStep, usize)) -> f64| numbers(name, &rows, read);
    let mut columns = vec![integers("step", &rows, |(step, _)| step.step)];
    if several {
        columns.push(integers("storey", &rows, |(_, axis)| *axis as u64 + 1));
    }
    columns.extend([
        of("wall_time_s", |(step, _)| step.time),
        of("command_m", |(step, axis)| step.command[*axis]),
        of("displacement_m", |(step, axis)| step.displacement[*axis]),
        of("restoring_force_n", |(step, axis)| step.force[*axis]),
    ]);
    columns
}

pub(crate) fn numbers<T>(name: &str, steps: &[T], read: fn(&T) -> f64) -> Column {
    Column::new(name.into(), steps.iter().map(read).collect::<Vec<f64>>())
}

pub(crate) fn integers<T>(name: &str, steps: &[T], read: fn(&T) -> u64) -> Column {
    Column::new(name.into(), steps.iter().map(read).collect::<Vec<u64>>())
}

pub(crate) fn texts<T>(name: &str, steps: &[T], read: fn(&T) -> &'static str) -> Column {
    Column::new(
        name.into(),
        steps
            .iter()
            .map(|step| sanitize::cell(read(step)))
            .collect::<Vec<String>>(),
    )
}
