//! The blows of an `escalate`, one row each, and on a frame what became of its storeys. In: plan and history. Out: blocks.

use crate::plan::formula::ResultValue;
use crate::plan::{BlowOn, Frame, ProcedureKind, StoreyImpact};
use crate::procedures::base_excitation;
use crate::procedures::impact::report::contact_law;
use crate::record::{Blow, EscalateHistory, ImpactHistory, ProcedureRecord, StruckFrame};
use crate::report::document::{Block, Column, Table, Text};
use crate::report::number::percent;
use crate::report::{Run, number};
use crate::units::Dimension;

/// Blows printed; the tables hold every one.
const PRINTED: usize = 40;

pub(crate) fn table(
    run: &Run<'_>,
    index: usize,
    procedure: &ProcedureRecord,
    history: &EscalateHistory,
    body: &mut Vec<Block>,
) {
    let blows = &history.blows;
    if blows.is_empty() {
        return;
    }
    let Some(ProcedureKind::Escalate(planned)) =
        run.plan.procedures.get(index).map(|planned| &planned.kind)
    else {
        return;
    };
    if let (
        BlowOn::Storey(impact),
        [
            Blow {
                history:
                    first @ ImpactHistory {
                        frame: Some(frame), ..
                    },
                ..
            },
            ..,
        ],
    ) = (&planned.blow, &blows[..])
    {
        body.push(Block::paragraph(struck(run, impact, first, frame)));
        body.extend(
            frame
                .modes
                .as_ref()
                .map(|modes| base_excitation::report::mode_table(modes, &frame.damping_ratios)),
        );
    }
    body.push(rows(procedure, blows));
    if blows.len() > PRINTED {
        body.push(Block::note(format!(
            "{} more blows are in the table of this procedure.",
            blows.len() - PRINTED
        )));
    }
    if let BlowOn::Storey(impact) = &planned.blow {
        let frame = run
            .plan
            .specimens
            .get(impact.specimen)
            .and_then(|specimen| specimen.frame.as_ref());
        body.push(storeys(procedure, frame));
        body.push(Block::note(
            "X is that of the struck floor and counts from where the frame was born; the striker of each blow touches the floor where \
             it then was. Every blow has a table of its own, with all its floors.",
        ));
        return;
    }
    body.push(Block::note(
        "X counts from where the specimen was born; the striker of each blow touches the surface where it then was. Every blow has a \
         table of its own.",
    ));
}

/// Which floor was struck, and how it was integrated.
fn struck(
    run: &Run<'_>,
    impact: &StoreyImpact,
    first: &ImpactHistory,
    frame: &StruckFrame,
) -> String {
    let time = |value| number::text(value, Dimension::TIME);
    format!(
        "Floor {} is struck in every blow. Contact law: {}. {} Time step {}; the critical one is {}.",
        frame.struck + 1,
        contact_law(&impact.contact),
        base_excitation::report::integrated(
            base_excitation::report::frame_of(run, impact.specimen),
            impact.stepping.integrator,
            &impact.damping,
            &frame.damping_ratios
        ),
        time(first.time_step),
        time(first.critical_time_step),
    )
}

/// What each storey went through in all blows, and what stayed.
fn storeys(procedure: &ProcedureRecord, frame: Option<&Frame>) -> Block {
    let list = |name: &str| match procedure.result(name).map(|result| &result.value) {
        Some(ResultValue::List(values)) => values.as_slice(),
        _ => &[],
    };
    let left = if procedure.result("residual_drift").is_some() {
        "residual_drift"
    } else {
        "final_drift"
    };
    let (largest, stayed, energy) = (list("max_drift"), list(left), list("storey_energy"));
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
        Column::numbers("Largest drift of all blows"),
        Column::numbers("Of its height"),
        Column::numbers("Drift after the last blow"),
        Column::numbers("Of its height"),
        Column::numbers("Energy it took"),
    ];
    let row = |storey: usize| -> Vec<Text> {
        let length = |name: &str, values: &[f64]| {
            let text = |value: &f64| number::text_beside(*value, whole(largest), Dimension::LENGTH);
            let plain = || {
                values
                    .get(storey)
                    .map_or_else(|| "—".to_owned(), text)
                    .into()
            };
            base_excitation::report::known_entry(procedure, name, storey).unwrap_or_else(plain)
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
            length("max_drift", largest),
            share(largest).into(),
            length(left, stayed),
            share(stayed).into(),
            base_excitation::report::known_entry(procedure, "storey_energy", storey)
                .unwrap_or_else(|| {
                    number::text_beside(took, whole(energy), Dimension::ENERGY).into()
                }),
        ]
    };
    Block::Table(Table {
        columns,
        rows: (0..largest.len()).map(row).collect(),
    })
}

/// Every number with its standard uncertainty where it has one, else of a column in the unit of its largest.
fn rows(procedure: &ProcedureRecord, blows: &[Blow]) -> Block {
    let energy = blows.iter().map(|blow| blow.energy).fold(0.0, f64::max);
    let travel = blows
        .iter()
        .filter_map(|blow| blow.number("max_displacement"))
        .fold(0.0, |most: f64, x| most.max(x.abs()));
    let shown = |value: Option<f64>, beside: f64, dimension| {
        value.map_or_else(
            || Text::from("—"),
            |value| number::text_beside(value, beside, dimension).into(),
        )
    };
    let unloaded = procedure.result("residual_displacements").is_some();
    let left = if unloaded {
        "residual_displacements"
    } else {
        "final_displacements"
    };
    let row = |(index, blow): (usize, &Blow)| {
        let held = match blow.held {
            Some(true) => "held",
            Some(false) => "no longer held",
            None if blow.rest.is_some() => "not decided",
            None => "not complete",
        };
        let known = |list: &str, other: Text| {
            base_excitation::report::known_entry(procedure, list, index).unwrap_or(other)
        };
        let rest = blow.rest_of_struck().map(|(displacement, _)| displacement);
        vec![
            Text::from((index + 1).to_string()),
            known(
                "velocities",
                number::text(blow.velocity, Dimension::VELOCITY).into(),
            ),
            known(
                "blow_energies",
                shown(Some(blow.energy), energy, Dimension::ENERGY),
            ),
            known(
                "max_displacements",
                shown(blow.number("max_displacement"), travel, Dimension::LENGTH),
            ),
            known(
                "absorbed_energies",
                shown(blow.number("absorbed_energy"), energy, Dimension::ENERGY),
            ),
            known(left, shown(rest, travel, Dimension::LENGTH)),
            Text::from(held),
        ]
    };
    let columns = vec![
        Column::words("Blow", 1),
        Column::numbers("Velocity"),
        Column::numbers("Energy"),
        Column::numbers("Largest X"),
        Column::numbers("Absorbed"),
        Column::numbers(if unloaded { "At rest at" } else { "Left at" }),
        Column::words("Condition", 1),
    ];
    Block::Table(Table {
        columns,
        rows: blows.iter().take(PRINTED).enumerate().map(row).collect(),
    })
}
