//! Runs of a study whose plan is one impact, many at once. In: plans with the values of their runs. Out: the record of each, without
//! steps; or why a run has to go through the rig.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::procedures;
use crate::procedures::impact::batched::{self, BatchedImpact, Leaves};
use psd_plan::Plan;
use psd_plan::formula::{ResultPart, ResultReference};
use psd_plan::record::Record;
use psd_rig::virtual_rig;
use psd_text::count::counted;

/// The impact that is the whole plan, if it can run in a batch.
pub fn impact(plan: &Plan) -> Option<BatchedImpact> {
    let first = &plan.procedures.first()?.kind;
    BatchedImpact::of(procedures::point_impact(first)?, plan)
}

/// Whether batches give everything that is read of the runs of this plan.
pub fn takes(plan: &Plan, read: &[ResultReference]) -> bool {
    let given = |reference: &ResultReference| {
        reference.part == ResultPart::Value && batched::gives(reference.name)
    };
    impact(plan).is_some() && read.iter().all(given)
}

/// Impacts that wait to run together.
#[derive(Default)]
pub struct Batch {
    /// Their numbers in the block.
    numbers: Vec<usize>,
    impacts: Vec<BatchedImpact>,
}

impl Batch {
    /// Adds an impact with its number in the block.
    pub fn add(&mut self, number: usize, impact: BatchedImpact) {
        self.numbers.push(number);
        self.impacts.push(impact);
    }

    /// Reads the record of each with its number, or why it leaves the batch. `plan`: that of any of them; `results`: what is read.
    pub fn run(
        self,
        plan: &Plan,
        results: &[ResultReference],
        mut read: impl FnMut(usize, Result<&Record, Leaves>),
    ) {
        let rig = virtual_rig(plan).identity();
        let names: Vec<&str> = results.iter().map(|reference| reference.name).collect();
        batched::run(
            &plan.procedures[0],
            rig,
            &self.impacts,
            &names,
            |at, record| read(self.numbers[at], record),
        );
    }
}

/// Runs of a study in batches that left them, by the reason.
#[derive(Debug, Default)]
pub struct LeftBatches {
    needs_rig: AtomicU64,
    outside_at_start: AtomicU64,
    not_finite: AtomicU64,
}

impl LeftBatches {
    pub(super) fn count(&self, why: Leaves) {
        let counter = match why {
            Leaves::NeedsRig => &self.needs_rig,
            Leaves::OutsideAtStart => &self.outside_at_start,
            Leaves::NotFinite => &self.not_finite,
        };
        counter.fetch_add(1, Ordering::Relaxed);
    }

    /// One line on the terminal; None if no run left.
    #[must_use]
    pub fn text(&self) -> Option<String> {
        let counts = [
            (&self.needs_rig, "with values that need the rig"),
            (&self.outside_at_start, "outside a limit at the start"),
            (&self.not_finite, "with a result that is not finite"),
        ]
        .map(|(counter, why)| (counter.load(Ordering::Relaxed), why));
        let all: u64 = counts.iter().map(|(count, _)| count).sum();
        let runs = counted(all, "run", "runs");
        let reasons: Vec<String> = counts
            .into_iter()
            .filter(|(count, _)| *count > 0)
            .map(|(count, why)| format!("{count} {why}"))
            .collect();
        (all > 0).then(|| format!("{runs} left the batches: {}", reasons.join(", ")))
    }
}
