//! The tables of a stiffness ramp: a row a step, and a row a reading of its watched pauses. In: a history. Out: tables.

use std::iter::once;

use crate::record::{Hold, RampHistory, RampStep};
use crate::report::tables::{Column, Table, integers, numbers};
use crate::schema;
use crate::schema::columns::{self, column};
use crate::units::Dimension;

/// The numeric columns of its tables, and of a `move`.
pub(crate) const COLUMNS: &[schema::Column] = &[
    columns::STEP,
    columns::WALL_TIME,
    columns::COMMAND,
    columns::DISPLACEMENT,
    columns::RESTORING_FORCE,
    column("force_scatter_n", Dimension::FORCE),
    column("relaxation_n", Dimension::FORCE),
    columns::TANGENT_STIFFNESS,
    columns::TIME,
];

/// Under this name and names that begin with it.
pub(crate) fn tables(name: String, history: &RampHistory) -> Vec<Table<'_>> {
    let holds = (!history.holds.is_empty())
        .then(|| Table::of(format!("{name}_holds"), &history.holds, holds));
    let mut rows: Vec<RampStep> = history
        .steps
        .iter()
        .chain(&history.before)
        .copied()
        .collect();
    rows.sort_by_key(|row| row.step);
    once(Table::of_steps(name, rows.len(), 1, move |range| {
        steps(&rows[range])
    }))
    .chain(holds)
    .collect()
}

/// The columns of these steps.
pub(crate) fn steps(steps: &[RampStep]) -> Vec<Column> {
    let of = |name, read: fn(&RampStep) -> f64| numbers(name, steps, read);
    let tangents: Vec<Option<f64>> = steps.iter().map(|step| step.tangent_stiffness).collect();
    let returning: Vec<bool> = steps.iter().map(|step| step.returning).collect();
    vec![
        integers("step", steps, |step| step.step),
        of("wall_time_s", |step| step.wall_time),
        of("command_m", |step| step.command),
        of("displacement_m", |step| step.displacement),
        of("restoring_force_n", |step| step.restoring_force),
        of("force_scatter_n", |step| step.force_scatter),
        of("relaxation_n", |step| step.relaxation),
        Column::new("tangent_stiffness_n_per_m".into(), tangents),
        Column::new("returning".into(), returning),
    ]
}

/// One row a reading of a hold.
fn holds(holds: &[Hold]) -> Vec<Column> {
    let rows: Vec<(u64, f64, f64)> = holds
        .iter()
        .flat_map(|hold| {
            hold.readings
                .iter()
                .map(|(time, force)| (hold.step, *time, *force))
        })
        .collect();
    vec![
        integers("step", &rows, |row| row.0),
        numbers("time_s", &rows, |row| row.1),
        numbers("restoring_force_n", &rows, |row| row.2),
    ]
}
