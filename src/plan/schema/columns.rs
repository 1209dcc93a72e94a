//! Columns of tables, with those that several procedures have: names for CSV and Parquet, for `golden` and for
//! comparisons. Of columns of text, which are compared literally, only the name is here.

use psd_text::units::Dimension;

/// A column of a table, in SI units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    pub name: &'static str,
    pub dimension: Dimension,
}

pub const fn column(name: &'static str, dimension: Dimension) -> Column {
    Column { name, dimension }
}

pub const STEP: Column = column("step", Dimension::NUMBER);
pub const TIME: Column = column("time_s", Dimension::TIME);
pub const WALL_TIME: Column = column("wall_time_s", Dimension::TIME);
pub const COMMAND: Column = column("command_m", Dimension::LENGTH);
pub const DISPLACEMENT: Column = column("displacement_m", Dimension::LENGTH);
pub const VELOCITY: Column = column("velocity_m_per_s", Dimension::VELOCITY);
pub const RESTORING_FORCE: Column = column("restoring_force_n", Dimension::FORCE);
pub const TANGENT_STIFFNESS: Column = column("tangent_stiffness_n_per_m", Dimension::STIFFNESS);
pub const STOREY: Column = column("storey", Dimension::NUMBER);
pub const ELEMENT: Column = column("element", Dimension::NUMBER);
pub const COMPUTED: Column = column("computed_m", Dimension::LENGTH);
pub const ACCELERATION: Column = column("acceleration_m_per_s2", Dimension::ACCELERATION);
pub const DRIFT: Column = column("drift_m", Dimension::LENGTH);
pub const STOREY_SHEAR: Column = column("storey_shear_n", Dimension::FORCE);
pub const SPRING_SHEAR: Column = column("spring_shear_n", Dimension::FORCE);
/// Of the axis at the storey, in numbers of the rig. They are there if the scale of a storey is not 1.
pub const COMMAND_ON_THE_RIG: Column = column("command_rig_m", Dimension::LENGTH);
pub const DISPLACEMENT_ON_THE_RIG: Column = column("displacement_rig_m", Dimension::LENGTH);
pub const FORCE_ON_THE_RIG: Column = column("force_rig_n", Dimension::FORCE);
/// Of an element of a frame of matrices: measured displacement of its second end relative to the first.
pub const DEFORMATION: Column = column("deformation_m", Dimension::LENGTH);
/// Of an axial axis.
pub const AXIAL_TARGET: Column = column("axial_target_n", Dimension::FORCE);
pub const AXIAL_FORCE: Column = column("axial_force_n", Dimension::FORCE);
pub const AXIAL_DISPLACEMENT: Column = column("axial_displacement_m", Dimension::LENGTH);
pub const STOREY_ENERGY: Column = column("storey_energy_j", Dimension::ENERGY);
pub const ENERGY: Column = column("energy_j", Dimension::ENERGY);
pub const RESTORING_ENERGY: Column = column("restoring_energy_j", Dimension::ENERGY);
pub const DAMPING_ENERGY: Column = column("damping_energy_j", Dimension::ENERGY);
pub const ENERGY_ERROR: Column = column("energy_error_j", Dimension::ENERGY);
pub const TRACKING_ENERGY_ERROR: Column = column("tracking_energy_error_j", Dimension::ENERGY);
pub const TRACKING_INDICATOR: Column = column("tracking_indicator_m2", Dimension::AREA);
pub const INDENTATION: Column = column("indentation_m", Dimension::LENGTH);
pub const FORCE_SCATTER: Column = column("force_scatter_n", Dimension::FORCE);
pub const RELAXATION: Column = column("relaxation_n", Dimension::FORCE);

/// The state of the contact, a text.
pub const STATE: &str = "state";
pub const CONTACT_FORCE: Column = column("contact_force_n", Dimension::FORCE);
pub const STRIKER_DISPLACEMENT: Column = column("striker_displacement_m", Dimension::LENGTH);
pub const STRIKER_VELOCITY: Column = column("striker_velocity_m_per_s", Dimension::VELOCITY);
pub const STRIKER_ENERGY: Column = column("striker_energy_j", Dimension::ENERGY);
pub const STRUCTURE_ENERGY: Column = column("structure_energy_j", Dimension::ENERGY);
pub const CONTACT_LOSS: Column = column("contact_loss_j", Dimension::ENERGY);
pub const INDENTATION_ENERGY: Column = column("indentation_energy_j", Dimension::ENERGY);
pub const GRAVITY_ENERGY: Column = column("gravity_energy_j", Dimension::ENERGY);
pub const WEIGHT_WORK: Column = column("weight_work_j", Dimension::ENERGY);
