//! The table of an impact, one row per step; for a frame, one row per step and storey. In: a history. Out: a table.

use std::ops::Range;

use crate::procedures::base_excitation;
use crate::record::{ImpactHistory, ImpactStep, StruckFrame};
use crate::report::tables::{Column, Table, integers, numbers, texts};
use crate::schema;
use crate::schema::columns::{self, column};
use crate::units::Dimension;

/// The numeric columns of its table.
pub(crate) const COLUMNS: &[schema::Column] = &[
    columns::STEP,
    columns::TIME,
    columns::WALL_TIME,
    columns::COMMAND,
    columns::DISPLACEMENT,
    columns::VELOCITY,
    column("acceleration_m_per_s2", Dimension::ACCELERATION),
    columns::RESTORING_FORCE,
    column("contact_force_n", Dimension::FORCE),
    column("striker_displacement_m", Dimension::LENGTH),
    column("striker_velocity_m_per_s", Dimension::VELOCITY),
    columns::TANGENT_STIFFNESS,
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

/// Further numeric columns of an impact on a storey: one row per step and storey.
pub(crate) const STOREY_COLUMNS: &[schema::Column] = &[
    column("storey", Dimension::NUMBER),
    column("drift_m", Dimension::LENGTH),
    column("storey_shear_n", Dimension::FORCE),
    column("storey_energy_j", Dimension::ENERGY),
];

/// The table under this name.
pub(crate) fn table(name: String, history: &ImpactHistory) -> Table<'_> {
    let Some(StruckFrame { floors, .. }) = &history.frame else {
        return Table::of(name, &history.steps, impact);
    };
    let storeys = floors.first().map_or(1, |floors| floors.computed.len());
    let columns = |range: Range<usize>| {
        base_excitation::tables::storey_impact(&history.steps[range.clone()], &floors[range])
    };
    Table::of_steps(name, floors.len(), storeys, columns)
}

fn impact(steps: &[ImpactStep]) -> Vec<Column> {
    let of = |name, read: fn(&ImpactStep) -> f64| numbers(name, steps, read);
    vec![
        integers("step", steps, |step| step.step),
        of("time_s", |step| step.time),
        of("wall_time_s", |step| step.wall_time),
        texts("state", steps, |step| step.state.name()),
        of("command_m", |step| step.command),
        of("computed_m", |step| step.computed),
        of("displacement_m", |step| step.displacement),
        of("velocity_m_per_s", |step| step.velocity),
        of("acceleration_m_per_s2", |step| step.acceleration),
        of("restoring_force_n", |step| step.restoring_force),
        of("contact_force_n", |step| step.contact_force),
        of("striker_displacement_m", |step| step.striker_displacement),
        of("striker_velocity_m_per_s", |step| step.striker_velocity),
        of("tangent_stiffness_n_per_m", |step| step.tangent_stiffness),
        of("indentation_m", |step| step.indentation),
        of("striker_energy_j", |step| step.energies.striker),
        of("structure_energy_j", |step| step.energies.structure),
        of("restoring_energy_j", |step| step.energies.restoring),
        of("damping_energy_j", |step| step.energies.damping),
        of("contact_loss_j", |step| step.energies.contact_loss),
        of("indentation_energy_j", |step| step.energies.indentation),
        of("weight_work_j", |step| step.energies.weight),
        of("energy_error_j", |step| step.energies.error),
        of("tracking_energy_error_j", |step| step.tracking.energy_error),
        of("tracking_indicator_m2", |step| step.tracking.indicator),
    ]
}
