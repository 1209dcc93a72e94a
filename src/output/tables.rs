//! Tables: one row a step, SI, the column names of the language. In: the record. Out: CSV and Parquet, put where the caller
//! wants them. Knows nothing of units for people.

mod blows;
mod cyclic;
mod drift;
mod floors;
mod table;

use std::iter::once;
use std::rc::Rc;

use polars::prelude::Column;

use super::shelf::{Listed, Shelf, put_written};
use super::{OutputError, Run, tell_apart, wants};
use crate::inert;
use crate::plan::Format;
use crate::record::{
    BlowHistory, Drift, EscalateHistory, History, Hold, ImpactHistory, ImpactStep, ProcedureRecord, RampStep,
    StoreyImpactHistory, SweepStep,
};
use crate::run::driven::DrivenStep;
use table::{Form, Table};

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
    let forms: Vec<Form> = forms.into_iter().filter(|(format, _)| wants(run.plan, *format)).map(|(_, form)| form).collect();
    let mut files = Vec::new();
    for table in all(run).into_iter().map(Rc::new) {
        let stem = inert::file_part(&table.name);
        let path = |form: &Form| format!("tables/{stem}.{}", form.ending());
        files.extend(forms.iter().map(|form| Unwritten { table: Rc::clone(&table), form: *form, path: path(form) }));
    }
    tell_apart(files.iter_mut().map(|file| &mut file.path));
    files
}

fn all<'a>(run: &Run<'a>) -> Vec<Table<'a>> {
    let of_procedures = run.record.procedures.iter().flat_map(of_procedure);
    let drift = run.record.drift.as_ref().map(of_drift);
    of_procedures.chain(drift).collect()
}

/// Puts the targets of a client that drove the rig and what was read there; what its zeros did, where they were read.
pub(super) fn put_driven(steps: &[DrivenStep], found: Option<&Drift>, shelf: &mut dyn Shelf) -> Result<Vec<Listed>, OutputError> {
    // A row a step and axis; which axis it is, is said where there are several.
    let axes = steps.iter().map(|step| step.command.len()).max().unwrap_or(1);
    let table = Table::of_steps("served".to_owned(), steps.len(), axes, |range| driven_rows(&steps[range], axes > 1));
    let served = (table, "tables/served.csv");
    let drift = found.map(|found| (of_drift(found), "tables/drift.csv"));
    once(served).chain(drift).map(|(table, path)| put_one(&table, Form::Csv, path, shelf)).collect()
}

fn of_drift(found: &Drift) -> Table<'_> {
    Table::of_steps("drift".to_owned(), 1, 1, |_| drift::rows(found))
}

fn put_one(table: &Table<'_>, form: Form, path: &str, shelf: &mut dyn Shelf) -> Result<Listed, OutputError> {
    let failed = |error: std::io::Error| OutputError::Table { table: table.name.clone(), reason: error.to_string() };
    put_written(shelf, path, |out| table.write(form, out)).map_err(failed)
}

fn driven_rows(steps: &[DrivenStep], several: bool) -> Vec<Column> {
    let rows: Vec<(&DrivenStep, usize)> =
        steps.iter().flat_map(|step| (0..step.command.len()).map(move |axis| (step, axis))).collect();
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

/// The table of a procedure's steps, and those beside it; none where it records no steps.
fn of_procedure(procedure: &ProcedureRecord) -> Vec<Table<'_>> {
    let name = procedure.name.clone();
    let beside = |what: &str| format!("{name}_{what}");
    match &procedure.history {
        History::Ramp(history) => {
            let holds = (!history.holds.is_empty()).then(|| Table::of(beside("holds"), &history.holds, holds));
            let mut rows: Vec<RampStep> = history.steps.iter().chain(&history.before).copied().collect();
            rows.sort_by_key(|row| row.step);
            once(Table::of_steps(name, rows.len(), 1, move |range| ramp(&rows[range]))).chain(holds).collect()
        }
        History::Move(steps) => vec![Table::of(name, steps, ramp)],
        History::FrameUnload(steps) => vec![Table::of(name, steps, floors::unloading)],
        History::Sweep(history) => vec![Table::of(name, &history.steps, sweep)],
        History::Impact(history) => vec![of_impact(name, history)],
        History::StoreyImpact(history) => vec![of_storey_impact(name, history)],
        History::Shake(history) => {
            let storeys = history.steps.first().map_or(1, |step| step.computed.len());
            vec![Table::of_steps(name, history.steps.len(), storeys, |range| floors::shake(&history.steps[range]))]
        }
        History::Escalate(history) => of_blows(name, history),
        History::Cycle(history) => {
            let cycles = Table::of(beside("cycles"), &history.cycles, cyclic::cycles);
            vec![Table::of(name, &history.steps, cyclic::steps), cycles]
        }
        History::Inspect => Vec::new(),
    }
}

