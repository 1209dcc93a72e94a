//! The impacts of a series, one row each, and the storeys of a frame. In: plan and history. Out: blocks.

use crate::procedures::frame;
use crate::report::document::{Block, Column, Table, Text};
use crate::report::number::percent;
use crate::report::{Run, number};
use psd_plan::procedures::escalate::block as schema;
use psd_plan::procedures::impact::block as impact;
use psd_plan::record::{
    EscalateHistory, ImpactHistory, ProcedureRecord, SeriesImpact, StruckFrame,
};
use psd_plan::schema::ResultKind;
use psd_plan::{Frame, Impact, StoreyTarget};
use psd_text::units::Dimension;

/// Impacts printed; the tables hold every one.
const PRINTED: usize = 40;

pub(crate) fn table(
    run: &Run<'_>,
    impact: &Impact,
    procedure: &ProcedureRecord,
    history: &EscalateHistory,
    body: &mut Vec<Block>,
) {
    let impacts = &history.impacts;
    if impacts.is_empty() {
        return;
    }
    if let (
        Some(target),
        [
            SeriesImpact {
                history:
                    first @ ImpactHistory {
                        frame: Some(frame), ..
                    },
                ..
            },
            ..,
        ],
    ) = (impact.storey(), &impacts[..])
    {
        body.push(Block::paragraph(struck(run, impact, target, first, frame)));
        body.extend(
            frame
                .modes
                .as_ref()
                .map(|modes| frame::report::mode_table(modes, &frame.damping_ratios)),
        );
    }
    body.push(rows(procedure, impacts));
    if impacts.len() > PRINTED {
        body.push(Block::note(format!(
            "{} more impacts are in the table of this procedure.",
            impacts.len() - PRINTED
        )));
    }
    if impact.storey().is_some() {
        let frame = frame::report::frame_of(run, impact.specimen);
        body.push(storeys(procedure, frame));
        body.push(Block::note(
            "X is the displacement of the struck floor from its initial position. Each impact starts with the striker \
             at the current position of the floor. Each impact has a separate table with all floors.",
        ));
        return;
    }
    body.push(Block::note(
        "X is the displacement from the initial position of the specimen. Each impact starts with the striker at the \
         current surface. Each impact has a separate table.",
    ));
}

/// The struck floor, and the integration.
fn struck(
    run: &Run<'_>,
    impact: &Impact,
    target: &StoreyTarget,
    first: &ImpactHistory,
    frame: &StruckFrame,
) -> String {
    let time = |value| number::text(value, Dimension::TIME);
    format!(
        "Floor {} is struck in every impact. Contact law: {}. {} Time step {}; critical time step {}.",
        frame.struck + 1,
        impact.contact.title(),
        frame::report::integrated(
            frame::report::frame_of(run, impact.specimen),
            impact.stepping.integrator,
            &target.damping,
            &frame.damping_ratios
        ),
        time(first.time_step),
        time(first.critical_time_step),
    )
}

