//! The columns of the tables with numbers, by procedure: the words of CSV and Parquet, of `golden` and of comparisons.
//! Columns of words are not here: they are held to the letter.

use super::types::Kind;
use crate::quantity::Dimension;

/// A column of a table, SI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    pub name: &'static str,
    pub dimension: Dimension,
}

const fn column(name: &'static str, dimension: Dimension) -> Column {
    Column { name, dimension }
}

const STEP: Column = column("step", Dimension::NUMBER);
const TIME: Column = column("time_s", Dimension::TIME);
const WALL_TIME: Column = column("wall_time_s", Dimension::TIME);
const COMMAND: Column = column("command_m", Dimension::LENGTH);
const DISPLACEMENT: Column = column("displacement_m", Dimension::LENGTH);
const VELOCITY: Column = column("velocity_m_per_s", Dimension::VELOCITY);
const RESTORING_FORCE: Column = column("restoring_force_n", Dimension::FORCE);
const TANGENT_STIFFNESS: Column = column("tangent_stiffness_n_per_m", Dimension::STIFFNESS);

const RAMP: &[Column] = &[
    STEP,
    WALL_TIME,
    COMMAND,
    DISPLACEMENT,
    RESTORING_FORCE,
    column("force_scatter_n", Dimension::FORCE),
    column("relaxation_n", Dimension::FORCE),
    TANGENT_STIFFNESS,
    TIME,
];

const SWEEP: &[Column] = &[STEP, WALL_TIME, VELOCITY, DISPLACEMENT, RESTORING_FORCE, column("damping_force_n", Dimension::FORCE)];

const IMPACT: &[Column] = &[
    STEP,
    TIME,
    WALL_TIME,
    COMMAND,
    DISPLACEMENT,
    VELOCITY,
    column("acceleration_m_per_s2", Dimension::ACCELERATION),
    RESTORING_FORCE,
    column("contact_force_n", Dimension::FORCE),
    column("striker_displacement_m", Dimension::LENGTH),
    column("striker_velocity_m_per_s", Dimension::VELOCITY),
    TANGENT_STIFFNESS,
    column("indentation_m", Dimension::LENGTH),
    column("striker_energy_j", Dimension::ENERGY),
    column("structure_energy_j", Dimension::ENERGY),
    column("restoring_energy_j", Dimension::ENERGY),
    column("damping_energy_j", Dimension::ENERGY),
    column("contact_loss_j", Dimension::ENERGY),
    column("indentation_energy_j", Dimension::ENERGY),
    column("energy_error_j", Dimension::ENERGY),
    column("weight_work_j", Dimension::ENERGY),
    column("computed_m", Dimension::LENGTH),
    column("tracking_energy_error_j", Dimension::ENERGY),
    column("tracking_indicator_m2", Dimension::AREA),
];

/// Of its readings, and of its whole cycles.
const CYCLE: &[Column] = &[
    STEP,
    WALL_TIME,
    column("cycle", Dimension::NUMBER),
    column("amplitude_m", Dimension::LENGTH),
    COMMAND,
    DISPLACEMENT,
    RESTORING_FORCE,
    column("force_scatter_n", Dimension::FORCE),
    column("relaxation_n", Dimension::FORCE),
    column("restoring_energy_j", Dimension::ENERGY),
    column("repeat", Dimension::NUMBER),
    column("measured_amplitude_m", Dimension::LENGTH),
    column("energy_j", Dimension::ENERGY),
    column("equivalent_damping_ratio", Dimension::NUMBER),
    column("secant_stiffness_n_per_m", Dimension::STIFFNESS),
    column("max_force_n", Dimension::FORCE),
    column("min_force_n", Dimension::FORCE),
];

/// What an impact on a storey has besides: one row a step and storey.
const STOREY: &[Column] = &[
    column("storey", Dimension::NUMBER),
    column("drift_m", Dimension::LENGTH),
    column("storey_shear_n", Dimension::FORCE),
    column("storey_energy_j", Dimension::ENERGY),
];

/// One row a step and storey; the energies are those of the whole frame.
const SHAKE: &[Column] = &[
    STEP,
    column("storey", Dimension::NUMBER),
    TIME,
    WALL_TIME,
    column("ground_acceleration_m_per_s2", Dimension::ACCELERATION),
    COMMAND,
    DISPLACEMENT,
    column("computed_m", Dimension::LENGTH),
    VELOCITY,
    column("acceleration_m_per_s2", Dimension::ACCELERATION),
    RESTORING_FORCE,
    column("drift_m", Dimension::LENGTH),
    column("storey_shear_n", Dimension::FORCE),
    column("kinetic_energy_j", Dimension::ENERGY),
    column("restoring_energy_j", Dimension::ENERGY),
    column("damping_energy_j", Dimension::ENERGY),
    column("input_energy_j", Dimension::ENERGY),
    column("energy_error_j", Dimension::ENERGY),
    column("tracking_energy_error_j", Dimension::ENERGY),
    column("tracking_indicator_m2", Dimension::AREA),
];

/// Of its blows; each blow has the table of an impact besides.
const ESCALATE: &[Column] = &[
    column("blow", Dimension::NUMBER),
    VELOCITY,
    column("energy_j", Dimension::ENERGY),
    column("max_displacement_m", Dimension::LENGTH),
    column("time_of_max_displacement_s", Dimension::TIME),
    column("stop_time_s", Dimension::TIME),
    column("absorbed_energy_j", Dimension::ENERGY),
    column("impulse_n_s", Dimension::IMPULSE),
    column("max_contact_force_n", Dimension::FORCE),
    column("contacts", Dimension::NUMBER),
    column("indentation_m", Dimension::LENGTH),
    column("energy_error", Dimension::NUMBER),
    column("rest_displacement_m", Dimension::LENGTH),
    column("rest_force_n", Dimension::FORCE),
];

/// What each storey went through in a blow on a frame, and what stayed; each blow has the table of an impact on a storey besides.
const STOREYS: &[Column] = &[
    column("floor_displacement_m", Dimension::LENGTH),
    column("max_drift_m", Dimension::LENGTH),
    column("rest_drift_m", Dimension::LENGTH),
    column("rest_shear_n", Dimension::FORCE),
];

/// The numeric columns of a procedure's tables; none where it has none.
pub fn columns(kind: Kind) -> impl Iterator<Item = &'static Column> {
    let tables: &[&[Column]] = match kind {
        Kind::StiffnessRamp | Kind::Move => &[RAMP],
        Kind::Unload => &[RAMP, STOREY],
        Kind::DampingSweep => &[SWEEP],
        Kind::Impact => &[IMPACT, STOREY],
        Kind::Cycle => &[CYCLE],
        Kind::Shake => &[SHAKE],
        Kind::Escalate => &[ESCALATE, IMPACT, STOREY, STOREYS],
        _ => &[],
    };
    tables.iter().copied().flatten()
}
