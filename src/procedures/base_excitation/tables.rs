//! Tables of floors, one row per step and storey: for ground motion with its record, for an impact on a storey with striker and contact,
//! and for an unloading. In: steps. Out: columns in SI. Quantities of the whole frame are the same in every row of a step; the tracking
//! energy is that of each floor.

use crate::record::{FloorStep, Floors, FloorsAt, ImpactStep, ShakeHistory, ShakeStep, UnloadStep};
use crate::report::tables::{Column, Table, integers, numbers, texts};
use crate::schema;
use crate::schema::columns::{self, column};
use crate::units::Dimension;

/// The numeric columns of its table: one row a step and storey; the energies are those of the whole frame.
pub(crate) const COLUMNS: &[schema::Column] = &[
    columns::STEP,
    column("storey", Dimension::NUMBER),
    columns::TIME,
    columns::WALL_TIME,
    column("ground_acceleration_m_per_s2", Dimension::ACCELERATION),
    columns::COMMAND,
    columns::DISPLACEMENT,
    column("computed_m", Dimension::LENGTH),
    columns::VELOCITY,
    column("acceleration_m_per_s2", Dimension::ACCELERATION),
    columns::RESTORING_FORCE,
    column("drift_m", Dimension::LENGTH),
    column("storey_shear_n", Dimension::FORCE),
    column("kinetic_energy_j", Dimension::ENERGY),
    column("restoring_energy_j", Dimension::ENERGY),
    column("damping_energy_j", Dimension::ENERGY),
    column("input_energy_j", Dimension::ENERGY),
    column("energy_error_j", Dimension::ENERGY),
    column("tracking_energy_error_j", Dimension::ENERGY),
    column("tracking_indicator_m2", Dimension::AREA),
];

/// A storey at the end of a step.
struct Row<'a, S> {
    step: &'a S,
    floors: FloorsAt<'a>,
    floor: usize,
    drift: f64,
    shear: f64,
}

/// The storeys of a step after each other, from the ground up.
fn rows<'a, F: Floors + 'a, S>(steps: impl Iterator<Item = (&'a F, &'a S)>) -> Vec<Row<'a, S>> {
    let storeys = |(floors, step): (&'a F, &'a S)| {
        let storeys = floors.drift().into_iter().zip(floors.shear()).enumerate();
        storeys.map(move |(floor, (drift, shear))| Row {
            step,
            floors: floors.at(),
            floor,
            drift,
            shear,
        })
    };
    steps.flat_map(storeys).collect()
}

/// The rows of steps that contain their floors.
fn rows_of<S: Floors>(steps: &[S]) -> Vec<Row<'_, S>> {
    rows(steps.iter().map(|step| (step, step)))
}

