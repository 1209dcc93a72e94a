//! Tables: one row a step, SI, the column names of the language. In: the record. Out: CSV with shortest round-trip
//! numbers and Parquet (zstd), both from one Polars frame. Knows nothing of units for people.

mod blows;
mod cyclic;
mod drift;

use polars::prelude::{Column, CsvWriter, DataFrame, ParquetCompression, ParquetWriter, PolarsError, SerWriter as _};

use super::{OutputError, OutputFile, Run, shake_table, storey_table, wants};
use crate::inert;
use crate::plan::Format;
use crate::record::{BlowHistory, Drift, History, Hold, ImpactStep, ProcedureRecord, RampStep, SweepStep};
use crate::run::driven::DrivenStep;

/// The tables of every procedure that recorded steps, in the formats the plan asks for.
pub(super) fn all(run: &Run<'_>) -> Result<Vec<OutputFile>, OutputError> {
    let mut files = Vec::new();
    for procedure in &run.record.procedures {
        let failed = |error: PolarsError| OutputError::Table { procedure: procedure.name.clone(), reason: error.to_string() };
        let Some(frame) = frame(procedure).map_err(failed)? else { continue };
        written(run, &procedure.name, frame, &mut files).map_err(failed)?;
        if let History::Escalate(history) = &procedure.history {
            for (number, blow) in (1..).zip(&history.blows) {
                let (height, columns) = match &blow.history {
                    BlowHistory::Impact(history) => (history.steps.len(), impact(&history.steps)),
                    BlowHistory::Storey(history) => storey_table::columns(history),
                };
                let frame = DataFrame::new(height, columns).map_err(failed)?;
                written(run, &format!("{}_{number}", procedure.name), frame, &mut files).map_err(failed)?;
            }
            if let Some((height, columns)) = blows::storeys(history) {
                let frame = DataFrame::new(height, columns).map_err(failed)?;
                written(run, &format!("{}_storeys", procedure.name), frame, &mut files).map_err(failed)?;
            }
        }
        if let History::Ramp(history) = &procedure.history
            && !history.holds.is_empty()
        {
            let holds = holds(&history.holds).map_err(failed)?;
            written(run, &format!("{}_holds", procedure.name), holds, &mut files).map_err(failed)?;
        }
        if let History::Cycle(history) = &procedure.history {
            let cycles = cyclic::cycles(history).map_err(failed)?;
            written(run, &format!("{}_cycles", procedure.name), cycles, &mut files).map_err(failed)?;
        }
    }
    if let Some(found) = &run.record.drift {
        let failed = |error: PolarsError| OutputError::Table { procedure: "drift".to_owned(), reason: error.to_string() };
        let (height, columns) = drift::rows(found);
        let frame = DataFrame::new(height, columns).map_err(failed)?;
        written(run, "drift", frame, &mut files).map_err(failed)?;
    }
    Ok(files)
}

/// One table in the formats the plan asks for.
fn written(run: &Run<'_>, name: &str, mut frame: DataFrame, files: &mut Vec<OutputFile>) -> Result<(), PolarsError> {
    let stem = inert::file_part(name);
    if wants(run.plan, Format::Csv) {
        files.push(OutputFile { path: format!("tables/{stem}.csv"), bytes: csv(&mut frame)? });
    }
    if wants(run.plan, Format::Parquet) {
        files.push(OutputFile { path: format!("tables/{stem}.parquet"), bytes: parquet(&mut frame)? });
    }
    Ok(())
}

/// The targets of a client that drove the rig and what was read there; what its zeros did, where they were read.
pub(super) fn driven(steps: &[DrivenStep], found: Option<&Drift>) -> Result<Vec<OutputFile>, OutputError> {
    let failed = |error: PolarsError| OutputError::Table { procedure: "served".to_owned(), reason: error.to_string() };
    // A row a step and axis; which axis it is, is said where there are several.
    let several = steps.iter().any(|step| step.command.len() > 1);
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
    let mut frame = DataFrame::new(rows.len(), columns).map_err(failed)?;
    let mut files = vec![OutputFile { path: "tables/served.csv".to_owned(), bytes: csv(&mut frame).map_err(failed)? }];
    if let Some(found) = found {
        let (height, columns) = drift::rows(found);
        let mut frame = DataFrame::new(height, columns).map_err(failed)?;
        files.push(OutputFile { path: "tables/drift.csv".to_owned(), bytes: csv(&mut frame).map_err(failed)? });
    }
    Ok(files)
}

fn csv(frame: &mut DataFrame) -> Result<Vec<u8>, PolarsError> {
    let mut bytes = Vec::new();
    CsvWriter::new(&mut bytes).include_header(true).finish(frame)?;
    Ok(bytes)
}

fn parquet(frame: &mut DataFrame) -> Result<Vec<u8>, PolarsError> {
    let mut bytes = Vec::new();
    ParquetWriter::new(&mut bytes).with_compression(ParquetCompression::Zstd(None)).finish(frame)?;
    Ok(bytes)
}

/// The frame of a procedure; None where it records no steps.
fn frame(procedure: &ProcedureRecord) -> Result<Option<DataFrame>, PolarsError> {
    let (height, columns) = match &procedure.history {
        History::Ramp(history) => (history.steps.len(), ramp(&history.steps)),
        History::Move(steps) => (steps.len(), ramp(steps)),
        History::FrameUnload(steps) => storey_table::unloading(steps),
        History::Sweep(history) => (history.steps.len(), sweep(&history.steps)),
        History::Impact(history) => (history.steps.len(), impact(&history.steps)),
        History::StoreyImpact(history) => storey_table::columns(history),
        History::Shake(history) => shake_table::columns(&history.steps),
        History::Escalate(history) => (history.blows.len(), blows::rows(history)),
        History::Cycle(history) => (history.steps.len(), cyclic::steps(&history.steps)),
        History::Inspect => return Ok(None),
    };
    DataFrame::new(height, columns).map(Some)
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
fn holds(holds: &[Hold]) -> Result<DataFrame, PolarsError> {
    let rows: Vec<(u64, f64, f64)> =
        holds.iter().flat_map(|hold| hold.readings.iter().map(|(time, force)| (hold.step, *time, *force))).collect();
    let columns = vec![
        integers("step", &rows, |row| row.0),
        numbers("time_s", &rows, |row| row.1),
        numbers("restoring_force_n", &rows, |row| row.2),
    ];
    DataFrame::new(rows.len(), columns)
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
