//! Tables of an `escalate`: one row a blow, and on a frame one row a blow and storey. In: the history. Out: columns.

use polars::prelude::Column;

use super::{integers, numbers};
use crate::record::{Blow, EscalateHistory, Rest};

/// The results of each blow, with its level and what followed.
pub(super) fn rows(history: &EscalateHistory) -> Vec<Column> {
    let blows = &history.blows;
    let of = |name: &str, result: &str| {
        let read = |blow: &Blow| blow.number(result);
        Column::new(name.into(), blows.iter().map(read).collect::<Vec<Option<f64>>>())
    };
    let some = |name: &str, read: fn(&Blow) -> Option<f64>| {
        Column::new(name.into(), blows.iter().map(read).collect::<Vec<Option<f64>>>())
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
        some("rest_displacement_m", |blow| blow.rest_of_struck().map(|rest| rest.0)),
        some("rest_force_n", |blow| blow.rest_of_struck().map(|rest| rest.1)),
        Column::new("held".into(), blows.iter().map(|blow| blow.held).collect::<Vec<Option<bool>>>()),
    ]
}

/// What each storey went through in each blow, and what stayed.
pub(super) fn storeys(history: &EscalateHistory) -> Vec<Column> {
    let storeys = history.storeys().next().and_then(|blow| blow.floors.first()).map_or(0, |floors| floors.computed.len());
    let rows: Vec<(u64, &Blow, usize)> =
        (1..).zip(&history.blows).flat_map(|(number, blow)| (0..storeys).map(move |storey| (number, blow, storey))).collect();
    let of = |name: &str, result: &str| {
        let read = |(_, blow, storey): &(u64, &Blow, usize)| blow.list(result)?.get(*storey).copied();
        Column::new(name.into(), rows.iter().map(read).collect::<Vec<Option<f64>>>())
    };
    let rest = |name: &str, read: fn(&Rest) -> Vec<f64>| {
        let read = |(_, blow, storey): &(u64, &Blow, usize)| read(blow.rest.as_ref()?).get(*storey).copied();
        Column::new(name.into(), rows.iter().map(read).collect::<Vec<Option<f64>>>())
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
