//! How the actuators of a frame followed, as a report tells it: a sentence on all of them, a row for each. In: results of a
//! procedure. Out: a sentence, a table where anything was missed.

use super::super::document::{Block, Column, Table, Text};
use super::super::number::{self, percent};
use super::method;
use crate::physics::tracking::monitor::Tracking;
use crate::plan::formula::ResultValue;
use crate::record::ProcedureRecord;
use crate::units::Dimension;

/// All actuators over a run; the energy is the largest share, as the results have it.
pub(crate) fn sentence(procedure: &ProcedureRecord) -> Option<String> {
    let all = Tracking {
        energy_error: 0.0,
        indicator: 0.0,
        nrms_error: procedure.number("nrms_error")?,
        peak_error: procedure.number("peak_error")?,
    };
    Some(method::followed(
        all,
        procedure.number("tracking_energy_error"),
        "The actuators",
    ))
}

/// One row an actuator, from the ground up; none where every one stood at its targets.
pub(crate) fn table(procedure: &ProcedureRecord) -> Option<Block> {
    let list = |name: &str| match procedure.result(name).map(|result| &result.value) {
        Some(ResultValue::List(values)) => values.as_slice(),
        _ => &[],
    };
    let (energy, indicator) = (
        list("floor_tracking_energy_error"),
        list("floor_tracking_indicator"),
    );
    let (nrms, peak) = (list("floor_nrms_error"), list("floor_peak_error"));
    let largest = |values: &[f64]| {
        values
            .iter()
            .fold(0.0, |largest: f64, value| largest.max(value.abs()))
    };
    if largest(peak) < method::NOTHING {
        return None;
    }
    let cell = |values: &[f64], floor: usize, dimension| -> Text {
        values
            .get(floor)
            .map_or_else(
                || "—".to_owned(),
                |value| number::text_beside(*value, largest(values), dimension),
            )
            .into()
    };
    let share = |values: &[f64], floor: usize| -> Text {
        values
            .get(floor)
            .map_or_else(|| "—".to_owned(), |value| percent(*value))
            .into()
    };
    let columns = vec![
        Column::words("Actuator of floor", 1),
        Column::numbers("Largest error"),
        Column::numbers("NRMS error"),
        Column::numbers("Energy taken out (put in: −), of the input, at its largest"),
        Column::numbers("Tracking indicator at the end"),
    ];
    let row = |floor: usize| -> Vec<Text> {
        vec![
            (floor + 1).to_string().into(),
            cell(peak, floor, Dimension::LENGTH),
            share(nrms, floor),
            share(energy, floor),
            cell(indicator, floor, Dimension::AREA),
        ]
    };
    Some(Block::Table(Table {
        columns,
        rows: (0..peak.len()).map(row).collect(),
    }))
}
