//! Tables of floors: a row a step and storey. Of a shake with the base motion beside it; of an impact on a storey with striker
//! and contact; of an unloading, a row a move and storey. In: steps. Out: columns in SI. What is the whole frame's is the same in
//! every row of a step; what tracking made of its energy is each floor's own.

use polars::prelude::Column;

use super::{integers, numbers, texts};
use crate::record::{FloorStep, Floors, ImpactStep, ShakeStep, UnloadStep};

/// A storey at the end of a step, with what else there is of the step.
struct Row<'a, F, S> {
    step: S,
    floors: &'a F,
    floor: usize,
    drift: f64,
    shear: f64,
}

/// The storeys of a step after each other, from the ground up.
fn rows<'a, F: Floors + 'a, S: Copy>(steps: impl Iterator<Item = (&'a F, S)>) -> Vec<Row<'a, F, S>> {
    let storeys = |(floors, step): (&'a F, S)| {
        let storeys = floors.drift().into_iter().zip(floors.shear()).enumerate();
        storeys.map(move |(floor, (drift, shear))| Row { step, floors, floor, drift, shear })
    };
    steps.flat_map(storeys).collect()
}

pub(super) fn shake(steps: &[ShakeStep]) -> Vec<Column> {
    let rows = rows(steps.iter().map(|step| (step, ())));
    let of = |name, read: fn(&Row<'_, ShakeStep, ()>) -> f64| numbers(name, &rows, read);
    vec![
        integers("step", &rows, |row| row.floors.step),
        integers("storey", &rows, |row| row.floor as u64 + 1),
        of("time_s", |row| row.floors.time),
        of("wall_time_s", |row| row.floors.wall_time),
        of("ground_acceleration_m_per_s2", |row| row.floors.ground_acceleration),
        of("command_m", |row| row.floors.command[row.floor]),
        of("displacement_m", |row| row.floors.displacement[row.floor]),
        of("computed_m", |row| row.floors.computed[row.floor]),
        of("velocity_m_per_s", |row| row.floors.velocity[row.floor]),
        of("acceleration_m_per_s2", |row| row.floors.acceleration[row.floor]),
        of("restoring_force_n", |row| row.floors.restoring_force[row.floor]),
        of("drift_m", |row| row.drift),
        of("storey_shear_n", |row| row.shear),
        of("kinetic_energy_j", |row| row.floors.energies.kinetic),
        of("restoring_energy_j", |row| row.floors.energies.restoring),
        of("damping_energy_j", |row| row.floors.energies.damping),
        of("input_energy_j", |row| row.floors.energies.input),
        of("energy_error_j", |row| row.floors.energies.error),
        of("tracking_energy_error_j", |row| row.floors.tracking[row.floor].energy_error),
        of("tracking_indicator_m2", |row| row.floors.tracking[row.floor].indicator),
    ]
}

/// Of an impact on a storey: what the striker did, and the floors beside it.
pub(super) fn storey_impact(steps: &[ImpactStep], floors: &[FloorStep]) -> Vec<Column> {
    let rows = rows(floors.iter().zip(steps));
    let of = |name, read: fn(&Row<'_, FloorStep, &ImpactStep>) -> f64| numbers(name, &rows, read);
    vec![
        integers("step", &rows, |row| row.step.step),
        integers("storey", &rows, |row| row.floor as u64 + 1),
        of("time_s", |row| row.step.time),
        of("wall_time_s", |row| row.step.wall_time),
        texts("state", &rows, |row| row.step.state.name()),
        of("command_m", |row| row.floors.command[row.floor]),
        of("displacement_m", |row| row.floors.displacement[row.floor]),
        of("computed_m", |row| row.floors.computed[row.floor]),
        of("velocity_m_per_s", |row| row.floors.velocity[row.floor]),
        of("acceleration_m_per_s2", |row| row.floors.acceleration[row.floor]),
        of("restoring_force_n", |row| row.floors.restoring_force[row.floor]),
        of("drift_m", |row| row.drift),
        of("storey_shear_n", |row| row.shear),
        of("storey_energy_j", |row| row.floors.storey_energy[row.floor]),
        of("contact_force_n", |row| row.step.contact_force),
        of("striker_displacement_m", |row| row.step.striker_displacement),
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
        of("tracking_energy_error_j", |row| row.floors.tracking[row.floor].energy_error),
        of("tracking_indicator_m2", |row| row.floors.tracking[row.floor].indicator),
    ]
}

/// Of an unloading; step 0 is where it began.
pub(super) fn unloading(steps: &[UnloadStep]) -> Vec<Column> {
    let rows = rows(steps.iter().map(|step| (step, ())));
    let of = |name, read: fn(&Row<'_, UnloadStep, ()>) -> f64| numbers(name, &rows, read);
    let tangents: Vec<Option<f64>> = rows.iter().map(|row| row.floors.tangent_stiffness[row.floor]).collect();
    vec![
        integers("step", &rows, |row| row.floors.step),
        integers("storey", &rows, |row| row.floor as u64 + 1),
        of("wall_time_s", |row| row.floors.wall_time),
        of("command_m", |row| row.floors.command[row.floor]),
        of("displacement_m", |row| row.floors.displacement[row.floor]),
        of("restoring_force_n", |row| row.floors.restoring_force[row.floor]),
        of("drift_m", |row| row.drift),
        of("storey_shear_n", |row| row.shear),
        Column::new("tangent_stiffness_n_per_m".into(), tangents),
    ]
}
