//! The table of a ground-motion test, one row per step and storey, with its record. In: a history. Out: a table.

use crate::procedures::frame::tables::{
    FloorRow, computed, forces, joined, positions, spring_shear, storey, tracking, written_steps,
};
use crate::report::tables::Table;
use crate::report::tables::TableColumn::{self, Integer, Number};
use psd_physics::structure::assemblies::Assemblies;
use psd_plan::record::{ShakeHistory, ShakeStep};
use psd_plan::schema::columns::{self, column};
use psd_text::units::Dimension;

/// The table of a ground-motion test under this name.
pub(crate) fn table(name: String, history: &ShakeHistory, scaled: Option<Assemblies>) -> Table<'_> {
    let storeys = history
        .steps
        .first()
        .map_or(1, |step| step.floors.computed.len());
    Table::of_steps(name, history.steps.len(), storeys, move |range| {
        written_steps(shake(), &history.steps[range], scaled.as_ref())
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
