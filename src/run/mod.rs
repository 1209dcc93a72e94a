//! Plan × rig → record: one file a procedure. Every target and reading passes the rig's guard.

mod attribution;
mod axes;
#[cfg(test)]
mod balance_tests;
mod blow;
mod bounded;
#[cfg(test)]
mod contacts_tests;
mod continuous;
#[cfg(test)]
mod continuous_tests;
mod curve;
mod cycle;
mod cycle_doubts;
mod cycle_rounding;
#[cfg(test)]
mod cycle_rounding_tests;
#[cfg(test)]
mod cycle_tests;
mod damping_sweep;
#[cfg(test)]
mod degrees_tests;
pub mod driven;
#[cfg(test)]
mod driven_tests;
mod ending;
mod escalate;
#[cfg(test)]
mod escalate_tests;
mod followed;
#[cfg(test)]
mod followed_tests;
#[cfg(test)]
mod forecast_tests;
mod foreseen;
#[cfg(test)]
mod foreseen_tests;
mod frame_doubts;
#[cfg(test)]
mod frame_doubts_tests;
#[cfg(test)]
mod frame_sequence_tests;
mod frame_steps;
mod gate;
mod gliding;
#[cfg(test)]
mod gliding_doubts_tests;
#[cfg(test)]
mod growth_tests;
mod hold;
mod hold_rounding;
#[cfg(test)]
mod hold_rounding_tests;
mod impact;
#[cfg(test)]
mod impact_tests;
mod inputs;
mod inspect;
#[cfg(test)]
mod matrix_doubts_tests;
mod motion;
mod move_to;
pub mod need;
#[cfg(test)]
mod need_tests;
#[cfg(test)]
mod path_matrix_tests;
mod propagation;
#[cfg(test)]
mod propagation_tests;
mod ramp_doubts;
pub mod rehearsal;
mod request;
mod rest_doubts;
#[cfg(test)]
mod rest_doubts_tests;
mod results;
#[cfg(test)]
mod rig_fault_tests;
mod rounding_doubts;
#[cfg(test)]
mod rounding_doubts_tests;
mod samples;
mod secant_doubts;
#[cfg(test)]
mod sequence_tests;
mod session;
#[cfg(test)]
mod settled_hold_tests;
mod shake;
mod shake_doubts;
mod shake_results;
mod shaking;
pub mod start;
mod stepping;
mod stiffer;
#[cfg(test)]
mod stiffer_tests;
mod stiffness_on_the_way;
mod stiffness_ramp;
mod stop;
mod storey_doubts;
mod storey_impact;
mod storey_summary;
mod strike;
mod striking;
mod study;
#[cfg(test)]
mod sweep_lag_tests;
pub mod tape;
#[cfg(test)]
pub(crate) mod testing;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod time_step_tests;
mod triggers;
mod unload;
#[cfg(test)]
mod unload_tests;
mod watch;
mod zero;

pub use damping_sweep::MOST_SAMPLES;
pub use motion::{Extent, Motion};
pub use request::{Parting, Request};
pub use study::MOST_DRAWS;

use serde::{Deserialize, Serialize};

use crate::formula::ProcedureId;
use crate::mechanics::monitor::Tracking;
use crate::plan::{DriftCheck, Plan, Procedure, ProcedureKind, ZeroAfter};
use crate::record::{Event, EventKind, History, NamedResult, Outcome, ProcedureRecord, Record};
use crate::rig::Rig;
use inputs::Inputs;
use session::Session;
use stop::Stop;

