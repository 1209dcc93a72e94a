//! The zero readings of a rig as a table, one row per axis and reading. In: the zero drift of a record. Out: columns.

use polars::prelude::Column;

use super::TableColumn::{self, Integer, Number, Text};
use super::written;
use psd_plan::record::{Drift, Zero};
use psd_plan::schema::columns::{self, column};
use psd_text::units::Dimension;

/// One zero reading of one axis.
struct ZeroDriftRow {
    /// Number of the axis from 1.
    axis: u64,
    /// `before` or `after` the test.
    test: &'static str,
    zero: Zero,
}

const COLUMNS: &[TableColumn<ZeroDriftRow>] = &[
    Integer(column("axis", Dimension::NUMBER), |row| row.axis),
    Text("test", |row| row.test),
    Number(columns::WALL_TIME, |row| row.zero.time),
    Number(column("force_n", Dimension::FORCE), |row| row.zero.force),
    Number(columns::DISPLACEMENT, |row| row.zero.displacement),
    Number(
        column("force_slope_n_per_s", Dimension::FORCE_RATE),
        |row| row.zero.force_slope,
    ),
    Number(
        column("displacement_slope_m_per_s", Dimension::VELOCITY),
        |row| row.zero.displacement_slope,
    ),
];

/// The columns of the table.
pub(super) fn table_columns(drift: &Drift) -> Vec<Column> {
    let axes = (1..).zip(&drift.axes);
    let rows: Vec<ZeroDriftRow> = axes
        .flat_map(|(number, axis)| {
            let row = |test, zero| ZeroDriftRow {
                axis: number,
                test,
                zero,
            };
            let after = axis.after.map(|zero| row("after", zero));
            std::iter::once(row("before", axis.before)).chain(after)
        })
        .collect();
    written(COLUMNS, &rows)
}
