//! Tables of a series of impacts: one row per impact, and on a frame one row per impact and storey. In: the history. Out: columns.

use std::iter::once;

use crate::procedures::impact;
use crate::record::{Blow, EscalateHistory, Rest};
use crate::report::tables::TableColumn::{self, Flag, Integer, Number, Optional};
use crate::report::tables::{Table, numeric, written};
use crate::schema::columns::{self, column};
use crate::schema::procedures::impact as results;
use crate::schema::{Column, ResultKind};
use crate::units::Dimension;

const BLOW: Column = column("blow", Dimension::NUMBER);
const REST_DISPLACEMENT: Column = column("rest_displacement_m", Dimension::LENGTH);
const REST_FORCE: Column = column("rest_force_n", Dimension::FORCE);

/// An impact and its number, from 1.
pub(crate) struct Row<'a> {
    number: u64,
    blow: &'a Blow,
}

impl Row<'_> {
    fn result(&self, result: ResultKind) -> Option<f64> {
        self.blow.number(result.name)
    }
}

/// A storey after an impact.
pub(crate) struct StoreyRow<'a> {
    number: u64,
    blow: &'a Blow,
    /// From 0.
    storey: usize,
}

impl StoreyRow<'_> {
    fn result(&self, result: ResultKind) -> Option<f64> {
        self.blow.list(result.name)?.get(self.storey).copied()
    }

    fn rest(&self, read: fn(&Rest) -> Vec<f64>) -> Option<f64> {
        read(self.blow.rest.as_ref()?).get(self.storey).copied()
    }
}

/// One row per impact: its level, its results, the position after it. Each impact also has the table of an impact.
pub(crate) fn blows<'a>() -> Vec<TableColumn<Row<'a>>> {
    vec![
        Integer(BLOW, |row| row.number),
        Number(columns::VELOCITY, |row| row.blow.velocity),
        Number(columns::ENERGY, |row| row.blow.energy),
        Optional(column("max_displacement_m", Dimension::LENGTH), |row| {
            row.result(results::MAX_DISPLACEMENT)
        }),
        Optional(
            column("time_of_max_displacement_s", Dimension::TIME),
            |row| row.result(results::TIME_OF_MAX_DISPLACEMENT),
        ),
        Optional(column("stop_time_s", Dimension::TIME), |row| {
            row.result(results::STOP_TIME)
        }),
        Optional(column("absorbed_energy_j", Dimension::ENERGY), |row| {
            row.result(results::ABSORBED_ENERGY)
        }),
        Optional(column("impulse_n_s", Dimension::IMPULSE), |row| {
            row.result(results::IMPULSE)
        }),
        Optional(column("max_contact_force_n", Dimension::FORCE), |row| {
            row.result(results::MAX_CONTACT_FORCE)
        }),
        Optional(column("contacts", Dimension::NUMBER), |row| {
            row.result(results::CONTACTS)
        }),
        Optional(columns::INDENTATION, |row| row.result(results::INDENTATION)),
        Optional(column("energy_error", Dimension::NUMBER), |row| {
            row.result(results::ENERGY_ERROR)
        }),
        Optional(REST_DISPLACEMENT, |row| {
            row.blow.rest_of_struck().map(|rest| rest.0)
        }),
        Optional(REST_FORCE, |row| {
            row.blow.rest_of_struck().map(|rest| rest.1)
        }),
        Flag("held", |row| row.blow.held),
    ]
}

/// One row per impact and storey: its results, the position after it. Each impact also has the table of an impact on a storey.
pub(crate) fn storeys<'a>() -> Vec<TableColumn<StoreyRow<'a>>> {
    vec![
        Integer(BLOW, |row| row.number),
        Integer(columns::STOREY, |row| row.storey as u64 + 1),
        Number(columns::ENERGY, |row| row.blow.energy),
        Optional(column("floor_displacement_m", Dimension::LENGTH), |row| {
            row.result(results::FLOOR_DISPLACEMENT)
        }),
        Optional(column("max_drift_m", Dimension::LENGTH), |row| {
            row.result(results::MAX_DRIFT)
        }),
        Optional(columns::STOREY_ENERGY, |row| {
            row.result(results::STOREY_ENERGY)
        }),
        Optional(REST_DISPLACEMENT, |row| {
            row.rest(|rest| rest.displacement.clone())
        }),
        Optional(REST_FORCE, |row| row.rest(|rest| rest.force.clone())),
        Optional(column("rest_drift_m", Dimension::LENGTH), |row| {
            row.rest(Rest::drift)
        }),
        Optional(column("rest_shear_n", Dimension::FORCE), |row| {
            row.rest(Rest::shear)
        }),
    ]
}

/// The numeric columns of all its tables.
pub(crate) fn columns() -> Vec<Column> {
    [
        numeric(&blows()),
        numeric(&storeys()),
        impact::tables::columns(),
    ]
    .concat()
}

/// The table of the impacts, that of each impact under a numbered name, and that of the storeys.
pub(crate) fn tables(name: String, history: &EscalateHistory) -> Vec<Table<'_>> {
    let tables = history.blows.iter().zip(1..).map(|(blow, number)| {
        let name = format!("{name}_{number}");
        impact::tables::table(name, &blow.history)
    });
    let tables: Vec<Table<'_>> = tables.collect();
    let has_storeys = history
        .storeys()
        .next()
        .is_some_and(|blow| !blow.floors.is_empty());
    let of_storeys = has_storeys.then(|| {
        Table::of_steps(format!("{name}_storeys"), 1, 1, |_| {
            written(&storeys(), &storey_rows(history))
        })
    });
    once(Table::of_steps(name, 1, 1, |_| {
        written(&blows(), &rows(history))
    }))
    .chain(tables)
    .chain(of_storeys)
    .collect()
}

fn rows(history: &EscalateHistory) -> Vec<Row<'_>> {
    let numbered = (1..).zip(&history.blows);
    numbered
        .map(|(number, blow)| Row { number, blow })
        .collect()
}

fn storey_rows(history: &EscalateHistory) -> Vec<StoreyRow<'_>> {
    let storeys = history
        .storeys()
        .next()
        .and_then(|blow| blow.floors.first())
        .map_or(0, |floors| floors.computed.len());
    let of_blow = |(number, blow)| {
        (0..storeys).map(move |storey| StoreyRow {
            number,
            blow,
            storey,
        })
    };
    (1..).zip(&history.blows).flat_map(of_blow).collect()
}