fn of_blows(name: String, history: &EscalateHistory) -> Vec<Table<'_>> {
    let blows = history.blows.iter().zip(1..).map(|(blow, number)| {
        let name = format!("{name}_{number}");
        match &blow.history {
            BlowHistory::Impact(history) => of_impact(name, history),
            BlowHistory::Storey(history) => of_storey_impact(name, history),
        }
    });
    let blows: Vec<Table<'_>> = blows.collect();
    let has_storeys = history.storeys().next().is_some_and(|blow| !blow.floors.is_empty());
    let storeys = has_storeys.then(|| Table::of_steps(format!("{name}_storeys"), 1, 1, |_| blows::storeys(history)));
    once(Table::of_steps(name, 1, 1, |_| blows::rows(history))).chain(blows).chain(storeys).collect()
}

fn of_impact(name: String, history: &ImpactHistory) -> Table<'_> {
    Table::of(name, &history.steps, impact)
}

fn of_storey_impact(name: String, history: &StoreyImpactHistory) -> Table<'_> {
    let storeys = history.floors.first().map_or(1, |floors| floors.computed.len());
    let columns =
        |range: std::ops::Range<usize>| floors::storey_impact(&history.blow.steps[range.clone()], &history.floors[range]);
    Table::of_steps(name, history.floors.len(), storeys, columns)
}

fn impact(steps: &[ImpactStep]) -> Vec<Column> {
    let of = |name, read: fn(&ImpactStep) -> f64| numbers(name, steps, read);
    vec![
        integers("step", steps, |step| step.step),
        of("time_s", |step| step.time),
        of("wall_time_s", |step| step.wall_time),
        texts("state", steps, |step| step.state.name()),
        of("command_m", |step| step.command),
        of("computed_m", |step| step.computed),
        of("displacement_m", |step| step.displacement),
        of("velocity_m_per_s", |step| step.velocity),
        of("acceleration_m_per_s2", |step| step.acceleration),
        of("restoring_force_n", |step| step.restoring_force),
        of("contact_force_n", |step| step.contact_force),
        of("striker_displacement_m", |step| step.striker_displacement),
        of("striker_velocity_m_per_s", |step| step.striker_velocity),
        of("tangent_stiffness_n_per_m", |step| step.tangent_stiffness),
        of("indentation_m", |step| step.indentation),
        of("striker_energy_j", |step| step.energies.striker),
        of("structure_energy_j", |step| step.energies.structure),
        of("restoring_energy_j", |step| step.energies.restoring),
        of("damping_energy_j", |step| step.energies.damping),
        of("contact_loss_j", |step| step.energies.contact_loss),
        of("indentation_energy_j", |step| step.energies.indentation),
        of("weight_work_j", |step| step.energies.weight),
        of("energy_error_j", |step| step.energies.error),
        of("tracking_energy_error_j", |step| step.tracking.energy_error),
        of("tracking_indicator_m2", |step| step.tracking.indicator),
    ]
}

fn ramp(steps: &[RampStep]) -> Vec<Column> {
    let of = |name, read: fn(&RampStep) -> f64| numbers(name, steps, read);
    let tangents: Vec<Option<f64>> = steps.iter().map(|step| step.tangent_stiffness).collect();
    let returning: Vec<bool> = steps.iter().map(|step| step.returning).collect();
    vec![
        integers("step", steps, |step| step.step),
        of("wall_time_s", |step| step.wall_time),
        of("command_m", |step| step.command),
        of("displacement_m", |step| step.displacement),
        of("restoring_force_n", |step| step.restoring_force),
        of("force_scatter_n", |step| step.force_scatter),
        of("relaxation_n", |step| step.relaxation),
        Column::new("tangent_stiffness_n_per_m".into(), tangents),
        Column::new("returning".into(), returning),
    ]
}

/// One row a reading of a hold.
fn holds(holds: &[Hold]) -> Vec<Column> {
    let rows: Vec<(u64, f64, f64)> =
        holds.iter().flat_map(|hold| hold.readings.iter().map(|(time, force)| (hold.step, *time, *force))).collect();
    vec![
        integers("step", &rows, |row| row.0),
        numbers("time_s", &rows, |row| row.1),
        numbers("restoring_force_n", &rows, |row| row.2),
    ]
}

fn sweep(steps: &[SweepStep]) -> Vec<Column> {
    let of = |name, read: fn(&SweepStep) -> f64| numbers(name, steps, read);
    let steady: Vec<bool> = steps.iter().map(|step| step.steady).collect();
    vec![
        integers("step", steps, |step| step.step),
        of("wall_time_s", |step| step.wall_time),
        of("velocity_m_per_s", |step| step.velocity),
        of("displacement_m", |step| step.displacement),
        of("restoring_force_n", |step| step.restoring_force),
        of("damping_force_n", |step| step.damping_force),
        Column::new("steady".into(), steady),
    ]
}

fn numbers<T>(name: &str, steps: &[T], read: fn(&T) -> f64) -> Column {
    Column::new(name.into(), steps.iter().map(read).collect::<Vec<f64>>())
}

fn integers<T>(name: &str, steps: &[T], read: fn(&T) -> u64) -> Column {
    Column::new(name.into(), steps.iter().map(read).collect::<Vec<u64>>())
}

fn texts<T>(name: &str, steps: &[T], read: fn(&T) -> &'static str) -> Column {
    Column::new(name.into(), steps.iter().map(|step| inert::cell(read(step))).collect::<Vec<String>>())
}