/// The largest drift of each storey over all impacts, the drift after the last, and the energy.
fn storeys(procedure: &ProcedureRecord, frame: Option<&Frame>) -> Block {
    let list = |kind: ResultKind| procedure.list(kind.name).unwrap_or_default();
    let left = if procedure.result(schema::RESIDUAL_DRIFT.name).is_some() {
        schema::RESIDUAL_DRIFT
    } else {
        schema::FINAL_DRIFT
    };
    let (largest, stayed, energy) = (
        list(schema::MAX_DRIFT),
        list(left),
        list(schema::STOREY_ENERGY),
    );
    let whole = |values: &[f64]| {
        values
            .iter()
            .fold(0.0, |most: f64, value| most.max(value.abs()))
    };
    let height = |storey: usize| {
        frame
            .and_then(|frame| frame.storeys.get(storey))
            .and_then(|storey| storey.height)
    };
    let columns = vec![
        Column::words("Storey", 1),
        Column::numbers("Largest drift of all impacts"),
        Column::numbers("Over height"),
        Column::numbers("Drift after the last impact"),
        Column::numbers("Over height"),
        Column::numbers("Absorbed energy"),
    ];
    let row = |storey: usize| -> Vec<Text> {
        let length = |kind: ResultKind, values: &[f64]| {
            let text = |value: &f64| number::text_beside(*value, whole(largest), Dimension::LENGTH);
            let plain = || {
                values
                    .get(storey)
                    .map_or_else(|| "—".to_owned(), text)
                    .into()
            };
            frame::report::known_entry(procedure, kind, storey).unwrap_or_else(plain)
        };
        let share = |values: &[f64]| {
            let share = height(storey)
                .zip(values.get(storey))
                .map(|(height, drift)| percent(drift / height));
            share.unwrap_or_else(|| "—".to_owned())
        };
        let took = energy.get(storey).map_or(0.0, |energy| *energy);
        vec![
            (storey + 1).to_string().into(),
            length(schema::MAX_DRIFT, largest),
            share(largest).into(),
            length(left, stayed),
            share(stayed).into(),
            frame::report::known_entry(procedure, schema::STOREY_ENERGY, storey).unwrap_or_else(
                || number::text_beside(took, whole(energy), Dimension::ENERGY).into(),
            ),
        ]
    };
    Block::Table(Table {
        columns,
        rows: (0..largest.len()).map(row).collect(),
    })
}

/// Every number with its standard uncertainty where it has one, else in the unit of the largest of its column.
fn rows(procedure: &ProcedureRecord, impacts: &[SeriesImpact]) -> Block {
    let energy = impacts
        .iter()
        .map(|impact| impact.energy)
        .fold(0.0, f64::max);
    let travel = impacts
        .iter()
        .filter_map(|impact| impact.number(impact::MAX_DISPLACEMENT.name))
        .fold(0.0, |most: f64, x| most.max(x.abs()));
    let shown = |value: Option<f64>, beside: f64, dimension| {
        value.map_or_else(
            || Text::from("—"),
            |value| number::text_beside(value, beside, dimension).into(),
        )
    };
    let unloaded = procedure
        .result(schema::RESIDUAL_DISPLACEMENTS.name)
        .is_some();
    let left = if unloaded {
        schema::RESIDUAL_DISPLACEMENTS
    } else {
        schema::FINAL_DISPLACEMENTS
    };
    let row = |(index, impact): (usize, &SeriesImpact)| {
        let held = match impact.held {
            Some(true) => "true",
            Some(false) => "false",
            None if impact.rest.is_some() => "inconclusive",
            None => "incomplete",
        };
        let known = |list: ResultKind, other: Text| {
            frame::report::known_entry(procedure, list, index).unwrap_or(other)
        };
        let rest = impact
            .rest_of_struck()
            .map(|(displacement, _)| displacement);
        vec![
            Text::from((index + 1).to_string()),
            known(
                schema::VELOCITIES,
                number::text(impact.velocity, Dimension::VELOCITY).into(),
            ),
            known(
                schema::IMPACT_ENERGIES,
                shown(Some(impact.energy), energy, Dimension::ENERGY),
            ),
            known(
                schema::MAX_DISPLACEMENTS,
                shown(
                    impact.number(impact::MAX_DISPLACEMENT.name),
                    travel,
                    Dimension::LENGTH,
                ),
            ),
            known(
                schema::ABSORBED_ENERGIES,
                shown(
                    impact.number(impact::ABSORBED_ENERGY.name),
                    energy,
                    Dimension::ENERGY,
                ),
            ),
            known(left, shown(rest, travel, Dimension::LENGTH)),
            Text::from(held),
        ]
    };
    let columns = vec![
        Column::words("Impact", 1),
        Column::numbers("Velocity"),
        Column::numbers("Energy"),
        Column::numbers("Largest X"),
        Column::numbers("Absorbed"),
        Column::numbers(if unloaded { "Unloaded at" } else { "Left at" }),
        Column::words("Condition", 1),
    ];
    Block::Table(Table {
        columns,
        rows: impacts.iter().take(PRINTED).enumerate().map(row).collect(),
    })
}
