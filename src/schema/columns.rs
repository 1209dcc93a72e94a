//! Columns of tables, with those that several procedures have: names for CSV and Parquet, for `golden` and for
//! comparisons. Of columns of text, which are compared literally, only the name is here.

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
pub(crate) const STOREY: Column = column("storey", Dimension::NUMBER);
pub(crate) const COMPUTED: Column = column("computed_m", Dimension::LENGTH);
pub(crate) const ACCELERATION: Column = column("acceleration_m_per_s2", Dimension::ACCELERATION);
pub(crate) const DRIFT: Column = column("drift_m", Dimension::LENGTH);
pub(crate) const STOREY_SHEAR: Column = column("storey_shear_n", Dimension::FORCE);
pub(crate) const STOREY_ENERGY: Column = column("storey_energy_j", Dimension::ENERGY);
pub(crate) const ENERGY: Column = column("energy_j", Dimension::ENERGY);
pub(crate) const RESTORING_ENERGY: Column = column("restoring_energy_j", Dimension::ENERGY);
pub(crate) const DAMPING_ENERGY: Column = column("damping_energy_j", Dimension::ENERGY);
pub(crate) const ENERGY_ERROR: Column = column("energy_error_j", Dimension::ENERGY);
pub(crate) const TRACKING_ENERGY_ERROR: Column =
    column("tracking_energy_error_j", Dimension::ENERGY);
pub(crate) const TRACKING_INDICATOR: Column = column("tracking_indicator_m2", Dimension::AREA);
pub(crate) const INDENTATION: Column = column("indentation_m", Dimension::LENGTH);
pub(crate) const FORCE_SCATTER: Column = column("force_scatter_n", Dimension::FORCE);
pub(crate) const RELAXATION: Column = column("relaxation_n", Dimension::FORCE);

/// The state of the contact, a text.
pub(crate) const STATE: &str = "state";
pub(crate) const CONTACT_FORCE: Column = column("contact_force_n", Dimension::FORCE);
pub(crate) const STRIKER_DISPLACEMENT: Column = column("striker_displacement_m", Dimension::LENGTH);
pub(crate) const STRIKER_VELOCITY: Column = column("striker_velocity_m_per_s", Dimension::VELOCITY);
pub(crate) const STRIKER_ENERGY: Column = column("striker_energy_j", Dimension::ENERGY);
pub(crate) const STRUCTURE_ENERGY: Column = column("structure_energy_j", Dimension::ENERGY);
pub(crate) const CONTACT_LOSS: Column = column("contact_loss_j", Dimension::ENERGY);
pub(crate) const INDENTATION_ENERGY: Column = column("indentation_energy_j", Dimension::ENERGY);
pub(crate) const WEIGHT_WORK: Column = column("weight_work_j", Dimension::ENERGY);
