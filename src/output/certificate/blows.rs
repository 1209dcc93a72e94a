//! The blows of an `escalate`, one row each. In: the history. Out: a table.

use super::super::document::{Block, Column, Table, Text};
use super::super::number;
use crate::quantity::Dimension;
use crate::record::{Blow, EscalateHistory};

/// Blows printed; the tables hold every one.
const PRINTED: usize = 40;

pub(super) fn table(history: &EscalateHistory, body: &mut Vec<Block>) {
    let blows = &history.blows;
    if blows.is_empty() {
        return;
    }
    body.push(rows(blows));
    if blows.len() > PRINTED {
        body.push(Block::note(format!("{} more blows are in the table of this procedure.", blows.len() - PRINTED)));
    }
    body.push(Block::note(
        "X counts from where the specimen was born; the striker of each blow touches the surface where it then was. Every blow has a \
         table of its own.",
    ));
}

/// Every number of a column in the unit of its largest.
fn rows(blows: &[Blow]) -> Block {
    let energy = blows.iter().map(|blow| blow.energy).fold(0.0, f64::max);
    let travel = blows.iter().filter_map(|blow| blow.number("max_displacement")).fold(0.0, |most: f64, x| most.max(x.abs()));
    let shown = |value: Option<f64>, beside: f64, dimension| {
        value.map_or_else(|| Text::from("—"), |value| number::text_beside(value, beside, dimension).into())
    };
    let row = |(index, blow): (usize, &Blow)| {
        let held = match blow.held {
            Some(true) => "held",
            Some(false) => "no longer held",
            None => "not complete",
        };
        vec![
            Text::from((index + 1).to_string()),
            number::text(blow.velocity, Dimension::VELOCITY).into(),
            shown(Some(blow.energy), energy, Dimension::ENERGY),
            shown(blow.number("max_displacement"), travel, Dimension::LENGTH),
            shown(blow.number("absorbed_energy"), energy, Dimension::ENERGY),
            shown(blow.rest_of_struck().map(|(displacement, _)| displacement), travel, Dimension::LENGTH),
            Text::from(held),
        ]
    };
    let columns = vec![
        Column::words("Blow", 1),
        Column::numbers("Velocity"),
        Column::numbers("Energy"),
        Column::numbers("Largest X"),
        Column::numbers("Absorbed"),
        Column::numbers("At rest at"),
        Column::words("Condition", 1),
    ];
    Block::Table(Table { columns, rows: blows.iter().take(PRINTED).enumerate().map(row).collect() })
}
