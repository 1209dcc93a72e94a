//! Logging, replay and resume. A run is a function of its plan and of the answers of rig and
//! operator, so the logged answers reproduce it. In: the calls of a run on its rig and observer.
//! Out: the same calls, executed and logged, or answered from the run log. Sessions of remote
//! clients are logged in the same way.
//!
//! Order of a step on a real rig: INTENT durable → target sent → SAMPLE durable → integrated →
//! STEP.

mod compatibility;
mod consistency;
mod entry;
#[cfg(test)]
mod held_tests;
#[cfg(test)]
mod measured;
mod observer;
mod path;
mod replayed;
mod resume_decision;
#[cfg(test)]
mod resume_tests;
mod rig;
mod shape;
mod state;
#[cfg(test)]
pub(crate) mod tests;

pub use compatibility::RULES;
pub use consistency::{Contradiction, agrees};
pub use entry::{
    AmendBody, Assurance, BY_HAND, Call, Doubt, Header, HeaderFile, IntentBody, RecoverBody,
    ResumeBody, RigBody, SampleBody, StrokeBody,
};
pub use observer::TapedObserver;
pub use replayed::{Mismatch, Played, Unplayable};
pub use resume_decision::{
    Bands, Decision, Refusal, decide, not_restarted, same_measure, same_resolution, same_rig,
};
pub use rig::TapedRig;
pub use shape::{Malformed, well_formed};
pub use state::{CUT_OFF, GoesOn};

use std::cell::RefCell;
use std::rc::Rc;

use crate::plan::Plan;
use crate::record::journal::{EntryKind, Journal, JournalFault};
use crate::record::{Event, Outcome, Record};
use crate::rig::Rig;
use entry::PlanBody;
use state::{Begin, State};

use super::{Observer, Unwatched, run};
use crate::record::remote::DrivenStep;
use crate::run::remote_control;
use crate::run::remote_control::{DrivenRecord, Driver, Specimen};

/// Gives the wall clock, as text; a virtual run has none.
pub type Wall = Box<dyn Fn() -> Option<String>>;

/// Runs the plan on a rig and records every answer. The header stands in the journal already.
///
/// # Errors
/// The journal cannot be ended; the record is complete all the same.
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

/// Lets a client drive the plan's rig and records what it asks for and every answer. The header stands in the journal already.
pub fn record_driven(
    plan: &Plan,
    rig: &mut dyn Rig,
    observer: &mut dyn Observer,
    journal: Journal,
    wall: Wall,
    driver: Driver,
    client: &mut dyn FnMut(&mut Specimen<'_, '_>),
) -> (Recorded, Vec<DrivenStep>) {
    let mut done = Vec::new();
    let recorded = perform(
        Some(rig),
        observer,
        State::recording(journal, wall),
        |rig, observer, _| {
            let DrivenRecord { record, steps } =
                remote_control::drive(plan, rig, observer, driver, client);
            done = steps;
            record
        },
    );
    (recorded, done)
}

/// Plays a record back: no rig, nobody asked. What the journal holds is all that is known.
#[must_use]
pub fn replay(plan: &Plan, played: Played) -> Replayed {
    let driver = played.header.served.as_deref().map(|by| {
        if by == BY_HAND {
            Driver::ByHand
        } else {
            Driver::Client
        }
    });
    let as_run = compatibility::as_it_was_run(plan, &played);
    let state = State::replaying(played);
    let mut steps = None;
    let Recorded {
        record, mismatch, ..
    } = if let Some(driver) = driver {
        let plan = as_run.as_ref();
        perform(None, &mut Unwatched, state, |rig, observer, state| {
            let driven = remote_control::drive(plan, rig, observer, driver, &mut |specimen| {
                state::ask_again(state, specimen);
            });
            steps = Some(driven.steps);
            driven.record
        })
    } else {
        perform(None, &mut Unwatched, state, |rig, observer, _| {
            run(as_run.as_ref(), rig, observer)
        })
    };
    Replayed {
        record,
        mismatch,
        steps,
    }
}

