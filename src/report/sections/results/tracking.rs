//! Tracking errors of the actuators of a frame: a sentence on all of them, a table with a row for each. In: results of a procedure. Out:
//! a sentence; a table if an actuator missed a target.

use super::actuators;
use crate::report::document::{Block, Column, Table, Text};
use crate::report::number;
use crate::report::wording::actuators as wording;
use psd_physics::structure::assemblies::Assemblies;
use psd_physics::tracking::monitor::Tracking;
use psd_plan::Frame;
use psd_plan::record::ProcedureRecord;
use psd_plan::schema::procedures::tracking;
use psd_text::units::Dimension;

/// All actuators over a run; the energy is that of the actuator with the largest one.
pub(crate) fn sentence(procedure: &ProcedureRecord) -> Option<String> {
    let all = Tracking {
        energy_error: 0.0,
        indicator: 0.0,
        nrms_error: procedure.number(tracking::NRMS_ERROR.name)?,
        peak_error: procedure.number(tracking::PEAK_ERROR.name)?,
    };
    Some(actuators::tracking_error(
        all,
        procedure.number(tracking::TRACKING_ENERGY_ERROR.name),
        wording::THE_ACTUATORS,
    ))
}

/// One row per actuator, from the ground up or in the order of the elements; none if every actuator reached its targets. A computed storey of `frame` has no actuator.
pub(crate) fn table(procedure: &ProcedureRecord, frame: Option<&Frame>) -> Option<Block> {
    let list = |name: &str| procedure.list(name).unwrap_or_default();
    let (energy, indicator) = (
        list(tracking::FLOOR_TRACKING_ENERGY_ERROR.name),
        list(tracking::FLOOR_TRACKING_INDICATOR.name),
    );
    let (nrms, peak) = (
        list(tracking::FLOOR_NRMS_ERROR.name),
        list(tracking::FLOOR_PEAK_ERROR.name),
    );
    let largest = |values: &[f64]| {
        values
            .iter()
            .fold(0.0, |largest: f64, value| largest.max(value.abs()))
    };
    if largest(peak) < actuators::ROUNDING {
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
    let fraction = |values: &[f64], floor: usize| -> Text {
        values
            .get(floor)
            .map_or_else(|| "—".to_owned(), |value| number::small_percent(*value))
            .into()
    };
    let [
        floor,
        peak_column,
        nrms_column,
        energy_column,
        indicator_column,
    ] = wording::COLUMNS;
    let assemblies = frame.and_then(Assemblies::of);
    let is_scaled = assemblies.as_ref().is_some_and(Assemblies::is_scaled);
    let peak_column = if is_scaled {
        wording::LARGEST_IN_PROTOTYPE
    } else {
        peak_column
    };
    let floor = if frame.is_some_and(Frame::has_elements) {
        wording::OF_ELEMENT
    } else {
        floor
    };
    let columns = vec![
        Column::words(floor, 1),
        Column::numbers(peak_column),
        Column::numbers(nrms_column),
        Column::numbers(energy_column),
        Column::numbers(indicator_column),
    ];
    let computed = assemblies.map_or_else(Vec::new, |assemblies| assemblies.computed());
    let has_actuator = |floor: &usize| !computed.contains(floor);
    let row = |floor: usize| -> Vec<Text> {
        vec![
            (floor + 1).to_string().into(),
            cell(peak, floor, Dimension::LENGTH),
            fraction(nrms, floor),
            fraction(energy, floor),
            cell(indicator, floor, Dimension::AREA),
        ]
    };
    Some(Block::Table(Table {
        columns,
        rows: (0..peak.len()).filter(has_actuator).map(row).collect(),
    }))
}
