//! The table of an unloading: a row a move of one degree of freedom, or a row a floor of a frame. In: steps. Out: columns.

use crate::procedures::shake;
use crate::report::tables::TableColumn::{self, Integer, Number, Optional};
use crate::report::tables::{Table, numeric, written};
use psd_physics::structure::substructures::Assemblies;
use psd_plan::record::UnloadStep;
use psd_plan::schema::{Column, columns};

/// The columns of the moves of one degree of freedom.
const MOVES: &[TableColumn<UnloadStep>] = &[
    Integer(columns::STEP, |step| step.step),
    Number(columns::WALL_TIME, |step| step.wall_time),
    Number(columns::COMMAND, |step| step.command[0]),
    Number(columns::DISPLACEMENT, |step| step.displacement[0]),
    Number(columns::RESTORING_FORCE, |step| step.restoring_force[0]),
    Optional(columns::TANGENT_STIFFNESS, |step| step.tangent_stiffness[0]),
];

/// The numeric columns of both tables.
pub(crate) fn columns() -> Vec<Column> {
    let of_floors = shake::tables::columns(shake::tables::unloaded());
    [numeric(MOVES), of_floors].concat()
}

/// The table of the moves of one degree of freedom, under this name.
pub(crate) fn of_moves(name: String, steps: &[UnloadStep]) -> Table<'_> {
    Table::of(name, steps, |steps| written(MOVES, steps))
}

/// The table of the floors of a frame, under this name.
pub(crate) fn of_floors(
    name: String,
    steps: &[UnloadStep],
    scaled: Option<Assemblies>,
) -> Table<'_> {
    Table::of(name, steps, move |steps| {
        shake::tables::unloading(steps, scaled.as_ref())
    })
}
