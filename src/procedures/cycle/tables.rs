//! Tables of cycles: one row a reading, and one row a whole cycle. In: the history. Out: columns.

use crate::report::tables::TableColumn::{self, Integer, Number, Optional};
use crate::report::tables::{Table, numeric, written};
use psd_plan::record::{CycleHistory, CycleStep, WholeCycle};
use psd_plan::schema::Column;
use psd_plan::schema::columns::{self, column};
use psd_text::units::Dimension;

const CYCLE: Column = column("cycle", Dimension::NUMBER);
const AMPLITUDE: Column = column("amplitude_m", Dimension::LENGTH);

/// The columns of the readings.
pub(crate) const STEPS: &[TableColumn<CycleStep>] = &[
    Integer(columns::STEP, |step| step.step),
    Number(columns::WALL_TIME, |step| step.wall_time),
    Integer(CYCLE, |step| step.cycle),
    Number(AMPLITUDE, |step| step.amplitude),
    Number(columns::COMMAND, |step| step.command),
    Number(columns::DISPLACEMENT, |step| step.displacement),
    Number(columns::RESTORING_FORCE, |step| step.restoring_force),
    Number(columns::FORCE_SCATTER, |step| step.force_scatter),
    Number(columns::RELAXATION, |step| step.relaxation),
    Number(columns::RESTORING_ENERGY, |step| step.energy),
];

/// The columns of the whole cycles.
pub(crate) const CYCLES: &[TableColumn<WholeCycle>] = &[
    Integer(CYCLE, |cycle| cycle.cycle),
    Integer(column("repeat", Dimension::NUMBER), |cycle| {
        u64::from(cycle.repeat)
    }),
    Number(AMPLITUDE, |cycle| cycle.amplitude),
    Number(column("measured_amplitude_m", Dimension::LENGTH), |cycle| {
        cycle.found.amplitude
    }),
    Number(columns::ENERGY, |cycle| cycle.found.energy),
    Optional(
        column("equivalent_damping_ratio", Dimension::NUMBER),
        |cycle| cycle.found.damping_ratio,
    ),
    Optional(
        column("secant_stiffness_n_per_m", Dimension::STIFFNESS),
        |cycle| cycle.found.stiffness,
    ),
    Number(column("max_force_n", Dimension::FORCE), |cycle| {
        cycle.found.max_force
    }),
    Number(column("min_force_n", Dimension::FORCE), |cycle| {
        cycle.found.min_force
    }),
];

/// The numeric columns of all its tables.
pub(crate) fn columns() -> Vec<Column> {
    [numeric(STEPS), numeric(CYCLES)].concat()
}

/// The readings under this name, and the cycles under one that begins with it.
pub(crate) fn tables(name: String, history: &CycleHistory) -> Vec<Table<'_>> {
    let of_cycles = Table::of(format!("{name}_cycles"), &history.cycles, |cycles| {
        written(CYCLES, cycles)
    });
    let of_steps = Table::of(name, &history.steps, |steps| written(STEPS, steps));
    vec![of_steps, of_cycles]
}
