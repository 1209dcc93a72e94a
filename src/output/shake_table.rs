//! The table of a shake: a row a step and storey, with the base motion beside it. In: steps. Out: columns in SI. Energies are
//! the whole frame's, the same in every row of a step; what tracking made of them is each floor's own.

use polars::prelude::Column;

use crate::record::{Floors as _, ShakeStep};

/// Rows and columns, the storeys of a step after each other from the ground up.
pub(super) fn columns(steps: &[ShakeStep]) -> (usize, Vec<Column>) {
    let rows: Vec<Row<'_>> = steps.iter().flat_map(rows_of).collect();
    let numbers = |name: &str, read: fn(&Row<'_>) -> f64| Column::new(name.into(), rows.iter().map(read).collect::<Vec<f64>>());
    let whole = |name: &str, read: fn(&Row<'_>) -> u64| Column::new(name.into(), rows.iter().map(read).collect::<Vec<u64>>());
    let columns = vec![
        whole("step", |row| row.step.step),
        whole("storey", |row| row.floor as u64 + 1),
        numbers("time_s", |row| row.step.time),
        numbers("wall_time_s", |row| row.step.wall_time),
        numbers("ground_acceleration_m_per_s2", |row| row.step.ground_acceleration),
        numbers("command_m", |row| row.step.command[row.floor]),
        numbers("displacement_m", |row| row.step.displacement[row.floor]),
        numbers("computed_m", |row| row.step.computed[row.floor]),
        numbers("velocity_m_per_s", |row| row.step.velocity[row.floor]),
        numbers("acceleration_m_per_s2", |row| row.step.acceleration[row.floor]),
        numbers("restoring_force_n", |row| row.step.restoring_force[row.floor]),
        numbers("drift_m", |row| row.drift),
        numbers("storey_shear_n", |row| row.shear),
        numbers("kinetic_energy_j", |row| row.step.energies.kinetic),
        numbers("restoring_energy_j", |row| row.step.energies.restoring),
        numbers("damping_energy_j", |row| row.step.energies.damping),
        numbers("input_energy_j", |row| row.step.energies.input),
        numbers("energy_error_j", |row| row.step.energies.error),
        numbers("tracking_energy_error_j", |row| row.step.tracking[row.floor].energy_error),
        numbers("tracking_indicator_m2", |row| row.step.tracking[row.floor].indicator),
    ];
    (rows.len(), columns)
}

struct Row<'a> {
    step: &'a ShakeStep,
    floor: usize,
    drift: f64,
    shear: f64,
}

fn rows_of(step: &ShakeStep) -> Vec<Row<'_>> {
    let storeys = step.drift().into_iter().zip(step.shear()).enumerate();
    storeys.map(|(floor, (drift, shear))| Row { step, floor, drift, shear }).collect()
}
