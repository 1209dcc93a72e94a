//! The table of an unloading: a row a move of one degree of freedom, or a row a floor or an element of a frame. In: steps. Out: columns.

use crate::procedures::frame;
use crate::procedures::frame::tables::{
    FloorRow, forces, joined, positions, storey, written_steps,
};
use crate::report::tables::TableColumn::{self, Integer, Number, Optional};
use crate::report::tables::{Column as WrittenColumn, Table, numeric, written};
use psd_physics::structure::assemblies::Assemblies;
use psd_plan::record::{UnloadHistory, UnloadStep, Unloaded};
use psd_plan::schema::{Column, columns};

/// The columns of the moves of one degree of freedom.
const MOVES: &[TableColumn<UnloadStep>] = &[
    Integer(columns::STEP, |step| step.step),
    Number(columns::WALL_TIME, |step| step.wall_time),
    Number(columns::COMMAND, |step| step.command[0]),
    Number(columns::DISPLACEMENT, |step| step.displacement[0]),
    Number(columns::RESTORING_FORCE, |step| step.restoring_force[0]),
    Optional(columns::TANGENT_STIFFNESS, |step| step.tangent_stiffness[0]),
];

/// The columns of the floors of a frame.
fn unloaded<'a>() -> Vec<TableColumn<FloorRow<'a, UnloadStep>>> {
    let step = vec![
        Integer(columns::STEP, |row: &FloorRow<'a, UnloadStep>| {
            row.step.step
        }),
        storey(),
        Number(columns::WALL_TIME, |row| row.step.wall_time),
    ];
    let tangents = vec![Optional(
        columns::TANGENT_STIFFNESS,
        |row: &FloorRow<'a, UnloadStep>| row.step.tangent_stiffness[row.floor],
    )];
    joined([step, positions(), forces(), tangents])
}

/// The table of the floors of a frame; step 0 is the start of the unloading.
pub(crate) fn unloading(steps: &[UnloadStep], scaled: Option<&Assemblies>) -> Vec<WrittenColumn> {
    written_steps(unloaded(), steps, scaled)
}

/// An element of a frame of matrices after a move.
struct ElementRow<'a> {
    step: &'a UnloadStep,
    element: usize,
    /// Command and measured displacement \[m\], and force \[N\] of its axis.
    on_the_rig: Option<[f64; 3]>,
}

impl frame::tables::OnTheRig for ElementRow<'_> {
    fn on_the_rig(&self) -> Option<[f64; 3]> {
        self.on_the_rig
    }
}

/// The columns of the elements; those of the rig only if a specimen has a scale.
fn elements<'a>(is_scaled: bool) -> Vec<TableColumn<ElementRow<'a>>> {
    let mut columns = vec![
        Integer(columns::STEP, |row: &ElementRow<'a>| row.step.step),
        Integer(columns::ELEMENT, |row| row.element as u64 + 1),
        Number(columns::WALL_TIME, |row| row.step.wall_time),
        Number(columns::COMMAND, |row| row.step.command[row.element]),
        Number(columns::DEFORMATION, |row| {
            row.step.displacement[row.element]
        }),
        Number(columns::RESTORING_FORCE, |row| {
            row.step.restoring_force[row.element]
        }),
        Optional(columns::TANGENT_STIFFNESS, |row| {
            row.step.tangent_stiffness[row.element]
        }),
    ];
    if is_scaled {
        columns.extend(frame::tables::on_the_rig());
    }
    columns
}

/// The numeric columns of all tables.
pub(crate) fn columns() -> Vec<Column> {
    let of_floors = frame::tables::columns(unloaded());
    [numeric(MOVES), of_floors, numeric(&elements(true))].concat()
}

/// The table of an unloading, under this name.
pub(crate) fn table(
    name: String,
    history: &UnloadHistory,
    scaled: Option<Assemblies>,
) -> Table<'_> {
    let of = history.of;
    Table::of(name, &history.steps, move |steps| match of {
        Unloaded::OneAxis => written(MOVES, steps),
        Unloaded::Floors => unloading(steps, scaled.as_ref()),
        Unloaded::Elements => elements_written(steps, scaled.as_ref()),
    })
}

/// The table of the elements of a frame of matrices; step 0 is the start of the unloading.
pub(crate) fn elements_written(
    steps: &[UnloadStep],
    scaled: Option<&Assemblies>,
) -> Vec<WrittenColumn> {
    let rows = steps.iter().flat_map(|step| {
        let on_the_rig = match scaled {
            Some(assemblies) => {
                let read = [&*step.displacement, &*step.restoring_force];
                assemblies.of_members(
                    assemblies.axes_of_elements(step.command.clone()),
                    assemblies.axes_read(read, &step.elements()),
                )
            }
            None => vec![None; step.command.len()],
        };
        let row = move |(element, on_the_rig)| ElementRow {
            step,
            element,
            on_the_rig,
        };
        on_the_rig.into_iter().enumerate().map(row)
    });
    written(&elements(scaled.is_some()), &rows.collect::<Vec<_>>())
}
