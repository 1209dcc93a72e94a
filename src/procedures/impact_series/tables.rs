//! Tables of a series of impacts: one row per impact, and on a frame one row per impact and storey. In: the history. Out: columns.

use std::iter::once;

use crate::procedures::impact;
use crate::record::{Blow, EscalateHistory, Rest};
use crate::report::tables::{Column, Table, integers, numbers};
use crate::schema;
use crate::schema::ResultKind;
use crate::schema::columns::{self, column};
use crate::schema::procedures::impact as results;
use crate::units::Dimension;

/// The numeric columns, one row per impact; each impact also has the table of an impact.
pub(crate) const COLUMNS: &[schema::Column] = &[
    column("blow", Dimension::NUMBER),
    columns::VELOCITY,
    column("energy_j", Dimension::ENERGY),
    column("max_displacement_m", Dimension::LENGTH),
    column("time_of_max_displacement_s", Dimension::TIME),
    column("stop_time_s", Dimension::TIME),
    column("absorbed_energy_j", Dimension::ENERGY),
    column("impulse_n_s", Dimension::IMPULSE),
    column("max_contact_force_n", Dimension::FORCE),
    column("contacts", Dimension::NUMBER),
    column("indentation_m", Dimension::LENGTH),
    column("energy_error", Dimension::NUMBER),
    column("rest_displacement_m", Dimension::LENGTH),
    column("rest_force_n", Dimension::FORCE),
];

/// The numeric columns, one row per impact and storey; each impact also has the table of an impact on a storey.
pub(crate) const STOREY_COLUMNS: &[schema::Column] = &[
    column("floor_displacement_m", Dimension::LENGTH),
    column("max_drift_m", Dimension::LENGTH),
    column("rest_drift_m", Dimension::LENGTH),
    column("rest_shear_n", Dimension::FORCE),
];

/// The table of the impacts, that of each impact under a numbered name, and that of the storeys.
pub(crate) fn tables(name: String, history: &EscalateHistory) -> Vec<Table<'_>> {
    let blows = history.blows.iter().zip(1..).map(|(blow, number)| {
        let name = format!("{name}_{number}");
        impact::tables::table(name, &blow.history)
    });
    let blows: Vec<Table<'_>> = blows.collect();
    let has_storeys = history
        .storeys()
        .next()
        .is_some_and(|blow| !blow.floors.is_empty());
    let storeys =
        has_storeys.then(|| Table::of_steps(format!("{name}_storeys"), 1, 1, |_| storeys(history)));
    once(Table::of_steps(name, 1, 1, |_| rows(history)))
        .chain(blows)
        .chain(storeys)
        .collect()
}

/// One row per impact: its level, its results, the position after it.
pub(crate) fn rows(history: &EscalateHistory) -> Vec<Column> {
    let blows = &history.blows;
    let of = |name: &str, result: ResultKind| {
        let read = |blow: &Blow| blow.number(result.name);
        Column::new(
            name.into(),
            blows.iter().map(read).collect::<Vec<Option<f64>>>(),
        )
    };
    let some = |name: &str, read: fn(&Blow) -> Option<f64>| {
        Column::new(
            name.into(),
            blows.iter().map(read).collect::<Vec<Option<f64>>>(),
        )
    };
    let numbered: Vec<u64> = (1..).take(blows.len()).collect();
    vec![
        integers("blow", &numbered, |number| *number),
        numbers("velocity_m_per_s", blows, |blow| blow.velocity),
        numbers("energy_j", blows, |blow| blow.energy),
        of("max_displacement_m", results::MAX_DISPLACEMENT),
        of(
            "time_of_max_displacement_s",
            results::TIME_OF_MAX_DISPLACEMENT,
        ),
        of("stop_time_s", results::STOP_TIME),
        of("absorbed_energy_j", results::ABSORBED_ENERGY),
        of("impulse_n_s", results::IMPULSE),
        of("max_contact_force_n", results::MAX_CONTACT_FORCE),
        of("contacts", results::CONTACTS),
        of("indentation_m", results::INDENTATION),
        of("energy_error", results::ENERGY_ERROR),
        some("rest_displacement_m", |blow| {
            blow.rest_of_struck().map(|rest| rest.0)
        }),
        some("rest_force_n", |blow| {
            blow.rest_of_struck().map(|rest| rest.1)
        }),
        Column::new(
            "held".into(),
            blows
                .iter()
                .map(|blow| blow.held)
                .collect::<Vec<Option<bool>>>(),
        ),
    ]
}

/// One row per impact and storey: its results, the position after it.
pub(crate) fn storeys(history: &EscalateHistory) -> Vec<Column> {
    let storeys = history
        .storeys()
        .next()
        .and_then(|blow| blow.floors.first())
        .map_or(0, |floors| floors.computed.len());
    let rows: Vec<(u64, &Blow, usize)> = (1..)
        .zip(&history.blows)
        .flat_map(|(number, blow)| (0..storeys).map(move |storey| (number, blow, storey)))
        .collect();
    let of = |name: &str, result: ResultKind| {
        let read =
            |(_, blow, storey): &(u64, &Blow, usize)| blow.list(result.name)?.get(*storey).copied();
        Column::new(
            name.into(),
            rows.iter().map(read).collect::<Vec<Option<f64>>>(),
        )
    };
    let rest = |name: &str, read: fn(&Rest) -> Vec<f64>| {
        let read = |(_, blow, storey): &(u64, &Blow, usize)| {
            read(blow.rest.as_ref()?).get(*storey).copied()
        };
        Column::new(
            name.into(),
            rows.iter().map(read).collect::<Vec<Option<f64>>>(),
        )
    };
    vec![
        integers("blow", &rows, |(number, ..)| *number),
        integers("storey", &rows, |(.., storey)| *storey as u64 + 1),
        numbers("energy_j", &rows, |(_, blow, _)| blow.energy),
        of("floor_displacement_m", results::FLOOR_DISPLACEMENT),
        of("max_drift_m", results::MAX_DRIFT),
        of("storey_energy_j", results::STOREY_ENERGY),
        rest("rest_displacement_m", |rest| rest.displacement.clone()),
        rest("rest_force_n", |rest| rest.force.clone()),
        rest("rest_drift_m", Rest::drift),
        rest("rest_shear_n", Rest::shear),
    ]
}
