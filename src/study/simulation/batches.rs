//! Runs of a study whose plan is one impact, many at once. In: plans with the values of their runs. Out: the record of each, without
//! steps; None for a run that has to go through the rig.

use crate::procedures;
use crate::procedures::impact::batched::{self, BatchedImpact};
use psd_plan::Plan;
use psd_plan::formula::{ResultPart, ResultReference};
use psd_plan::record::{Outcome, Record};
use psd_rig::virtual_rig;

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
    /// Number in the block, and plan.
    runs: Vec<(usize, Plan)>,
    impacts: Vec<BatchedImpact>,
}

impl Batch {
    /// Adds the impact of a plan. Its files are not kept: a batch has many plans.
    pub fn add(&mut self, number: usize, mut plan: Plan, impact: BatchedImpact) {
        plan.files = Vec::new();
        self.runs.push((number, plan));
        self.impacts.push(impact);
    }

    /// The records, with number and plan.
    pub fn run(self) -> impl Iterator<Item = (usize, Plan, Option<Record>)> {
        let first = self.runs.first().map(|(_, plan)| plan);
        let records = first.map_or_else(Vec::new, |plan| {
            let rig = virtual_rig(plan).identity();
            let record = |procedure| Record {
                rig: rig.clone(),
                procedures: vec![procedure],
                events: Vec::new(),
                outcome: Outcome::Completed,
                drift: None,
            };
            let impacts = batched::run(&plan.procedures[0], &self.impacts);
            let records = impacts.into_iter().map(|found| found.map(record));
            records.collect::<Vec<_>>()
        });
        self.runs
            .into_iter()
            .zip(records)
            .map(|((number, plan), record)| (number, plan, record))
    }
}
