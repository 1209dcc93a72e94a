//! The table of a move: a row an increment. In: steps. Out: columns.

use crate::report::tables::TableColumn::{self, Integer, Number, Optional};
use crate::report::tables::{Table, numeric, written};
use psd_plan::record::MoveStep;
use psd_plan::schema::{Column, columns};

const STEPS: &[TableColumn<MoveStep>] = &[
    Integer(columns::STEP, |step| step.step),
    Number(columns::WALL_TIME, |step| step.wall_time),
    Number(columns::COMMAND, |step| step.command),
    Number(columns::DISPLACEMENT, |step| step.displacement),
    Number(columns::RESTORING_FORCE, |step| step.restoring_force),
    Optional(columns::TANGENT_STIFFNESS, |step| step.tangent_stiffness),
];

/// The numeric columns of its table.
pub(crate) fn columns() -> Vec<Column> {
    numeric(STEPS)
}

/// The table of its increments, under this name.
pub(crate) fn table(name: String, steps: &[MoveStep]) -> Table<'_> {
    Table::of(name, steps, |steps| written(STEPS, steps))
}
