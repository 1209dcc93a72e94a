//! Logging, replay and resume. A run is a function of its plan and of the answers of rig and
//! operator, so the logged answers reproduce it. In: the calls of a run on its rig and observer.
//! Out: the same calls, executed and logged, or answered from the run log. Sessions of remote
//! clients are logged in the same way.
//!
//! Order of a step on a real rig: INTENT durable → target sent → SAMPLE durable → integrated →
//! STEP.

mod consistency;
mod continuous_motion;
mod entry;
mod entry_of;
mod in_force;
mod logged_run;
mod plain_body;
mod recorded_observer;
mod recorded_rig;
mod resume_decision;
mod shape;
mod state;
mod steps_digest;
#[cfg(test)]
pub(crate) mod tests;

pub use consistency::{Contradiction, check_consistency};
pub use entry::{
    AmendBody, Assurance, BY_HAND, Call, Header, HeaderFile, HeldBody, IntentBody, LogForm, RULES,
    RecoverBody, ResumeBody, RigBody, SampleBody, StrokeBody, TargetStatus,
};
pub use in_force::{InForce, Rigs};
pub use logged_run::{LoggedRun, Mismatch, UnreadableLog, number_of_steps};
pub use recorded_observer::RecordedObserver;
pub use recorded_rig::RecordedRig;
pub use resume_decision::{
    Bands, ResumeDecision, ResumeRefusal, decide, no_faster, not_restarted, same_measure,
    same_resolution, same_rig,
};
pub use shape::{Malformed, well_formed};
pub use state::{CUT_OFF, Continuation};

use std::cell::RefCell;
use std::rc::Rc;

use entry::PlanBody;
use psd_plan::Plan;
use psd_plan::record::{Event, Outcome, Record};
use psd_rig::journal::{EntryKind, Journal, JournalFault};
use psd_rig::{Rig, virtual_rig};
use state::{Begin, State};

use super::{Observer, Request, Unwatched, run};
use crate::run::client_run::{ClientRunRecord, Driver, Requests, drive};
use crate::run::remote_control::Specimen;
use psd_plan::record::remote::DrivenStep;

/// Gives the time of day, as text; None for a virtual run.
pub type Wall = Box<dyn Fn() -> Option<String>>;

/// A run log that has its header, and the clock that dates its entries.
pub struct OpenLog {
    pub journal: Journal,
    pub wall: Wall,
}

/// Runs the plan on a rig and logs every answer. The header is in the run log already.
///
/// # Errors
/// The end of the run log cannot be written; the record is complete in this case too.
pub fn record(
    plan: &Plan,
    rig: &mut dyn Rig,
    observer: &mut dyn Observer,
    journal: Journal,
    wall: Wall,
) -> Recorded {
    let state = State::recording(journal, wall);
    perform(Some(rig), observer, state, |rig, observer, _| {
        run(plan, rig, observer)
    })
}

/// As [`record`], for a run on a simulated rig, of which the run log keeps only digests of the steps. The header states this.
pub fn record_compactly(
    plan: &Plan,
    rig: &mut dyn Rig,
    observer: &mut dyn Observer,
    journal: Journal,
) -> Recorded {
    let state = State::digesting(journal);
    perform(Some(rig), observer, state, |rig, observer, _| {
        run(plan, rig, observer)
    })
}

/// Lets a client drive the plan's rig, and logs its requests and every answer.
pub fn record_driven(
    plan: &Plan,
    rig: &mut dyn Rig,
    observer: &mut dyn Observer,
    log: OpenLog,
    requests: Requests<'_>,
) -> (Recorded, Vec<DrivenStep>) {
    let mut done = Vec::new();
    let recorded = perform(
        Some(rig),
        observer,
        State::recording(log.journal, log.wall),
        |rig, observer, _| {
            let ClientRunRecord { record, steps } = drive(plan, rig, observer, requests);
            done = steps;
            record
        },
    );
    (recorded, done)
}

/// Replays a run log: without a rig, and without the operator. Only the content of the run log is known. A compact run log is simulated again
/// and compared.
#[must_use]
pub fn replay(plan: &Plan, logged: LoggedRun) -> Replayed {
    let driver = logged.header.served.as_deref().map(|by| {
        if by == BY_HAND {
            Driver::ByHand
        } else {
            Driver::Client
        }
    });
    let mut simulated = (logged.header.log == LogForm::Compact && logged.rigs.first().is_some())
        .then(|| virtual_rig(plan));
    let state = State::replaying(logged);
    let mut steps = None;
    let Recorded {
        record, mismatch, ..
    } = if let Some(driver) = driver {
        perform(None, &mut Unwatched, state, |rig, observer, state| {
            let requests = Requests {
                driver,
                clock: &|| 0.0,
                client: &mut |specimen| repeat_requests(state, specimen),
            };
            let driven = drive(plan, rig, observer, requests);
            steps = Some(driven.steps);
            driven.record
        })
    } else {
        let simulated = simulated.as_mut().map(|rig| &mut **rig as &mut dyn Rig);
        perform(simulated, &mut Unwatched, state, |rig, observer, _| {
            run(plan, rig, observer)
        })
    };
    Replayed {
        record,
        mismatch,
        steps,
    }
}

