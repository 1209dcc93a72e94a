//! The table of an impact, one row per step; for a frame, one row per step and storey. In: a history. Out: a table.

use std::ops::Range;

use crate::procedures::frame;
use crate::procedures::frame::tables::{
    FloorRow, computed, forces, joined, positions, rows, spring_shear, storey, tracking,
    written_rows,
};
use crate::report::tables::TableColumn::{self, Integer, Number, Text};
use crate::report::tables::{Column as WrittenColumn, Table, numeric, written_one_by_one};
use psd_physics::structure::assemblies::Assemblies;
use psd_plan::record::{FloorStep, ImpactHistory, ImpactStep, StruckFrame};
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

/// An impact on a storey: the step of the striker, and that of the floors.
struct StruckStep<'a> {
    impact: ImpactStep,
    floors: &'a FloorStep,
}

/// The columns of an impact on a storey: the striker, and the floors.
fn struck<'a>() -> Vec<TableColumn<FloorRow<'a, StruckStep<'a>>>> {
    let step = vec![
        Integer(columns::STEP, |row: &FloorRow<'a, StruckStep<'a>>| {
            row.step.impact.step
        }),
        storey(),
        Number(columns::TIME, |row| row.step.impact.time),
        Number(columns::WALL_TIME, |row| row.step.impact.wall_time),
        Text(columns::STATE, |row| row.step.impact.state.name()),
    ];
    let striker = vec![
        Number(
            columns::STOREY_ENERGY,
            |row: &FloorRow<'a, StruckStep<'a>>| row.step.floors.storey_energy[row.floor],
        ),
        Number(columns::CONTACT_FORCE, |row| row.step.impact.contact_force),
        Number(columns::STRIKER_DISPLACEMENT, |row| {
            row.step.impact.striker_displacement
        }),
        Number(columns::STRIKER_VELOCITY, |row| {
            row.step.impact.striker_velocity
        }),
        Number(columns::INDENTATION, |row| row.step.impact.indentation),
        Number(columns::STRIKER_ENERGY, |row| {
            row.step.impact.energies.striker
        }),
        Number(columns::STRUCTURE_ENERGY, |row| {
            row.step.impact.energies.structure
        }),
        Number(columns::RESTORING_ENERGY, |row| {
            row.step.impact.energies.restoring
        }),
        Number(columns::DAMPING_ENERGY, |row| {
            row.step.impact.energies.damping
        }),
        Number(columns::CONTACT_LOSS, |row| {
            row.step.impact.energies.contact_loss
        }),
        Number(columns::INDENTATION_ENERGY, |row| {
            row.step.impact.energies.indentation
        }),
        Number(columns::WEIGHT_WORK, |row| row.step.impact.energies.weight),
        Number(columns::GRAVITY_ENERGY, |row| {
            row.step.impact.energies.gravity
        }),
        Number(columns::ENERGY_ERROR, |row| row.step.impact.energies.error),
    ];
    joined([
        step,
        positions(),
        computed(),
        forces(),
        vec![spring_shear()],
        striker,
        tracking(),
    ])
}

/// The table of an impact on a storey.
fn storey_impact(
    steps: impl Iterator<Item = ImpactStep>,
    floors: &[FloorStep],
    scaled: Option<&Assemblies>,
) -> Vec<WrittenColumn> {
    let steps: Vec<StruckStep<'_>> = floors
        .iter()
        .zip(steps)
        .map(|(floors, impact)| StruckStep { impact, floors })
        .collect();
    let rows = rows(steps.iter().map(|step| (step.floors, step)), scaled);
    written_rows(struck(), &rows, scaled)
}

/// The numeric columns of all tables.
pub(crate) fn columns() -> Vec<Column> {
    let of_floors = frame::tables::columns(struck());
    let of_elements = numeric(&frame::tables::elements());
    [numeric(STEPS), of_floors, of_elements].concat()
}

/// The table of the elements of a frame of matrices; None without elements.
pub(crate) fn of_elements<'a>(
    name: &str,
    history: &'a ImpactHistory,
    assemblies: Option<Assemblies>,
) -> Option<Table<'a>> {
    let floors = &history.frame.as_ref()?.floors;
    let number = |step: usize| history.steps.get(step).map_or(0, |step| step.step);
    frame::tables::of_elements(name, floors, number, assemblies)
}

/// The table under this name.
pub(crate) fn table(
    name: String,
    history: &ImpactHistory,
    scaled: Option<Assemblies>,
) -> Table<'_> {
    let Some(StruckFrame { floors, .. }) = &history.frame else {
        return Table::of_steps(name, history.steps.len(), 1, |range| {
            written_one_by_one(STEPS, history.steps.range(range))
        });
    };
    let storeys = floors
        .first()
        .map_or(1, |floors| floors.floors.computed.len());
    let columns = move |range: Range<usize>| {
        let steps = history.steps.range(range.clone());
        storey_impact(steps, &floors[range], scaled.as_ref())
    };
    Table::of_steps(name, floors.len(), storeys, columns)
}
