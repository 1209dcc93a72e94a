//! Tables of an `escalate`: one row a blow, and on a frame one row a blow and storey. In: the history. Out: columns.

use std::iter::once;

use crate::procedures::impact;
use crate::record::{Blow, EscalateHistory, Rest};
use crate::report::tables::{Column, Table, integers, numbers};
use crate::schema;
use crate::schema::columns::{self, column};
use crate::units::Dimension;

/// The numeric columns of its blows; each blow has the table of an impact besides.
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

/// What each storey went through in a blow on a frame, and what stayed; each blow has the table of an impact on a storey besides.
pub(crate) const STOREY_COLUMNS: &[schema::Column] = &[
    column("floor_displacement_m", Dimension::LENGTH),
    column("max_drift_m", Dimension::LENGTH),
    column("rest_drift_m", Dimension::LENGTH),
    column("rest_shear_n", Dimension::FORCE),
];

/// The blows, what became of the storeys, and each blow under the name with its number.
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

/// The results of each blow, with its level and what followed.
pub(crate) fn rows(history: &EscalateHistory) -> Vec<Column> {
    let blows = &history.blows;
    let of = |name: &str, result: &str| {
        let read = |blow: &Blow| blow.number(result);
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
        of("max_displacement_m", "max_displacement"),
        of("time_of_max_displacement_s", "time_of_max_displacement"),
        of("stop_time_s", "stop_time"),
        of("absorbed_energy_j", "absorbed_energy"),
        of("impulse_n_s", "impulse"),
        of("max_contact_force_n", "max_contact_force"),
        of("contacts", "contacts"),
        of("indentation_m", "indentation"),
        of("energy_error", "energy_error"),
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

/// What each storey went through in each blow, and what stayed.
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
    let of = |name: &str, result: &str| {
        let read =
            |(_, blow, storey): &(u64, &Blow, usize)| blow.list(result)?.get(*storey).copied();
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
        of("floor_displacement_m", "floor_displacement"),
        of("max_drift_m", "max_drift"),
        of("storey_energy_j", "storey_energy"),
        rest("rest_displacement_m", |rest| rest.displacement.clone()),
        rest("rest_force_n", |rest| rest.force.clone()),
        rest("rest_drift_m", Rest::drift),
        rest("rest_shear_n", Rest::shear),
    ]
}