/// Replays a run log without a rig, and continues it at its end on the rig that `begin` opens. The rig is opened late, so that it never
/// waits for a replay. `begin` is not called if plan and run log differ, or if the run would only end again. After `begin`, only the
/// readings of a stroke are still replayed.
///
/// # Errors
/// The run cannot be continued, or `begin` refuses.
pub fn resume<'rig, E: From<ResumeRefusal> + 'rig>(
    plan: &Plan,
    logged: &LoggedRun,
    observer: &mut dyn Observer,
    wall: Wall,
    begin: impl FnOnce() -> Result<Continuation<'rig>, E> + 'rig,
) -> Result<Recorded, E> {
    let lines = resume_decision::without_stop_entries(logged)?;
    let undecided = resume_decision::undecided(&lines).map_err(ResumeRefusal::from)?;
    let refused = Rc::new(RefCell::new(None));
    let refusal = Rc::clone(&refused);
    let begin: Begin<'rig> =
        Box::new(move || begin().map_err(|error| refusal.replace(Some(error))).ok());
    let state = State::resuming(
        LoggedRun {
            lines: lines.into(),
            ..logged.clone()
        },
        begin,
        undecided,
        wall,
    );
    let recorded = perform(None, observer, state, |rig, observer, _| {
        run(plan, rig, observer)
    });
    if let Some(error) = refused.take() {
        return Err(error);
    }
    if recorded.sealed.is_some() {
        return Ok(recorded);
    }
    Err(match (recorded.mismatch, recorded.record.outcome) {
        (Some(mismatch), _) => mismatch.into(),
        (
            None,
            Outcome::Aborted { reason }
            | Outcome::NotReleased { reason }
            | Outcome::Blocked { reason }
            | Outcome::Faulted { reason },
        ) => ResumeRefusal::EndsAgain { reason },
        (None, Outcome::Completed) => ResumeRefusal::Ended,
    }
    .into())
}

/// A run, and the state of its run log.
pub struct Recorded {
    pub record: Record,
    /// The difference between run log and plan.
    pub mismatch: Option<Mismatch>,
    /// Why the run log could not be written; the run was held there.
    pub fault: Option<JournalFault>,
    /// Number of entries in the run log, and the chain value at its head.
    pub sealed: Option<(u64, String)>,
}

/// A run that was replayed from its run log.
pub struct Replayed {
    pub record: Record,
    pub mismatch: Option<Mismatch>,
    /// The requests and readings of a client that drove the rig. None: the plan's procedures drove it.
    pub steps: Option<Vec<DrivenStep>>,
}

fn perform<'rig>(
    rig: Option<&'rig mut dyn Rig>,
    observer: &mut dyn Observer,
    state: State<'rig>,
    runs: impl FnOnce(&mut dyn Rig, &mut dyn Observer, &RefCell<State<'rig>>) -> Record,
) -> Recorded {
    let state = Rc::new(RefCell::new(state));
    let mut rig = RecordedRig::new(rig, Rc::clone(&state));
    let mut observer = RecordedObserver::new(observer, Rc::clone(&state));
    let mut record = runs(&mut rig, &mut observer, &state);
    let mut state = state.borrow_mut();
    if record.outcome == Outcome::Completed
        && state.mismatch().is_none()
        && state.next_kind().is_some()
    {
        if let Some(fault) = state.final_entry() {
            // A run that the failure of its run log stopped has logged its final hold.
            if state.logged_final_hold().is_some() {
                let reason = fault.to_string();
                record.outcome = Outcome::Faulted { reason };
            }
        } else {
            // Entries beyond the end of the plan belong to a different plan.
            let reason = state.report_mismatch("its end".to_owned()).to_string();
            record.outcome = Outcome::Faulted { reason };
        }
    }
    state.end_of_repetition();
    add_interruptions(&mut record, state.take_interruptions());
    if state.mismatch().is_none() && record.outcome == Outcome::Completed {
        state.end();
    } else {
        state.close();
    }
    Recorded {
        record,
        mismatch: state.take_mismatch(),
        fault: state.take_fault(),
        sealed: state.sealed(),
    }
}

/// Repeats the logged requests of a client on the specimen.
fn repeat_requests(state: &RefCell<State<'_>>, specimen: &mut Specimen<'_, '_>) {
    loop {
        let (over, stayed) = {
            let state = state.borrow();
            (
                state.next_kind().is_none() || state.mismatch().is_some(),
                state.front_is_pause_fault(),
            )
        };
        if over {
            return;
        }
        if stayed {
            specimen.repeat_stay();
            continue;
        }
        let Some(request) = state.borrow_mut().next_request() else {
            return;
        };
        let last = request == Request::Close;
        specimen.carry_out(request);
        // The entries after it come from the session itself: recovered communication errors.
        if last {
            return;
        }
    }
}

/// Resumptions and amendments are events of the record, each at its time.
fn add_interruptions(record: &mut Record, interruptions: Vec<Event>) {
    for event in interruptions {
        let at = record
            .events
            .iter()
            .position(|other| other.time > event.time)
            .unwrap_or(record.events.len());
        record.events.insert(at, event);
    }
}

/// Writes the start of a run: the header, and the texts of its files.
///
/// # Errors
/// It cannot be written.
pub fn begin(journal: &mut Journal, header: &Header, texts: &[String]) -> Result<(), JournalFault> {
    journal.append(EntryKind::Header, header)?;
    append_texts(journal, texts)?;
    journal.sync_point()
}

/// Writes that a different header applies from here on, and its texts.
///
/// # Errors
/// It cannot be written.
pub fn amend(
    journal: &mut Journal,
    amendment: &AmendBody,
    texts: &[String],
) -> Result<(), JournalFault> {
    journal.append(EntryKind::Amend, amendment)?;
    append_texts(journal, texts)?;
    journal.sync_point()
}

fn append_texts(journal: &mut Journal, texts: &[String]) -> Result<(), JournalFault> {
    PlanBody::parts_of(texts)
        .iter()
        .try_for_each(|part| journal.append(EntryKind::Plan, part))
}
