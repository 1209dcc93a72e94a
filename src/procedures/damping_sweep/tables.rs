//! The table of a damping sweep, a row a reading. In: its steps. Out: columns.

use crate::record::{DampingSweepHistory, SweepStep};
use crate::report::tables::TableColumn::{self, Flag, Integer, Number};
use crate::report::tables::{Table, written};
use crate::schema::columns::{self, column};
use crate::units::Dimension;

pub(crate) const STEPS: &[TableColumn<SweepStep>] = &[
    Integer(columns::STEP, |step| step.step),
    Number(columns::WALL_TIME, |step| step.wall_time),
    Number(columns::VELOCITY, |step| step.velocity),
    Number(columns::DISPLACEMENT, |step| step.displacement),
    Number(columns::RESTORING_FORCE, |step| step.restoring_force),
    Number(column("damping_force_n", Dimension::FORCE), |step| {
        step.damping_force
    }),
    Flag("steady", |step| Some(step.steady)),
];

/// The table under this name.
pub(crate) fn table(name: String, history: &DampingSweepHistory) -> Table<'_> {
    Table::of(name, &history.steps, |steps| written(STEPS, steps))
}
