//! An unloaded frame as a report states it: its storeys or elements before and after. In: a plan and a record. Out: blocks.

use crate::procedures::frame::report::{frame_of, has_tangents, known_entry};
use crate::report::document::{Block, Column, Table, Text};
use crate::report::number::percent;
use crate::report::{Run, number};
use psd_plan::procedures::unload::block as schema;
use psd_plan::record::{Floors, ProcedureRecord, UnloadHistory, UnloadStep, Unloaded};
use psd_plan::schema::ResultKind;
use psd_plan::{Element, Part, Unload};
use psd_text::units::Dimension;

/// The blocks below the results; none for one degree of freedom.
pub(crate) fn report(
    run: &Run<'_>,
    unload: &Unload,
    procedure: &ProcedureRecord,
    history: &UnloadHistory,
    body: &mut Vec<Block>,
) {
    match history.of {
        Unloaded::OneAxis => {}
        Unloaded::Floors => floors(run, unload, procedure, &history.steps, body),
        Unloaded::Elements => elements(run, procedure, &history.steps, body),
    }
}

/// The storeys at zero restoring force, with their permanent drifts.
fn floors(
    run: &Run<'_>,
    unload: &Unload,
    procedure: &ProcedureRecord,
    steps: &[UnloadStep],
    body: &mut Vec<Block>,
) {
    let (Some(first), Some(last)) = (steps.first(), steps.last()) else {
        return;
    };
    let frame = frame_of(run, unload.specimen);
    let moves = steps.len() - 1;
    let by = if frame.is_some_and(|frame| !has_tangents(frame)) {
        "each with the initial stiffness matrix"
    } else {
        "each with the storey stiffnesses last measured"
    };
    body.push(Block::paragraph(format!(
        "All floors moved together to zero restoring force, in {moves} {}, {by}.",
        if moves == 1 { "move" } else { "moves" }
    )));
    let whole = |values: &[f64]| {
        values
            .iter()
            .fold(0.0, |largest: f64, value| largest.max(value.abs()))
    };
    let (before, drift) = (first.drift(), last.drift());
    let (loaded, left) = (first.shear(), last.shear());
    let travel = whole(&before).max(whole(&drift));
    let columns = vec![
        Column::words("Storey", 1),
        Column::numbers("Unloaded floor position"),
        Column::numbers("Drift before"),
        Column::numbers("Residual drift"),
        Column::numbers("Over height"),
        Column::numbers("Shear before"),
        Column::numbers("Remaining shear"),
    ];
    let height = |storey: usize| {
        frame
            .and_then(|frame| frame.storeys.get(storey))
            .and_then(|storey| storey.height)
    };
    let row = |storey: usize| -> Vec<Text> {
        let length = |value, beside| number::part_of(value, beside, 4, Dimension::LENGTH);
        let force = |value| number::part_of(value, whole(&loaded), 4, Dimension::FORCE);
        let known = |kind: ResultKind, other: String| {
            known_entry(procedure, kind, storey).unwrap_or_else(|| other.into())
        };
        vec![
            (storey + 1).to_string().into(),
            known(
                schema::FLOOR_DISPLACEMENT,
                length(
                    last.displacement[storey],
                    whole(&last.displacement).max(travel),
                ),
            ),
            length(before[storey], travel).into(),
            known(schema::RESIDUAL_DRIFT, length(drift[storey], travel)),
            height(storey)
                .map_or_else(|| "—".to_owned(), |height| percent(drift[storey] / height))
                .into(),
            force(loaded[storey]).into(),
            known(schema::RESIDUAL_SHEAR, force(left[storey])),
        ]
    };
    body.push(Block::Table(Table {
        columns,
        rows: (0..drift.len()).map(row).collect(),
    }));
}

/// The elements of a frame of matrices at zero force, with their permanent deformations.
fn elements(
    run: &Run<'_>,
    procedure: &ProcedureRecord,
    steps: &[UnloadStep],
    body: &mut Vec<Block>,
) {
    let (Some(first), Some(last)) = (steps.first(), steps.last()) else {
        return;
    };
    let moves = steps.len() - 1;
    let frame = run.plan.frame_on_the_rig();
    let is_computed = |element: &Element| element.part == Part::Computed;
    let computed = if frame.is_some_and(|frame| frame.elements.iter().any(is_computed)) {
        " The rig alone moved: a computed element is at the deformation at which its model has no force."
    } else {
        ""
    };
    body.push(Block::paragraph(format!(
        "The axes of all tested elements moved together to zero force, in {moves} {}, each with the stiffness last measured.{computed}",
        if moves == 1 { "move" } else { "moves" }
    )));
    let whole = |values: &[f64]| {
        values
            .iter()
            .fold(0.0, |largest: f64, value| largest.max(value.abs()))
    };
    let travel = whole(&first.displacement).max(whole(&last.displacement));
    let loaded = whole(&first.restoring_force);
    let columns = vec![
        Column::words("Element", 1),
        Column::numbers("Deformation before"),
        Column::numbers("Residual deformation"),
        Column::numbers("Force before"),
        Column::numbers("Remaining force"),
    ];
    let row = |element: usize| -> Vec<Text> {
        let length = |step: &UnloadStep| {
            number::part_of(step.displacement[element], travel, 4, Dimension::LENGTH)
        };
        let force = |step: &UnloadStep| {
            number::part_of(step.restoring_force[element], loaded, 4, Dimension::FORCE)
        };
        let known = |kind: ResultKind, other: String| {
            known_entry(procedure, kind, element).unwrap_or_else(|| other.into())
        };
        vec![
            (element + 1).to_string().into(),
            length(first).into(),
            known(schema::RESIDUAL_DRIFT, length(last)),
            force(first).into(),
            known(schema::RESIDUAL_SHEAR, force(last)),
        ]
    };
    body.push(Block::Table(Table {
        columns,
        rows: (0..last.displacement.len()).map(row).collect(),
    }));
}
