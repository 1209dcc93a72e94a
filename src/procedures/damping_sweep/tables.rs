//! The table of a damping sweep, a row a reading. In: its steps. Out: columns.

use crate::report::tables::TableColumn::{self, Flag, Integer, Number};
use crate::report::tables::{Table, written};
use psd_plan::record::{DampingSweepHistory, SweepStep};
use psd_plan::schema::columns::{self, column};
use psd_text::units::Dimension;

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