/// Who watches a run: a progress bar, a live screen, a journal, a person.
pub trait Observer {
    /// A procedure begins; `steps` is an upper bound of its steps where one is known.
    fn procedure_started(&mut self, _name: &str, _keyword: &str, _steps: Option<u64>) {}
    fn step_done(&mut self, _report: &StepReport) {}
    fn procedure_finished(&mut self, _name: &str) {}
    /// The uncertainty of the results is being worked out, by runs taken again: so many of so many are done.
    fn studying(&mut self, _done: usize, _of: usize) {}
    /// Asked after every step: true stops the run after holding the rig.
    fn stop_requested(&self) -> bool {
        false
    }
    /// A person is to look at the specimen; the answer says whether to go on. Asked again while it is
    /// [`Inspection::Wait`].
    fn inspect(&mut self, note: &str) -> Inspection;
    /// A real rig is about to move for the first time: whether a person releases it for this motion. `note` is the record's word for
    /// it. Asked again while it is [`Inspection::Wait`].
    fn release(&mut self, note: &str, _motion: &Motion) -> Inspection {
        self.inspect(note)
    }
    /// The run has ended early, and the rig holds: whether it may take the load off. `declared`: the plan's safe state is to unload.
    /// None: nobody wants it, and the rig stays held. Asked again while it is [`Inspection::Wait`].
    fn may_unload(&mut self, _question: &str, _motion: &Motion, _declared: bool) -> Option<Inspection> {
        None
    }
    /// What a person wants between two steps. Asked until it is [`Next::GoOn`].
    fn next(&mut self) -> Next {
        Next::GoOn
    }
    /// Something worth a line happened; the record has it.
    fn event(&mut self, _: &Event) {}
    /// A client that drives the rig asks for something; it is about to be done.
    fn asked(&mut self, _: &Request) {}
}

/// What comes after a step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Next {
    GoOn,
    /// The run is paused: ask again in a moment.
    Wait,
    /// Something a person did or saw, for the record.
    Record(String),
}

/// The end of a step, for who watches and for the record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepReport {
    /// Number within its procedure, from 1.
    pub step: u64,
    /// Virtual time of an impact, else rig time, s.
    pub time: f64,
    /// Target of the step, m.
    pub command: f64,
    /// Measured, m.
    pub displacement: f64,
    /// Computed, m/s; only of procedures that integrate.
    pub velocity: Option<f64>,
    /// Computed, m/s²; only of procedures that integrate.
    pub acceleration: Option<f64>,
    /// Measured restoring force, N.
    pub force: f64,
    /// Of the last way of the rig, m/s; only for who watches.
    #[serde(skip)]
    pub speed: Option<f64>,
    /// Energy error over the input energy; only of procedures that integrate.
    pub energy_error: Option<f64>,
    /// What the monitors of tracking show; only of procedures that integrate.
    pub tracking: Option<Tracking>,
    /// Its energy error over the energy put into the test so far.
    pub tracking_energy_error: Option<f64>,
    /// The axes after the first, whose numbers stand above, of a procedure that moves several.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub others: Vec<AxisReport>,
}

/// One axis at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AxisReport {
    /// m
    pub command: f64,
    /// Measured, m.
    pub displacement: f64,
    /// Computed, m/s.
    pub velocity: f64,
    /// Computed, m/s².
    pub acceleration: f64,
    /// Measured, N.
    pub force: f64,
}

impl StepReport {
    /// Target (m), measured displacement (m) and force (N) of every axis.
    pub fn axes(&self) -> impl Iterator<Item = (f64, f64, f64)> {
        let others = self.others.iter().map(|axis| (axis.command, axis.displacement, axis.force));
        std::iter::once((self.command, self.displacement, self.force)).chain(others)
    }
}

/// What the person said.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Inspection {
    GoOn {
        note: Option<String>,
        /// Who says so, where it is known.
        by: Option<String>,
    },
    Stop {
        reason: String,
        /// Who says so, where it is known.
        by: Option<String>,
    },
    /// No answer yet: ask again in a moment.
    Wait,
}

impl Inspection {
    /// Goes on with nothing to say.
    #[must_use]
    pub const fn go_on() -> Self {
        Self::GoOn { note: None, by: None }
    }
}

/// Said in the record before a stopped run takes the load off.
pub(crate) const UNLOADING: &str = "unloading to where the run began";

/// Watches nothing, goes on at every inspection.
pub struct Unwatched;

impl Observer for Unwatched {
    fn inspect(&mut self, _: &str) -> Inspection {
        Inspection::go_on()
    }
}

/// What a procedure leaves, also when it was stopped: everything recorded up to there and what follows from it.
struct Performed {
    history: History,
    /// In the schema's order, every one of them.
    results: Vec<NamedResult>,
    stop: Option<Stop>,
}

