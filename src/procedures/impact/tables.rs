//! The table of an impact, one row per step; for a frame, one row per step and storey. In: a history. Out: a table.

use std::ops::Range;

use crate::procedures::shake;
use crate::report::tables::TableColumn::{self, Integer, Number, Text};
use crate::report::tables::{Table, numeric, written};
use psd_physics::structure::substructures::Assemblies;
use psd_plan::record::{ImpactHistory, ImpactStep, StruckFrame};
use psd_plan::schema::{Column, columns};

/// The columns of an impact on one degree of freedom.
pub(crate) const STEPS: &[TableColumn<ImpactStep>] = &[
    Integer(columns::STEP, |step| step.step),
    Number(columns::TIME, |step| step.time),
    Number(columns::WALL_TIME, |step| step.wall_time),
    Text(columns::STATE, |step| step.state.name()),
    Number(columns::COMMAND, |step| step.command),
    Number(columns::COMPUTED, |step| step.computed),
    Number(columns::DISPLACEMENT, |step| step.displacement),
    Number(columns::VELOCITY, |step| step.velocity),
    Number(columns::ACCELERATION, |step| step.acceleration),
    Number(columns::RESTORING_FORCE, |step| step.restoring_force),
    Number(columns::CONTACT_FORCE, |step| step.contact_force),
    Number(columns::STRIKER_DISPLACEMENT, |step| {
        step.striker_displacement
    }),
    Number(columns::STRIKER_VELOCITY, |step| step.striker_velocity),
    Number(columns::TANGENT_STIFFNESS, |step| step.tangent_stiffness),
    Number(columns::INDENTATION, |step| step.indentation),
    Number(columns::STRIKER_ENERGY, |step| step.energies.striker),
    Number(columns::STRUCTURE_ENERGY, |step| step.energies.structure),
    Number(columns::RESTORING_ENERGY, |step| step.energies.restoring),
    Number(columns::DAMPING_ENERGY, |step| step.energies.damping),
    Number(columns::CONTACT_LOSS, |step| step.energies.contact_loss),
    Number(columns::INDENTATION_ENERGY, |step| {
        step.energies.indentation
    }),
    Number(columns::WEIGHT_WORK, |step| step.energies.weight),
    Number(columns::ENERGY_ERROR, |step| step.energies.error),
    Number(columns::TRACKING_ENERGY_ERROR, |step| {
        step.tracking.energy_error
    }),
    Number(columns::TRACKING_INDICATOR, |step| step.tracking.indicator),
];

/// The numeric columns of all tables.
pub(crate) fn columns() -> Vec<Column> {
    let of_floors = shake::tables::columns(shake::tables::struck());
    let of_elements = numeric(&shake::tables::elements());
    [numeric(STEPS), of_floors, of_elements].concat()
}

/// The table of the elements of a frame of matrices; None without elements.
pub(crate) fn of_elements<'a>(
    name: &str,
    history: &'a ImpactHistory,
    assemblies: Option<Assemblies>,
) -> Option<Table<'a>> {
    let frame = history.frame.as_ref()?;
    let number = |step: usize| history.steps[step].step;
    shake::tables::of_elements(name, &frame.floors, number, assemblies)
}

/// The table under this name.
pub(crate) fn table(
    name: String,
    history: &ImpactHistory,
    scaled: Option<Assemblies>,
) -> Table<'_> {
    let Some(StruckFrame { floors, .. }) = &history.frame else {
        return Table::of(name, &history.steps, |steps| written(STEPS, steps));
    };
    let storeys = floors
        .first()
        .map_or(1, |floors| floors.floors.computed.len());
    let columns = move |range: Range<usize>| {
        let steps = &history.steps[range.clone()];
        shake::tables::storey_impact(steps, &floors[range], scaled.as_ref())
    };
    Table::of_steps(name, floors.len(), storeys, columns)
}
