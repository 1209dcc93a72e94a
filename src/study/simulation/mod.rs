//! The runs of a study. In: a parsed plan and a study of it. Out: the row of run i: its inputs, results and outcomes, which depend on the
//! seed and i alone. It writes no file.

#[cfg(test)]
mod alone_tests;
mod batches;
pub mod readout;
#[cfg(test)]
mod tests;

use std::ops::Range;

use rayon::prelude::*;

use super::data_set::StudyRow;
use super::definition::Definition;
use crate::check::ParsedPlan;
use crate::check::binding::{Binder, BoundInputs};
use crate::procedures::impact::batched::Leaves;
use crate::run::{Keep, Unwatched, run_with};
use batches::Batch;
pub use batches::LeftBatches;
use psd_plan::formula::ResultReference;
use psd_plan::record::Record;
use psd_plan::{DecisionRule, Plan};
use psd_rig::virtual_rig;
use psd_text::diagnostic::Diagnostic;
use readout::{Kept, Readout};

/// Runs that one thread takes at a time.
pub const BLOCK: u64 = 1024;

/// Simulates the runs of a study.
pub struct Simulation<'a> {
    parsed: &'a ParsedPlan,
    inputs: BoundInputs,
    /// The plan without the study.
    plan: &'a Plan,
    study: &'a Definition,
    readout: Readout,
    is_batched: bool,
    /// The results that are read of a run.
    references: Vec<ResultReference>,
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
        let inputs = study.inputs.iter();
        let inputs = inputs.map(|input| (input.name.as_str(), input.dimension));
        let mut simulation = Self {
            parsed,
            inputs: BoundInputs::new(parsed, inputs),
            plan,
            study,
            readout,
            is_batched,
            references,
            left: LeftBatches::default(),
            with_studies: false,
        };
        let mut values = Vec::new();
        study.draws.draw(0, &mut values);
        let mut binder = Binder::new(parsed, &simulation.inputs).with_studies();
        let first = binder.bind(&values).ok().cloned();
        drop(binder);
        if let Some(first) = first {
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
        let mut binder = Binder::new(self.parsed, &self.inputs);
        if self.with_studies {
            binder = binder.with_studies();
        }
        let mut rows = Vec::new();
        let mut values = Vec::new();
        let mut batch = Batch::default();
        // The plan of the first impact of the batch, and whether it decides the other runs too.
        let mut first: Option<(Plan, bool)> = None;
        for run in runs {
            match points.and_then(|points| points.get(rows.len())) {
                Some(point) => self.study.draws.at(point, &mut values),
                None => self.study.draws.draw(run, &mut values),
            }
            let kept = match bind(&mut binder, &values) {
                Err(reason) => self.readout.nothing(self.plan, reason),
                Ok(plan) if self.is_batched => match batches::impact(plan) {
                    Some(impact) => {
                        batch.add(rows.len(), impact);
                        if first.is_none() {
                            let plan = plan.clone();
                            first = Some((plan, binder.decide_alike()));
                        }
                        Kept::default()
                    }
                    None => self.leaving(plan, Leaves::NeedsRig),
                },
                Ok(plan) => self.alone(plan),
            };
            rows.push(row(run, values.clone(), kept));
        }
        let Some((first, decides_all)) = first else {
            return rows;
        };
        batch.run(&first, &self.references, |at, record| {
            let inputs = std::mem::take(&mut rows[at].inputs);
            let kept = match record {
                Ok(record) if decides_all => self.readout.read(&first, record),
                // A batch keeps no plans.
                record => match (bind(&mut binder, &inputs), record) {
                    (Err(reason), _) => self.readout.nothing(self.plan, reason),
                    (Ok(plan), Ok(record)) => self.readout.read(plan, record),
                    (Ok(plan), Err(why)) => self.leaving(plan, why),
                },
            };
            rows[at] = row(rows[at].run, inputs, kept);
        });
        rows
    }

    /// A run that leaves its batch.
    fn leaving(&self, plan: &Plan, why: Leaves) -> Kept {
        self.left.count(why);
        self.alone(plan)
    }

    fn alone(&self, plan: &Plan) -> Kept {
        self.readout.read(plan, &simulated_alone(plan))
    }
}

/// The plan with these values of the inputs, whose runs decide on the value alone; the first error if it is invalid.
fn bind<'b>(binder: &'b mut Binder<'_>, values: &[f64]) -> Result<&'b Plan, String> {
    let plan = binder.bind(values).map_err(|errors| {
        let first = errors.into_iter().find(Diagnostic::is_error);
        first.map_or_else(
            || "the plan with these inputs is invalid".to_owned(),
            |first| format!("the plan with these inputs is invalid: {}", first.message),
        )
    })?;
    plan.decision_rule = DecisionRule::ValueAlone;
    Ok(plan)
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

/// Runs a plan with the values of one run as `psd run` does on its virtual rig, an ideal one if it names none. The results are the same to
/// the last bit, unless U ends a series of impacts. It keeps no run log and evaluates no uncertainty: the scatter of the study takes its
/// place.
fn simulated_alone(plan: &Plan) -> Record {
    let mut rig = virtual_rig(plan);
    run_with(plan, rig.as_mut(), &mut Unwatched, Keep::Results)
}