/// Runs every procedure of the plan in order on the rig. Never fails: what went wrong is the record's outcome.
#[must_use]
pub fn run(plan: &Plan, rig: &mut dyn Rig, observer: &mut dyn Observer) -> Record {
    let identity = rig.identity();
    let mut record =
        Record { rig: identity, procedures: Vec::new(), events: Vec::new(), outcome: Outcome::Completed, drift: None };
    let mut session = match Session::begin(plan, rig, observer) {
        Ok(session) => session,
        Err(ended) => {
            let (event, stop) = *ended;
            return Record { events: vec![event], outcome: stop.outcome(), ..record };
        }
    };
    if let Some(link) = plan.rig.link.as_real()
        && let Err(stop) = gate::pass(plan, link, afterwards(plan), &mut session)
    {
        session.end(&stop);
        return Record { events: session.finish(), outcome: stop.outcome(), ..record };
    }
    let home = session.guard.commanded().to_vec();
    match plan.rig.drift.map(|check| zero::before(check, &mut session)).transpose() {
        Ok(drift) => record.drift = drift,
        Err(stop) => {
            session.end(&stop);
            return Record { events: session.finish(), outcome: stop.outcome(), ..record };
        }
    }
    for procedure in &plan.procedures {
        if let Err(stop) = session.stop_if_requested() {
            record.outcome = session.end_as_declared(&stop, plan);
            break;
        }
        session.enter(procedure, plan);
        let mut inputs = Inputs::new(&record, ProcedureId(record.procedures.len()));
        let Performed { mut history, mut results, stop } = perform(procedure, plan, &mut inputs, &mut session);
        inputs.take_observations().into_iter().for_each(|text| session.event(EventKind::Remark, text));
        attribution::attribute(&procedure.kind, &history, plan, (&inputs, session.guard.declared_noise()), &mut results);
        rounding_doubts::floor(&mut history, &results);
        let inputs = inputs.into_recorded();
        record.procedures.push(ProcedureRecord {
            name: procedure.name.clone(),
            kind: procedure.kind.keyword(),
            complete: stop.is_none(),
            inputs,
            results,
            history,
        });
        if let Some(stop) = stop {
            record.outcome = session.end_as_declared(&stop, plan);
            break;
        }
        session.leave();
    }
    if let Some(drift) = &mut record.drift {
        drift.held = session.guard.take_held();
        if record.outcome == Outcome::Completed
            && let Err(stop) = session.stop_if_requested().and_then(|()| zero::after(drift, &home, &mut session))
        {
            session.end(&stop);
            record.outcome = stop.outcome();
        }
    }
    record.events = session.finish();
    record
}

/// What a real rig does once it has proved itself.
fn afterwards(plan: &Plan) -> &'static str {
    match plan.rig.drift {
        Some(DriftCheck { after: ZeroAfter::Start, .. }) => "as the plan says, and at its end back to where it began",
        _ => "as the plan says",
    }
}

fn perform(procedure: &Procedure, plan: &Plan, inputs: &mut Inputs<'_>, session: &mut Session<'_>) -> Performed {
    match &procedure.kind {
        ProcedureKind::StiffnessRamp(ramp) => stiffness_ramp::perform(ramp, plan, inputs, session),
        ProcedureKind::DampingSweep(sweep) => damping_sweep::perform(sweep, plan, inputs, session),
        ProcedureKind::Impact(impact) => impact::perform(impact, plan, inputs, session),
        ProcedureKind::StoreyImpact(impact) => storey_impact::perform(impact, plan, inputs, session),
        ProcedureKind::Shake(shaking) => shake::perform(shaking, plan, inputs, session),
        ProcedureKind::Cycle(cycling) => cycle::perform(cycling, plan, inputs, session),
        ProcedureKind::Escalate(escalate) => escalate::perform(escalate, plan, inputs, session),
        ProcedureKind::Unload(unload) => unload::perform(unload, plan, inputs, session),
        ProcedureKind::FrameUnload(unload) => unload::perform_frame(unload, plan, inputs, session),
        ProcedureKind::Move(to) => move_to::perform(to, inputs, session),
        ProcedureKind::Inspect { note } => inspect::perform(note, session),
    }
}
