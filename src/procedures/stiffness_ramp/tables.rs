//! The tables of a stiffness ramp: a row a step, and a row a reading of its watched pauses. In: a history. Out: tables.

use std::iter::once;

use crate::report::tables::TableColumn::{self, Flag, Integer, Number, Optional};
use crate::report::tables::{Table, numeric, written};
use psd_plan::record::{Hold, RampStep, StiffnessRampHistory};
use psd_plan::schema::{Column, columns};

/// The columns of the steps.
const STEPS: &[TableColumn<RampStep>] = &[
    Integer(columns::STEP, |step| step.step),
    Number(columns::WALL_TIME, |step| step.wall_time),
    Number(columns::COMMAND, |step| step.command),
    Number(columns::DISPLACEMENT, |step| step.displacement),
    Number(columns::RESTORING_FORCE, |step| step.restoring_force),
    Number(columns::FORCE_SCATTER, |step| step.force_scatter),
    Number(columns::RELAXATION, |step| step.relaxation),
    Optional(columns::TANGENT_STIFFNESS, |step| step.tangent_stiffness),
    Flag("returning", |step| Some(step.returning)),
];

/// A reading of a hold.
pub(crate) struct HoldReading {
    step: u64,
    /// \[s\]
    time: f64,
    /// \[N\]
    force: f64,
}

/// The columns of the readings of the holds.
pub(crate) const HOLDS: &[TableColumn<HoldReading>] = &[
    Integer(columns::STEP, |reading| reading.step),
    Number(columns::TIME, |reading| reading.time),
    Number(columns::RESTORING_FORCE, |reading| reading.force),
];

/// The numeric columns of all its tables.
pub(crate) fn columns() -> Vec<Column> {
    [numeric(STEPS), numeric(HOLDS)].concat()
}

/// Under this name and names that begin with it.
pub(crate) fn tables(name: String, history: &StiffnessRampHistory) -> Vec<Table<'_>> {
    let holds = (!history.holds.is_empty()).then(|| {
        Table::of(format!("{name}_holds"), &history.holds, |holds| {
            written(HOLDS, &readings(holds))
        })
    });
    let mut rows: Vec<RampStep> = history
        .steps
        .iter()
        .chain(&history.before)
        .copied()
        .collect();
    rows.sort_by_key(|row| row.step);
    once(Table::of_steps(name, rows.len(), 1, move |range| {
        written(STEPS, &rows[range])
    }))
    .chain(holds)
    .collect()
}

/// The readings of these holds after each other.
fn readings(holds: &[Hold]) -> Vec<HoldReading> {
    let of_hold = |hold: &Hold| {
        let step = hold.step;
        let reading = move |(time, force): &(f64, f64)| HoldReading {
            step,
            time: *time,
            force: *force,
        };
        hold.readings.iter().map(reading).collect::<Vec<_>>()
    };
    holds.iter().flat_map(of_hold).collect()
}