/// The number of the storey, from 1.
fn storey<S>(rows: &[Row<'_, S>]) -> Column {
    integers("storey", rows, |row| row.floor as u64 + 1)
}

/// Commanded and measured positions of the floors.
fn positions<S>(rows: &[Row<'_, S>]) -> Vec<Column> {
    vec![
        numbers("command_m", rows, |row| row.floors.command[row.floor]),
        numbers("displacement_m", rows, |row| row.floors.measured[row.floor]),
    ]
}

/// The computed motion of the floors.
fn computed<S>(rows: &[Row<'_, S>]) -> Vec<Column> {
    vec![
        numbers("computed_m", rows, |row| row.floors.computed[row.floor]),
        numbers("velocity_m_per_s", rows, |row| {
            row.floors.velocity[row.floor]
        }),
        numbers("acceleration_m_per_s2", rows, |row| {
            row.floors.acceleration[row.floor]
        }),
    ]
}

/// The restoring forces of the floors, and the drifts and shears of the storeys.
fn forces<S>(rows: &[Row<'_, S>]) -> Vec<Column> {
    vec![
        numbers("restoring_force_n", rows, |row| {
            row.floors.restoring_force[row.floor]
        }),
        numbers("drift_m", rows, |row| row.drift),
        numbers("storey_shear_n", rows, |row| row.shear),
    ]
}

/// The tracking of the floors.
fn tracking<S>(rows: &[Row<'_, S>]) -> Vec<Column> {
    vec![
        numbers("tracking_energy_error_j", rows, |row| {
            row.floors.tracking[row.floor].energy_error
        }),
        numbers("tracking_indicator_m2", rows, |row| {
            row.floors.tracking[row.floor].indicator
        }),
    ]
}

/// The table of a ground-motion test under this name.
pub(crate) fn table(name: String, history: &ShakeHistory) -> Table<'_> {
    let storeys = history.steps.first().map_or(1, |step| step.computed.len());
    Table::of_steps(name, history.steps.len(), storeys, |range| {
        shake(&history.steps[range])
    })
}

pub(crate) fn shake(steps: &[ShakeStep]) -> Vec<Column> {
    let rows = rows_of(steps);
    let of = |name, read: fn(&Row<'_, ShakeStep>) -> f64| numbers(name, &rows, read);
    let step = vec![
        integers("step", &rows, |row| row.step.step),
        storey(&rows),
        of("time_s", |row| row.floors.time),
        of("wall_time_s", |row| row.step.wall_time),
        of("ground_acceleration_m_per_s2", |row| {
            row.step.ground_acceleration
        }),
    ];
    let energies = vec![
        of("kinetic_energy_j", |row| row.step.energies.kinetic),
        of("restoring_energy_j", |row| row.step.energies.restoring),
        of("damping_energy_j", |row| row.step.energies.damping),
        of("input_energy_j", |row| row.step.energies.input),
        of("energy_error_j", |row| row.step.energies.error),
    ];
    [
        step,
        positions(&rows),
        computed(&rows),
        forces(&rows),
        energies,
        tracking(&rows),
    ]
    .concat()
}

/// The columns of an impact on a storey: the striker, and the floors.
pub(crate) fn storey_impact(steps: &[ImpactStep], floors: &[FloorStep]) -> Vec<Column> {
    let rows = rows(floors.iter().zip(steps));
    let of = |name, read: fn(&Row<'_, ImpactStep>) -> f64| numbers(name, &rows, read);
    let step = vec![
        integers("step", &rows, |row| row.step.step),
        storey(&rows),
        of("time_s", |row| row.step.time),
        of("wall_time_s", |row| row.step.wall_time),
        texts("state", &rows, |row| row.step.state.name()),
    ];
    let storeys = floors
        .iter()
        .zip(steps)
        .flat_map(|(floors, _)| floors.storey_energy.iter().copied());
    let striker = vec![
        Column::new("storey_energy_j".into(), storeys.collect::<Vec<f64>>()),
        of("contact_force_n", |row| row.step.contact_force),
        of("striker_displacement_m", |row| {
            row.step.striker_displacement
        }),
        of("striker_velocity_m_per_s", |row| row.step.striker_velocity),
        of("indentation_m", |row| row.step.indentation),
        of("striker_energy_j", |row| row.step.energies.striker),
        of("structure_energy_j", |row| row.step.energies.structure),
        of("restoring_energy_j", |row| row.step.energies.restoring),
        of("damping_energy_j", |row| row.step.energies.damping),
        of("contact_loss_j", |row| row.step.energies.contact_loss),
        of("indentation_energy_j", |row| row.step.energies.indentation),
        of("weight_work_j", |row| row.step.energies.weight),
        of("energy_error_j", |row| row.step.energies.error),
    ];
    [
        step,
        positions(&rows),
        computed(&rows),
        forces(&rows),
        striker,
        tracking(&rows),
    ]
    .concat()
}

/// The columns of an unloading; step 0 is its start.
pub(crate) fn unloading(steps: &[UnloadStep]) -> Vec<Column> {
    let rows = rows_of(steps);
    let step = vec![
        integers("step", &rows, |row| row.step.step),
        storey(&rows),
        numbers("wall_time_s", &rows, |row| row.step.wall_time),
    ];
    let tangents: Vec<Option<f64>> = rows
        .iter()
        .map(|row| row.step.tangent_stiffness[row.floor])
        .collect();
    let tangents = vec![Column::new("tangent_stiffness_n_per_m".into(), tangents)];
    [step, positions(&rows), forces(&rows), tangents].concat()
}
