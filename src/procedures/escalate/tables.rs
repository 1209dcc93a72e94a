//! Tables of a series of impacts: one row per impact, and on a frame one row per impact and storey. In: the history. Out: columns.

use std::iter::once;

use crate::procedures::impact;
use crate::report::tables::TableColumn::{self, Flag, Integer, Number, Optional};
use crate::report::tables::{Table, numeric, written};
use psd_physics::structure::assemblies::Assemblies;
use psd_plan::procedures::impact::block as results;
use psd_plan::record::{EscalateHistory, Rest, SeriesImpact};
use psd_plan::schema::columns::{self, column};
use psd_plan::schema::{Column, ResultKind};
use psd_text::units::Dimension;

const IMPACT_NUMBER: Column = column("impact", Dimension::NUMBER);
const REST_DISPLACEMENT: Column = column("rest_displacement_m", Dimension::LENGTH);
const REST_FORCE: Column = column("rest_force_n", Dimension::FORCE);

/// An impact and its number, from 1.
pub(crate) struct ImpactRow<'a> {
    number: u64,
    impact: &'a SeriesImpact,
}

impl ImpactRow<'_> {
    fn result(&self, result: ResultKind) -> Option<f64> {
        self.impact.number(result.name)
    }
}

/// A storey after an impact.
pub(crate) struct StoreyRow<'a> {
    number: u64,
    impact: &'a SeriesImpact,
    /// From 0.
    storey: usize,
}

impl StoreyRow<'_> {
    fn result(&self, result: ResultKind) -> Option<f64> {
        self.impact.list(result.name)?.get(self.storey).copied()
    }

    fn rest(&self, read: fn(&Rest) -> Vec<f64>) -> Option<f64> {
        read(self.impact.rest.as_ref()?).get(self.storey).copied()
    }
}

/// One row per impact: its level, its results, the position after it. Each impact also has the table of an impact.
pub(crate) fn impact_columns<'a>() -> Vec<TableColumn<ImpactRow<'a>>> {
    vec![
        Integer(IMPACT_NUMBER, |row| row.number),
        Number(columns::VELOCITY, |row| row.impact.velocity),
        Number(columns::ENERGY, |row| row.impact.energy),
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
            row.impact.rest_of_struck().map(|rest| rest.0)
        }),
        Optional(REST_FORCE, |row| {
            row.impact.rest_of_struck().map(|rest| rest.1)
        }),
        Flag("held", |row| row.impact.held),
    ]
}

/// One row per impact and storey: its results, the position after it. Each impact also has the table of an impact on a storey.
pub(crate) fn storeys<'a>() -> Vec<TableColumn<StoreyRow<'a>>> {
    vec![
        Integer(IMPACT_NUMBER, |row| row.number),
        Integer(columns::STOREY, |row| row.storey as u64 + 1),
        Number(columns::ENERGY, |row| row.impact.energy),
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
        numeric(&impact_columns()),
        numeric(&storeys()),
        impact::tables::columns(),
    ]
    .concat()
}

/// The table of the impacts, that of each impact under a numbered name, and that of the storeys.
pub(crate) fn tables<'a>(
    name: String,
    history: &'a EscalateHistory,
    scaled: Option<&Assemblies>,
) -> Vec<Table<'a>> {
    let tables = history.impacts.iter().zip(1..).map(|(impact, number)| {
        let name = format!("{name}_{number}");
        impact::tables::table(name, &impact.history, scaled.cloned())
    });
    let tables: Vec<Table<'a>> = tables.collect();
    let has_storeys = history
        .storeys()
        .next()
        .is_some_and(|impact| !impact.floors.is_empty());
    let of_storeys = has_storeys.then(|| {
        Table::of_steps(format!("{name}_storeys"), 1, 1, |_| {
            written(&storeys(), &storey_rows(history))
        })
    });
    once(Table::of_steps(name, 1, 1, |_| {
        written(&impact_columns(), &rows(history))
    }))
    .chain(tables)
    .chain(of_storeys)
    .collect()
}

fn rows(history: &EscalateHistory) -> Vec<ImpactRow<'_>> {
    let numbered = (1..).zip(&history.impacts);
    numbered
        .map(|(number, impact)| ImpactRow { number, impact })
        .collect()
}

fn storey_rows(history: &EscalateHistory) -> Vec<StoreyRow<'_>> {
    let storeys = history
        .storeys()
        .next()
        .and_then(|impact| impact.floors.first())
        .map_or(0, |floors| floors.floors.computed.len());
    let rows_of = |(number, impact)| {
        (0..storeys).map(move |storey| StoreyRow {
            number,
            impact,
            storey,
        })
    };
    (1..).zip(&history.impacts).flat_map(rows_of).collect()
}
