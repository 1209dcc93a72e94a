//! How far a run took its channels: the largest displacement and force, by size, in its tables. In: a record. Out: numbers.

use super::readings;
use crate::record::equipment::Measures;
use crate::record::{ImpactHistory, Record};

/// The largest reading of a channel of an axis, from 0, by size: m or N. None where nothing was recorded.
#[must_use]
pub(crate) fn reached(record: &Record, measures: Measures, axis: usize) -> Option<f64> {
    let mut largest: Option<f64> = None;
    let mut give = |displacement: &[f64], force: &[f64]| {
        let read = match measures {
            Measures::Displacement => displacement.get(axis),
            Measures::Force => force.get(axis),
        };
        if let Some(read) = read.filter(|read| read.is_finite()) {
            largest = Some(largest.map_or(read.abs(), |largest| largest.max(read.abs())));
        }
    };
    record
        .procedures
        .iter()
        .for_each(|procedure| readings(&procedure.history, &mut give));
    largest
}

/// Gives displacement (m) and force (N) of every axis of an impact, row by row of its table.
pub(crate) fn of_impact(history: &ImpactHistory, give: &mut dyn FnMut(&[f64], &[f64])) {
    match &history.frame {
        None => history
            .steps
            .iter()
            .for_each(|step| give(&[step.displacement], &[step.restoring_force])),
        Some(frame) => frame
            .floors
            .iter()
            .for_each(|step| give(&step.displacement, &step.restoring_force)),
    }
}
