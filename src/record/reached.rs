//! How far a run took its channels: the largest displacement and force, by size, in its tables. In: a record. Out: numbers.

use super::equipment::Measures;
use super::{BlowHistory, History, Record};

impl Record {
    /// The largest reading of a channel of an axis, from 0, by size: m or N. None where nothing was recorded.
    #[must_use]
    pub fn reached(&self, measures: Measures, axis: usize) -> Option<f64> {
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
        self.procedures.iter().for_each(|procedure| readings(&procedure.history, &mut give));
        largest
    }
}

/// Gives displacement (m) and force (N) of every axis, row by row of a table.
fn readings(history: &History, give: &mut dyn FnMut(&[f64], &[f64])) {
    match history {
        History::Ramp(ramp) => ramp.steps.iter().for_each(|step| give(&[step.displacement], &[step.restoring_force])),
        History::Move(steps) => steps.iter().for_each(|step| give(&[step.displacement], &[step.restoring_force])),
        History::Sweep(sweep) => sweep.steps.iter().for_each(|step| give(&[step.displacement], &[step.restoring_force])),
        History::Impact(impact) => impact.steps.iter().for_each(|step| give(&[step.displacement], &[step.restoring_force])),
        History::Cycle(cycle) => cycle.steps.iter().for_each(|step| give(&[step.displacement], &[step.restoring_force])),
        History::StoreyImpact(impact) => {
            impact.floors.iter().for_each(|step| give(&step.displacement, &step.restoring_force));
        }
        History::Shake(shake) => shake.steps.iter().for_each(|step| give(&step.displacement, &step.restoring_force)),
        History::FrameUnload(steps) => steps.iter().for_each(|step| give(&step.displacement, &step.restoring_force)),
        History::Escalate(row) => {
            for blow in &row.blows {
                match &blow.history {
                    BlowHistory::Impact(impact) => {
                        impact.steps.iter().for_each(|step| give(&[step.displacement], &[step.restoring_force]));
                    }
                    BlowHistory::Storey(impact) => {
                        impact.floors.iter().for_each(|step| give(&step.displacement, &step.restoring_force));
                    }
                }
            }
        }
        History::Inspect => {}
    }
}
