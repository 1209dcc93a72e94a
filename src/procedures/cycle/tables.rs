//! Tables of cycles: one row a reading, and one row a whole cycle. In: the history. Out: columns.

use crate::record::{CycleHistory, CycleStep, WholeCycle};
use crate::report::tables::{Column, Table, integers, numbers};
use crate::schema;
use crate::schema::columns::{self, column};
use crate::units::Dimension;

/// The numeric columns of its readings, and of its whole cycles.
pub(crate) const COLUMNS: &[schema::Column] = &[
    columns::STEP,
    columns::WALL_TIME,
    column("cycle", Dimension::NUMBER),
    column("amplitude_m", Dimension::LENGTH),
    columns::COMMAND,
    columns::DISPLACEMENT,
    columns::RESTORING_FORCE,
    column("force_scatter_n", Dimension::FORCE),
    column("relaxation_n", Dimension::FORCE),
    column("restoring_energy_j", Dimension::ENERGY),
    column("repeat", Dimension::NUMBER),
    column("measured_amplitude_m", Dimension::LENGTH),
    column("energy_j", Dimension::ENERGY),
    column("equivalent_damping_ratio", Dimension::NUMBER),
    column("secant_stiffness_n_per_m", Dimension::STIFFNESS),
    column("max_force_n", Dimension::FORCE),
    column("min_force_n", Dimension::FORCE),
];

/// The readings under this name, and the cycles under one that begins with it.
pub(crate) fn tables(name: String, history: &CycleHistory) -> Vec<Table<'_>> {
    let of_cycles = Table::of(format!("{name}_cycles"), &history.cycles, cycles);
    vec![Table::of(name, &history.steps, steps), of_cycles]
}

pub(crate) fn steps(steps: &[CycleStep]) -> Vec<Column> {
    let of = |name, read: fn(&CycleStep) -> f64| numbers(name, steps, read);
    vec![
        integers("step", steps, |step| step.step),
        of("wall_time_s", |step| step.wall_time),
        integers("cycle", steps, |step| step.cycle),
        of("amplitude_m", |step| step.amplitude),
        of("command_m", |step| step.command),
        of("displacement_m", |step| step.displacement),
        of("restoring_force_n", |step| step.restoring_force),
        of("force_scatter_n", |step| step.force_scatter),
        of("relaxation_n", |step| step.relaxation),
        of("restoring_energy_j", |step| step.energy),
    ]
}

/// One row a whole cycle.
pub(crate) fn cycles(cycles: &[WholeCycle]) -> Vec<Column> {
    let of = |name, read: fn(&WholeCycle) -> f64| numbers(name, cycles, read);
    let some = |name: &str, read: fn(&WholeCycle) -> Option<f64>| {
        Column::new(
            name.into(),
            cycles.iter().map(read).collect::<Vec<Option<f64>>>(),
        )
    };
    vec![
        integers("cycle", cycles, |cycle| cycle.cycle),
        integers("repeat", cycles, |cycle| u64::from(cycle.repeat)),
        of("amplitude_m", |cycle| cycle.amplitude),
        of("measured_amplitude_m", |cycle| cycle.found.amplitude),
        of("energy_j", |cycle| cycle.found.energy),
        some("equivalent_damping_ratio", |cycle| {
            cycle.found.damping_ratio
        }),
        some("secant_stiffness_n_per_m", |cycle| cycle.found.stiffness),
        of("max_force_n", |cycle| cycle.found.max_force),
        of("min_force_n", |cycle| cycle.found.min_force),
    ]
}
