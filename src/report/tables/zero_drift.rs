//! The zero readings of a rig as a table, one row per axis and reading. In: the zero drift of a record. Out: columns.

use polars::prelude::Column;

use super::{integers, numbers, texts};
use crate::record::{Drift, Zero};

/// One zero reading of one axis.
struct Row {
    /// Number of the axis from 1.
    axis: u64,
    /// `before` or `after` the test.
    test: &'static str,
    zero: Zero,
}

/// The columns of the table.
pub(super) fn columns(drift: &Drift) -> Vec<Column> {
    let axes = (1..).zip(&drift.axes);
    let rows: Vec<Row> = axes
        .flat_map(|(number, axis)| {
            let row = |test, zero| Row {
                axis: number,
                test,
                zero,
            };
            let after = axis.after.map(|zero| row("after", zero));
            std::iter::once(row("before", axis.before)).chain(after)
        })
        .collect();
    let column = |name, read: fn(&Row) -> f64| numbers(name, &rows, read);
    vec![
        integers("axis", &rows, |row| row.axis),
        texts("test", &rows, |row| row.test),
        column("wall_time_s", |row| row.zero.time),
        column("force_n", |row| row.zero.force),
        column("displacement_m", |row| row.zero.displacement),
        column("force_slope_n_per_s", |row| row.zero.force_slope),
        column("displacement_slope_m_per_s", |row| {
            row.zero.displacement_slope
        }),
    ]
}
