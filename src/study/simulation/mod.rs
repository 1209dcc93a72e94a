//! The runs of a study. In: a parsed plan and a study of it. Out: the row of run i: its inputs, results and outcomes, which depend on the
//! seed and i alone. It writes no file.

mod alone;
#[cfg(test)]
mod alone_tests;
mod batches;
pub mod readout;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::ops::Range;

use rayon::prelude::*;

use super::data_set::StudyRow;
use super::definition::Definition;
use crate::check::ParsedPlan;
use crate::procedures::impact::batched::Leaves;
use batches::Batch;
pub use batches::LeftBatches;
use psd_physics::impact::summary::Wanted;
use psd_plan::Plan;
use psd_text::diagnostic::Diagnostic;
use psd_text::units::Quantity;
use readout::{Kept, Readout};

/// Runs that one thread takes at a time.
pub const BLOCK: u64 = 1024;

/// Simulates the runs of a study.
pub struct Simulation<'a> {
    parsed: &'a ParsedPlan,
    /// The plan without the study.
    plan: &'a Plan,
    study: &'a Definition,
    readout: Readout,
    is_batched: bool,
    /// What batches have to find.
    wanted: Wanted,
    left: LeftBatches,
    /// Formulas of the study contain varied values.
    with_studies: bool,
}

impl<'a> Simulation<'a> {
    /// The runs of `study`. `plan` is what `parsed` gives with no other values.
    #[must_use]
    pub fn new(parsed: &'a ParsedPlan, plan: &'a Plan, study: &'a Definition) -> Self {
        let readout = Readout::of(plan, study);
        let references = readout.references(plan);
        let is_batched = batches::takes(plan, &references);
        let mut simulation = Self {
            parsed,
            plan,
            study,
            readout,
            is_batched,
            wanted: batches::wanted(&references),
            left: LeftBatches::default(),
            with_studies: false,
        };
        let mut values = Vec::new();
        study.draws.draw(0, &mut values);
        let first = parsed.bind_with_studies(&simulation.quantities(&values));
        if let Ok(first) = first {
            simulation.with_studies = simulation.readout.differs(&first);
            simulation.readout.keep_limits_of(plan, &first);
        }
        simulation
    }

    /// The same, run by run: the reference for batches.
    #[must_use]
    pub fn one_by_one(self) -> Self {
        Self {
            is_batched: false,
            ..self
        }
    }

    /// Whether impacts run in batches.
    #[must_use]
    pub const fn is_batched(&self) -> bool {
        self.is_batched
    }

    /// The runs that left their batches so far.
    #[must_use]
    pub const fn left(&self) -> &LeftBatches {
        &self.left
    }

    /// What is kept of every run.
    #[must_use]
    pub const fn readout(&self) -> &Readout {
        &self.readout
    }

    /// The rows of these runs, in their order, on all cores. They do not depend on the number of threads.
    #[must_use]
    pub fn rows(&self, runs: Range<u64>) -> Vec<StudyRow> {
        self.on_all_cores(runs, None)
    }

    /// The same at these points in standard normal space, one for each run.
    #[must_use]
    pub fn rows_at(&self, first: u64, points: &[Vec<f64>]) -> Vec<StudyRow> {
        self.on_all_cores(first..first + points.len() as u64, Some(points))
    }

    fn on_all_cores(&self, runs: Range<u64>, points: Option<&[Vec<f64>]>) -> Vec<StudyRow> {
        let threads = rayon::current_num_threads() as u64;
        // Several pieces a thread, so that none waits long for the others; large enough for batches.
        let size = ((runs.end - runs.start) / (4 * threads)).clamp(1, BLOCK);
        let starts: Vec<u64> = (runs.start..runs.end)
            .step_by(usize::try_from(size).expect("at most BLOCK"))
            .collect();
        let of_start = |start: &u64| {
            let part = *start..(start + size).min(runs.end);
            let [from, to] = [part.start, part.end]
                .map(|run| usize::try_from(run - runs.start).expect("as many as points"));
            self.on_this_thread(part, points.map(|points| &points[from..to]))
        };
        starts.par_iter().map(of_start).flatten().collect()
    }

    /// The rows of these runs, on this thread.
    #[must_use]
    pub fn block(&self, runs: Range<u64>) -> Vec<StudyRow> {
        self.on_this_thread(runs, None)
    }

    fn on_this_thread(&self, runs: Range<u64>, points: Option<&[Vec<f64>]>) -> Vec<StudyRow> {
        let mut rows = Vec::new();
        let mut values = Vec::new();
        let mut batch = Batch::new(self.wanted);
        for run in runs {
            match points.and_then(|points| points.get(rows.len())) {
                Some(point) => self.study.draws.at(point, &mut values),
                None => self.study.draws.draw(run, &mut values),
            }
            let kept = match self.bind(&values) {
                Err(reason) => self.readout.nothing(self.plan, reason),
                Ok(plan) if self.is_batched => match batches::impact(&plan) {
                    Some(impact) => {
                        batch.add(rows.len(), plan, impact);
                        Kept::default()
                    }
                    None => self.leaving(&plan, Leaves::NeedsRig),
                },
                Ok(plan) => self.alone(&plan),
            };
            rows.push(row(run, values.clone(), kept));
        }
        for (at, plan, record) in batch.run() {
            let kept = match record {
                Ok(record) => self.readout.read(&plan, &record),
                Err(why) => self.leaving(&plan, why),
            };
            let inputs = std::mem::take(&mut rows[at].inputs);
            rows[at] = row(rows[at].run, inputs, kept);
        }
        rows
    }

    /// A run that leaves its batch.
    fn leaving(&self, plan: &Plan, why: Leaves) -> Kept {
        self.left.count(why);
        self.alone(plan)
    }

    fn alone(&self, plan: &Plan) -> Kept {
        self.readout.read(plan, &alone::simulate(plan))
    }

    fn quantities(&self, values: &[f64]) -> BTreeMap<String, Quantity> {
        let inputs = self.study.inputs.iter().zip(values);
        inputs
            .map(|(input, value)| (input.name.clone(), Quantity::new(*value, input.dimension)))
            .collect()
    }

    /// The plan with these values of the inputs, prepared; the first error if it is invalid.
    fn bind(&self, values: &[f64]) -> Result<Plan, String> {
        let quantities = self.quantities(values);
        let bound = if self.with_studies {
            self.parsed.bind_with_studies(&quantities)
        } else {
            self.parsed.bind(&quantities)
        };
        let mut plan = bound.map_err(|errors| {
            let first = errors.into_iter().find(Diagnostic::is_error);
            first.map_or_else(
                || "the plan with these inputs is invalid".to_owned(),
                |first| format!("the plan with these inputs is invalid: {}", first.message),
            )
        })?;
        self.readout.prepare(&mut plan);
        Ok(plan)
    }
}

fn row(run: u64, inputs: Vec<f64>, kept: Kept) -> StudyRow {
    StudyRow {
        run,
        inputs,
        results: kept.results,
        outcomes: kept.outcomes,
        reason: kept.reason,
    }
}
