//! Tables of floors, one row per step and storey: for ground motion with its record, for an impact on a storey with striker and contact,
//! and for an unloading. In: steps. Out: columns in SI. Quantities of the whole frame are the same in every row of a step; the tracking
//! energy is that of each floor.

use crate::report::tables::TableColumn::{self, Integer, Number, Optional, Text};
use crate::report::tables::{Column, Table, written};
use psd_plan::record::{
    FloorStep, Floors, FloorsAt, ImpactStep, ShakeHistory, ShakeStep, UnloadStep,
};
use psd_plan::schema::columns::{self, column};
use psd_text::units::Dimension;

/// A storey at the end of a step.
pub(crate) struct FloorRow<'a, S> {
    step: &'a S,
    floors: FloorsAt<'a>,
    floor: usize,
    drift: f64,
    /// Net of P-Δ.
    shear: f64,
    spring_shear: f64,
}

/// An impact on a storey: the step of the striker, and that of the floors.
pub(crate) struct StruckStep<'a> {
    impact: &'a ImpactStep,
    floors: &'a FloorStep,
}

/// The storeys of a step after each other, from the ground up.
fn rows<'a, F: Floors + 'a, S>(
    steps: impl Iterator<Item = (&'a F, &'a S)>,
) -> Vec<FloorRow<'a, S>> {
    let storeys = |(floors, step): (&'a F, &'a S)| {
        let shears = floors.net_shear().into_iter().zip(floors.shear());
        let storeys = floors.drift().into_iter().zip(shears).enumerate();
        storeys.map(move |(floor, (drift, (shear, spring_shear)))| FloorRow {
            step,
            floors: floors.at(),
            floor,
            drift,
            shear,
            spring_shear,
        })
    };
    steps.flat_map(storeys).collect()
}

/// The rows of steps that contain their floors.
fn rows_of<S: Floors>(steps: &[S]) -> Vec<FloorRow<'_, S>> {
    rows(steps.iter().map(|step| (step, step)))
}

/// The number of the storey, from 1.
const fn storey<'a, S>() -> TableColumn<FloorRow<'a, S>> {
    Integer(columns::STOREY, |row| row.floor as u64 + 1)
}

/// Commanded and measured positions of the floors.
fn positions<'a, S>() -> Vec<TableColumn<FloorRow<'a, S>>> {
    vec![
        Number(columns::COMMAND, |row| row.floors.command[row.floor]),
        Number(columns::DISPLACEMENT, |row| row.floors.measured[row.floor]),
    ]
}

/// The computed motion of the floors.
fn computed<'a, S>() -> Vec<TableColumn<FloorRow<'a, S>>> {
    vec![
        Number(columns::COMPUTED, |row| row.floors.computed[row.floor]),
        Number(columns::VELOCITY, |row| row.floors.velocity[row.floor]),
        Number(columns::ACCELERATION, |row| {
            row.floors.acceleration[row.floor]
        }),
    ]
}

/// The shear of the storeys without P-Δ.
fn spring_shear<'a, S>() -> TableColumn<FloorRow<'a, S>> {
    Number(columns::SPRING_SHEAR, |row| row.spring_shear)
}

/// The columns of a frame; those of P-Δ only if a floor has a weight.
fn of_frame<'a, S>(
    mut columns: Vec<TableColumn<FloorRow<'a, S>>>,
    rows: &[FloorRow<'a, S>],
) -> Vec<Column> {
    let weighs = rows
        .first()
        .is_some_and(|row| !row.floors.gravity_force.is_empty());
    let of_weights = [columns::SPRING_SHEAR, columns::GRAVITY_ENERGY].map(Some);
    columns.retain(|column| weighs || !of_weights.contains(&column.numeric()));
    written(&columns, rows)
}

/// The restoring forces of the floors, and the drifts and shears of the storeys.
fn forces<'a, S>() -> Vec<TableColumn<FloorRow<'a, S>>> {
    vec![
        Number(columns::RESTORING_FORCE, |row| {
            row.floors.restoring_force[row.floor]
        }),
        Number(columns::DRIFT, |row| row.drift),
        Number(columns::STOREY_SHEAR, |row| row.shear),
    ]
}

/// The tracking of the floors.
fn tracking<'a, S>() -> Vec<TableColumn<FloorRow<'a, S>>> {
    vec![
        Number(columns::TRACKING_ENERGY_ERROR, |row| {
            row.floors.tracking[row.floor].energy_error
        }),
        Number(columns::TRACKING_INDICATOR, |row| {
            row.floors.tracking[row.floor].indicator
        }),
    ]
}

/// The table of a ground-motion test under this name.
pub(crate) fn table(name: String, history: &ShakeHistory) -> Table<'_> {
    let storeys = history
        .steps
        .first()
        .map_or(1, |step| step.floors.computed.len());
    Table::of_steps(name, history.steps.len(), storeys, |range| {
        of_frame(shake(), &rows_of(&history.steps[range]))
    })
}

