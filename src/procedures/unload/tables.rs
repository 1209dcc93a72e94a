//! The table of an unloading: that of the moves of one degree of freedom, or of the floors of a frame. In: steps. Out: columns.

use crate::procedures::{shake, stiffness_ramp};
use crate::record::UnloadStep;
use crate::report::tables::{Table, numeric};
use crate::schema::Column;

/// The numeric columns of both tables.
pub(crate) fn columns() -> Vec<Column> {
    [
        numeric(stiffness_ramp::tables::STEPS),
        numeric(&shake::tables::unloaded()),
    ]
    .concat()
}

/// The table of the floors of a frame, under this name.
pub(crate) fn of_floors(name: String, steps: &[UnloadStep]) -> Table<'_> {
    Table::of(name, steps, shake::tables::unloading)
}
