//! A session in which a client drives the rig of a plan. In: the plan, the rig, the client. Out: the record, and the steps that the
//! client requested. It knows no protocol.

use std::time::Duration;

use crate::run::remote_control::Specimen;
use crate::run::session::Session;
use crate::run::stop::Stop;
use crate::run::{Observer, pretest_check, zero_drift};
use psd_plan::record::remote::DrivenStep;
use psd_plan::record::{Drift, EventKind, Outcome, Record};
use psd_plan::{DriftCheck, Plan, ZeroAfter};
use psd_rig::Rig;

/// The record and the steps of a driven rig.
pub struct ClientRunRecord {
    pub record: Record,
    pub steps: Vec<DrivenStep>,
}

/// The source of the requests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driver {
    /// A program: a real rig must have passed the pre-test check first.
    Client,
    /// The operator by hand, who confirms every move; a pre-test check may be impossible because there is no specimen yet.
    ByHand,
}

/// A client that drives a rig.
pub struct Requests<'a> {
    pub driver: Driver,
    /// Seconds since a fixed moment.
    pub clock: &'a dyn Fn() -> f64,
    pub client: &'a mut dyn FnMut(&mut Specimen<'_, '_>),
}

/// Lets the client of `requests` drive the plan's rig. Never fails: a fault is the outcome of the record.
#[must_use]
pub fn drive(
    plan: &Plan,
    rig: &mut dyn Rig,
    observer: &mut dyn Observer,
    requests: Requests<'_>,
) -> ClientRunRecord {
    let Requests {
        driver,
        clock,
        client,
    } = requests;
    let identity = rig.identity();
    let ended = |events, outcome| ClientRunRecord {
        record: Record {
            rig: identity.clone(),
            procedures: Vec::new(),
            events,
            outcome,
            drift: None,
        },
        steps: Vec::new(),
    };
    let mut session = match Session::begin(plan, rig, observer) {
        Ok(session) => session,
        Err(early) => return ended(vec![early.0], early.1.outcome()),
    };
    let link = plan.rig.link.as_real();
    if let Some(link) = link.filter(|_| driver == Driver::Client)
        && let Err(stop) = pretest_check::pass(plan, link, afterwards(plan), &mut session)
    {
        session.end(&stop);
        return ended(session.finish(), stop.outcome());
    }
    // By hand there may be no specimen yet, and no position to return to.
    let check = plan.rig.zero_drift.filter(|_| driver == Driver::Client);
    let home = session.guard.commanded().to_vec();
    let mut drift = match check
        .map(|check| zero_drift::before(check, &mut session))
        .transpose()
    {
        Ok(drift) => drift,
        Err(stop) => {
            session.end(&stop);
            return ended(session.finish(), stop.outcome());
        }
    };
    let (guard, observer, events) = session.parts();
    let beat = link.map(|link| Duration::from_secs_f64((link.watchdog / 8.0).max(0.0)));
    let mut specimen = Specimen::new(guard, observer, beat, clock);
    client(&mut specimen);
    let (mut outcome, steps) = (specimen.outcome(), std::mem::take(&mut specimen.steps));
    events.append(&mut specimen.events);
    drop(specimen);
    if let Some(drift) = &mut drift {
        drift.held = session.guard.take_held();
        if outcome == Outcome::Completed
            && let Err(stop) = once_more(drift, &home, &mut session)
        {
            session.event(stop.event_kind(), stop.to_string());
            outcome = stop.outcome();
        }
    }
    session.guard.hold();
    let ClientRunRecord { record, .. } = ended(session.finish(), outcome);
    ClientRunRecord {
        steps,
        record: Record { drift, ..record },
    }
}

/// Reads the zeros after the last client, as after a test. If a stop was requested, the rig must hold: nothing moves, and the zeros are
/// not read.
fn once_more(drift: &mut Drift, home: &[f64], session: &mut Session<'_>) -> Result<(), Stop> {
    if session.stop_if_requested().is_err() {
        session.event(
            EventKind::Note,
            "the zeros are not read again: stopped on request".to_owned(),
        );
        return Ok(());
    }
    zero_drift::after(drift, home, session)
}

/// The motion of a real rig after the pre-test check.
fn afterwards(plan: &Plan) -> &'static str {
    match plan.rig.zero_drift {
        Some(DriftCheck {
            after: ZeroAfter::Start,
            ..
        }) => {
            "MOVES as its client requests, within the plan's limits, and after the last client back to its start position"
        }
        _ => "MOVES as its client requests, within the plan's limits",
    }
}
