//! The table of an `escalate`: one row a blow. In: the history. Out: columns.

use polars::prelude::Column;

use super::{integers, numbers};
use crate::record::{Blow, EscalateHistory};

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
