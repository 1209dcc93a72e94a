//! Columns of tables, with those that several procedures have: names for CSV and Parquet, for `golden` and for
//! comparisons. Columns of text are not here: they are compared literally.

use crate::units::Dimension;

/// A column of a table, in SI units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    pub name: &'static str,
    pub dimension: Dimension,
}

pub(crate) const fn column(name: &'static str, dimension: Dimension) -> Column {
    Column { name, dimension }
}

pub(crate) const STEP: Column = column("step", Dimension::NUMBER);
pub(crate) const TIME: Column = column("time_s", Dimension::TIME);
pub(crate) const WALL_TIME: Column = column("wall_time_s", Dimension::TIME);
pub(crate) const COMMAND: Column = column("command_m", Dimension::LENGTH);
pub(crate) const DISPLACEMENT: Column = column("displacement_m", Dimension::LENGTH);
pub(crate) const VELOCITY: Column = column("velocity_m_per_s", Dimension::VELOCITY);
pub(crate) const RESTORING_FORCE: Column = column("restoring_force_n", Dimension::FORCE);
pub(crate) const TANGENT_STIFFNESS: Column =
    column("tangent_stiffness_n_per_m", Dimension::STIFFNESS);