/// The columns of a ground-motion test; the energies are those of the whole frame.
pub(crate) fn shake<'a>() -> Vec<TableColumn<FloorRow<'a, ShakeStep>>> {
    let ground_acceleration = column("ground_acceleration_m_per_s2", Dimension::ACCELERATION);
    let step = vec![
        Integer(columns::STEP, |row: &FloorRow<'a, ShakeStep>| row.step.step),
        storey(),
        Number(columns::TIME, |row| row.floors.time),
        Number(columns::WALL_TIME, |row| row.step.wall_time),
        Number(ground_acceleration, |row| row.step.ground_acceleration),
    ];
    let energies = vec![
        Number(
            column("kinetic_energy_j", Dimension::ENERGY),
            |row: &FloorRow<'a, ShakeStep>| row.step.energies.kinetic,
        ),
        Number(columns::RESTORING_ENERGY, |row| row.step.energies.restoring),
        Number(columns::DAMPING_ENERGY, |row| row.step.energies.damping),
        Number(column("input_energy_j", Dimension::ENERGY), |row| {
            row.step.energies.input
        }),
        Number(columns::GRAVITY_ENERGY, |row| row.step.energies.gravity),
        Number(columns::ENERGY_ERROR, |row| row.step.energies.error),
    ];
    joined([
        step,
        positions(),
        computed(),
        forces(),
        vec![spring_shear()],
        energies,
        tracking(),
    ])
}

/// The columns of an impact on a storey: the striker, and the floors.
pub(crate) fn struck<'a>() -> Vec<TableColumn<FloorRow<'a, StruckStep<'a>>>> {
    let step = vec![
        Integer(columns::STEP, |row: &FloorRow<'a, StruckStep<'a>>| {
            row.step.impact.step
        }),
        storey(),
        Number(columns::TIME, |row| row.step.impact.time),
        Number(columns::WALL_TIME, |row| row.step.impact.wall_time),
        Text(columns::STATE, |row| row.step.impact.state.name()),
    ];
    let striker = vec![
        Number(
            columns::STOREY_ENERGY,
            |row: &FloorRow<'a, StruckStep<'a>>| row.step.floors.storey_energy[row.floor],
        ),
        Number(columns::CONTACT_FORCE, |row| row.step.impact.contact_force),
        Number(columns::STRIKER_DISPLACEMENT, |row| {
            row.step.impact.striker_displacement
        }),
        Number(columns::STRIKER_VELOCITY, |row| {
            row.step.impact.striker_velocity
        }),
        Number(columns::INDENTATION, |row| row.step.impact.indentation),
        Number(columns::STRIKER_ENERGY, |row| {
            row.step.impact.energies.striker
        }),
        Number(columns::STRUCTURE_ENERGY, |row| {
            row.step.impact.energies.structure
        }),
        Number(columns::RESTORING_ENERGY, |row| {
            row.step.impact.energies.restoring
        }),
        Number(columns::DAMPING_ENERGY, |row| {
            row.step.impact.energies.damping
        }),
        Number(columns::CONTACT_LOSS, |row| {
            row.step.impact.energies.contact_loss
        }),
        Number(columns::INDENTATION_ENERGY, |row| {
            row.step.impact.energies.indentation
        }),
        Number(columns::WEIGHT_WORK, |row| row.step.impact.energies.weight),
        Number(columns::GRAVITY_ENERGY, |row| {
            row.step.impact.energies.gravity
        }),
        Number(columns::ENERGY_ERROR, |row| row.step.impact.energies.error),
    ];
    joined([
        step,
        positions(),
        computed(),
        forces(),
        vec![spring_shear()],
        striker,
        tracking(),
    ])
}

/// The table of an impact on a storey.
pub(crate) fn storey_impact(steps: &[ImpactStep], floors: &[FloorStep]) -> Vec<Column> {
    let steps: Vec<StruckStep<'_>> = floors
        .iter()
        .zip(steps)
        .map(|(floors, impact)| StruckStep { impact, floors })
        .collect();
    let rows = rows(steps.iter().map(|step| (step.floors, step)));
    of_frame(struck(), &rows)
}

/// The columns of an unloading.
pub(crate) fn unloaded<'a>() -> Vec<TableColumn<FloorRow<'a, UnloadStep>>> {
    let step = vec![
        Integer(columns::STEP, |row: &FloorRow<'a, UnloadStep>| {
            row.step.step
        }),
        storey(),
        Number(columns::WALL_TIME, |row| row.step.wall_time),
    ];
    let tangents = vec![Optional(
        columns::TANGENT_STIFFNESS,
        |row: &FloorRow<'a, UnloadStep>| row.step.tangent_stiffness[row.floor],
    )];
    joined([step, positions(), forces(), tangents])
}

/// The table of an unloading; step 0 is its start.
pub(crate) fn unloading(steps: &[UnloadStep]) -> Vec<Column> {
    written(&unloaded(), &rows_of(steps))
}

fn joined<T, const N: usize>(parts: [Vec<TableColumn<T>>; N]) -> Vec<TableColumn<T>> {
    parts.into_iter().flatten().collect()
}
