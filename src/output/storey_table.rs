//! Tables of floors: of an impact on a storey a row a step and storey, striker and contact beside it; of an unloading a row a
//! move and storey. In: a history. Out: columns in SI. Striker, contact and the energies of the whole frame are the same in every row of a step.

use polars::prelude::Column;

use crate::record::{FloorStep, Floors, ImpactStep, StoreyImpactHistory, UnloadStep};

/// Rows and columns, the storeys of a step after each other from the ground up.
pub(super) fn columns(history: &StoreyImpactHistory) -> (usize, Vec<Column>) {
    let steps = history.blow.steps.iter().zip(&history.floors);
    let rows: Vec<Row<'_>> = steps.flat_map(|(step, floors)| rows_of(step, floors)).collect();
    let numbers = |name: &str, read: fn(&Row<'_>) -> f64| Column::new(name.into(), rows.iter().map(read).collect::<Vec<f64>>());
    let whole = |name: &str, read: fn(&Row<'_>) -> u64| Column::new(name.into(), rows.iter().map(read).collect::<Vec<u64>>());
    let states: Vec<&str> = rows.iter().map(|row| row.step.state.name()).collect();
    let columns = vec![
        whole("step", |row| row.step.step),
        whole("storey", |row| row.floor as u64 + 1),
        numbers("time_s", |row| row.step.time),
        numbers("wall_time_s", |row| row.step.wall_time),
        Column::new("state".into(), states),
        numbers("command_m", |row| row.floors.command[row.floor]),
        numbers("displacement_m", |row| row.floors.displacement[row.floor]),
        numbers("computed_m", |row| row.floors.computed[row.floor]),
        numbers("velocity_m_per_s", |row| row.floors.velocity[row.floor]),
        numbers("acceleration_m_per_s2", |row| row.floors.acceleration[row.floor]),
        numbers("restoring_force_n", |row| row.floors.restoring_force[row.floor]),
        numbers("drift_m", |row| row.drift),
        numbers("storey_shear_n", |row| row.shear),
        numbers("storey_energy_j", |row| row.floors.storey_energy[row.floor]),
        numbers("contact_force_n", |row| row.step.contact_force),
        numbers("striker_displacement_m", |row| row.step.striker_displacement),
        numbers("striker_velocity_m_per_s", |row| row.step.striker_velocity),
        numbers("indentation_m", |row| row.step.indentation),
        numbers("striker_energy_j", |row| row.step.energies.striker),
        numbers("structure_energy_j", |row| row.step.energies.structure),
        numbers("restoring_energy_j", |row| row.step.energies.restoring),
        numbers("damping_energy_j", |row| row.step.energies.damping),
        numbers("contact_loss_j", |row| row.step.energies.contact_loss),
        numbers("indentation_energy_j", |row| row.step.energies.indentation),
        numbers("weight_work_j", |row| row.step.energies.weight),
        numbers("energy_error_j", |row| row.step.energies.error),
        numbers("tracking_energy_error_j", |row| row.floors.tracking[row.floor].energy_error),
        numbers("tracking_indicator_m2", |row| row.floors.tracking[row.floor].indicator),
    ];
    (rows.len(), columns)
}

struct Row<'a> {
    step: &'a ImpactStep,
    floors: &'a FloorStep,
    floor: usize,
    drift: f64,
    shear: f64,
}

fn rows_of<'a>(step: &'a ImpactStep, floors: &'a FloorStep) -> Vec<Row<'a>> {
    let storeys = floors.drift().into_iter().zip(floors.shear()).enumerate();
    storeys.map(|(floor, (drift, shear))| Row { step, floors, floor, drift, shear }).collect()
}

/// A move, a storey, its drift and its shear.
type Unloaded<'a> = (&'a UnloadStep, usize, f64, f64);

/// Rows and columns of an unloading; step 0 is where it began.
pub(super) fn unloading(steps: &[UnloadStep]) -> (usize, Vec<Column>) {
    let storeys = |step: &'_ UnloadStep| step.drift().into_iter().zip(step.shear()).enumerate().collect::<Vec<_>>();
    let rows: Vec<Unloaded<'_>> = steps
        .iter()
        .flat_map(|step| storeys(step).into_iter().map(move |(floor, (drift, shear))| (step, floor, drift, shear)))
        .collect();
    let numbers =
        |name: &str, read: fn(&Unloaded<'_>) -> f64| Column::new(name.into(), rows.iter().map(read).collect::<Vec<f64>>());
    let whole =
        |name: &str, read: fn(&Unloaded<'_>) -> u64| Column::new(name.into(), rows.iter().map(read).collect::<Vec<u64>>());
    let tangents: Vec<Option<f64>> = rows.iter().map(|(step, floor, ..)| step.tangent_stiffness[*floor]).collect();
    let columns = vec![
        whole("step", |(step, ..)| step.step),
        whole("storey", |(_, floor, ..)| *floor as u64 + 1),
        numbers("wall_time_s", |(step, ..)| step.wall_time),
        numbers("command_m", |(step, floor, ..)| step.command[*floor]),
        numbers("displacement_m", |(step, floor, ..)| step.displacement[*floor]),
        numbers("restoring_force_n", |(step, floor, ..)| step.restoring_force[*floor]),
        numbers("drift_m", |(.., drift, _)| *drift),
        numbers("storey_shear_n", |(.., shear)| *shear),
        Column::new("tangent_stiffness_n_per_m".into(), tangents),
    ];
    (rows.len(), columns)
}
