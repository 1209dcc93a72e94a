//! The zeros of a rig as a table: a row an axis and reading. In: the drift of a record. Out: columns.

use polars::prelude::Column;

use super::{integers, numbers, texts};
use crate::record::{Drift, Zero};

/// A zero of an axis (from 1), and when it was read.
type Row = (u64, &'static str, Zero);

pub(super) fn rows(drift: &Drift) -> Vec<Column> {
    let axes = (1..).zip(&drift.axes);
    let rows: Vec<Row> = axes
        .flat_map(|(number, axis)| {
            let after = axis.after.map(|zero| (number, "after", zero));
            std::iter::once((number, "before", axis.before)).chain(after)
        })
        .collect();
    let of = |name, read: fn(&Row) -> f64| numbers(name, &rows, read);
    vec![
        integers("axis", &rows, |(axis, ..)| *axis),
        texts("test", &rows, |(_, when, _)| when),
        of("wall_time_s", |(.., zero)| zero.time),
        of("force_n", |(.., zero)| zero.force),
        of("displacement_m", |(.., zero)| zero.displacement),
        of("force_slope_n_per_s", |(.., zero)| zero.force_slope),
        of("displacement_slope_m_per_s", |(.., zero)| {
            zero.displacement_slope
        }),
    ]
}