/// Plays a record back without a rig, and goes on with it on the one that `begin` opens at its end. A rig is not opened for what can be
/// known without it, and never waits for a record: `begin` is not called where plan and record part ways, or where the run would only end
/// again, and behind it nothing is played any more but the readings of a stroke.
///
/// # Errors
/// The run cannot be gone on with, or `begin` refuses.
pub fn resume<'rig, E: From<Refusal> + 'rig>(
    plan: &Plan,
    played: &Played,
    observer: &mut dyn Observer,
    wall: Wall,
    begin: impl FnOnce() -> Result<GoesOn<'rig>, E> + 'rig,
) -> Result<Recorded, E> {
    let lines = resume_decision::without_the_end(played)?;
    let undecided = resume_decision::undecided(&lines).map_err(Refusal::from)?;
    let refused = Rc::new(RefCell::new(None));
    let refusal = Rc::clone(&refused);
    let begin: Begin<'rig> =
        Box::new(move || begin().map_err(|error| refusal.replace(Some(error))).ok());
    let as_run = compatibility::as_it_was_run(plan, played);
    let state = State::resuming(
        Played {
            lines: lines.into(),
            ..played.clone()
        },
        begin,
        undecided,
        wall,
    );
    let recorded = perform(None, observer, state, |rig, observer, _| {
        run(as_run.as_ref(), rig, observer)
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
        ) => Refusal::EndsAgain { reason },
        (None, Outcome::Completed) => Refusal::Ended,
    }
    .into())
}

/// A run, and what became of its journal.
pub struct Recorded {
    pub record: Record,
    /// The record says one thing and the plan another.
    pub mismatch: Option<Mismatch>,
    /// Why the journal could not be kept; the run was held there.
    pub fault: Option<JournalFault>,
    /// Records in the journal, and the chain at its head.
    pub sealed: Option<(u64, String)>,
}

/// A run as its record tells it.
pub struct Replayed {
    pub record: Record,
    pub mismatch: Option<Mismatch>,
    /// What a client that drove the rig asked for and felt; None: the plan's procedures drove it.
    pub steps: Option<Vec<DrivenStep>>,
}

fn perform<'rig>(
    rig: Option<&'rig mut dyn Rig>,
    observer: &mut dyn Observer,
    state: State<'rig>,
    runs: impl FnOnce(&mut dyn Rig, &mut dyn Observer, &RefCell<State<'rig>>) -> Record,
) -> Recorded {
    let state = Rc::new(RefCell::new(state));
    let mut rig = TapedRig::new(rig, Rc::clone(&state));
    let mut observer = TapedObserver::new(observer, Rc::clone(&state));
    let mut record = runs(&mut rig, &mut observer, &state);
    let mut state = state.borrow_mut();
    if record.outcome == Outcome::Completed
        && state.mismatch().is_none()
        && state.next_kind().is_some()
    {
        // What is on record beyond the plan's end belongs to another plan.
        let reason = state.disagrees("its end".to_owned()).to_string();
        record.outcome = Outcome::Faulted { reason };
    }
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

/// Resumptions and amendments are events of the record, each where it happened.
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

/// Writes what a run starts from: the header, and the texts of its files.
///
/// # Errors
/// It cannot be written.
pub fn begin(journal: &mut Journal, header: &Header, texts: &[String]) -> Result<(), JournalFault> {
    journal.append(EntryKind::Header, header)?;
    append_texts(journal, texts)?;
    journal.promise()
}

/// Writes that something else holds from here on, and its texts.
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
    journal.promise()
}

fn append_texts(journal: &mut Journal, texts: &[String]) -> Result<(), JournalFault> {
    PlanBody::parts_of(texts)
        .iter()
        .try_for_each(|part| journal.append(EntryKind::Plan, part))
}
