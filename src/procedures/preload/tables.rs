//! The table of the axial axes during a procedure: a row for each reading of an axis. In: readings. Out: columns.

use crate::report::tables::TableColumn::{self, Integer, Number};
use crate::report::tables::{Table, numeric, written};
use psd_plan::record::AxialReading;
use psd_plan::schema::{Column, columns};

const READINGS: &[TableColumn<AxialReading>] = &[
    Integer(columns::STOREY, |reading| reading.storey),
    Number(columns::WALL_TIME, |reading| reading.wall_time),
    Number(columns::AXIAL_TARGET, |reading| reading.target),
    Number(columns::AXIAL_FORCE, |reading| reading.force),
    Number(columns::AXIAL_DISPLACEMENT, |reading| reading.displacement),
];

/// Its numeric columns.
pub(crate) fn columns() -> Vec<Column> {
    numeric(READINGS)
}

/// The table beside those of this procedure; None if the rig has no axial axis.
pub(crate) fn table<'a>(procedure: &str, readings: &'a [AxialReading]) -> Option<Table<'a>> {
    let name = format!("{procedure}_axial");
    (!readings.is_empty())
        .then(|| Table::of(name, readings, |readings| written(READINGS, readings)))
}
