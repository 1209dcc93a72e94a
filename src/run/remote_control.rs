//! A rig that a client drives, behind the guard. In: the client's requests, one after the other. Out: the reading after
//! each, events, and what was asked of the specimen in all. It knows no protocol.
//!
//! Everything that a protocol does to the rig goes through [`Specimen`], which tells the observer first. So the record of
//! the requests, played back through `Specimen::carry_out`, asks the guard and the rig for the same again.

pub(crate) use std::time::{Duration, Instant};

use crate::plan::{DriftCheck, Plan, ZeroAfter};
use crate::record::remote::{DrivenStep, Parting, Request};
use crate::record::{Drift, Event, EventKind, Outcome, Record};
use crate::rig::{Guard, Rig, RigFault};
use crate::run::pretest_check;
use crate::run::session::Session;
use crate::run::stop::Stop;
use crate::run::{AxisReport, Observer, StepReport, zero_drift};

/// What a session asked of the specimen, SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Driven {
    /// Moves carried out.
    pub targets: u64,
    /// Targets that a limit stood in the way of.
    pub refused: u64,
    /// Largest |displacement| read, m.
    pub displacement: f64,
    /// Largest |force| read, N.
    pub force: f64,
}

/// Displacement (m) and force (N) of every axis, settled and inside the limits.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Felt {
    pub displacement: Vec<f64>,
    pub force: Vec<f64>,
}

/// What stands on a rig, behind its guard: an entry for every axis.
pub struct Specimen<'session, 'rig> {
    guard: &'session mut Guard<'rig>,
    observer: &'session mut dyn Observer,
    /// A real rig must be heard from at least this often.
    beat: Option<Duration>,
    heard: Instant,
    felt: Felt,
    driven: Driven,
    steps: Vec<DrivenStep>,
    commits: u64,
    events: Vec<Event>,
    /// How the worst session ended, and why.
    worst: Option<(Parting, String)>,
    /// A client is there.
    inside: bool,
    closed: bool,
}

/// What a driven rig leaves.
pub struct DrivenRecord {
    pub record: Record,
    pub steps: Vec<DrivenStep>,
}

/// Who drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driver {
    /// A program: a real rig must have passed the gate first.
    Client,
    /// A person by hand, who says yes to every move; there may be no specimen yet to pass a gate with.
    ByHand,
}

/// Lets `client` drive the plan's rig. Never fails: what went wrong is the record's outcome.
#[must_use]
pub fn drive(
    plan: &Plan,
    rig: &mut dyn Rig,
    observer: &mut dyn Observer,
    driver: Driver,
    client: &mut dyn FnMut(&mut Specimen<'_, '_>),
) -> DrivenRecord {
    let identity = rig.identity();
    let ended = |events, outcome| DrivenRecord {
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
    // By hand there may be no specimen yet, and a place to go back to neither.
    let check = plan.rig.drift.filter(|_| driver == Driver::Client);
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
    let mut specimen = Specimen::new(guard, observer, beat);
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
    let DrivenRecord { record, .. } = ended(session.finish(), outcome);
    DrivenRecord {
        steps,
        record: Record { drift, ..record },
    }
}

/// The zeros after the last client, as after a test. Whoever ended the serving wants the rig held where it is: then nothing moves,
/// and they are not read.
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

/// What a real rig does once it has proved itself.
fn afterwards(plan: &Plan) -> &'static str {
    match plan.rig.drift {
        Some(DriftCheck {
            after: ZeroAfter::Start,
            ..
        }) => {
            "as its client says, within the plan's limits, and after the last client back to where it began"
        }
        _ => "as its client says, within the plan's limits",
    }
}

impl<'session, 'rig> Specimen<'session, 'rig> {
    /// With `beat`, a rig that must be heard from at least so often.
    pub fn new(
        guard: &'session mut Guard<'rig>,
        observer: &'session mut dyn Observer,
        beat: Option<Duration>,
    ) -> Self {
        Self {
            guard,
            observer,
            beat,
            heard: Instant::now(),
            felt: Felt::default(),
            driven: Driven::default(),
            steps: Vec::new(),
            commits: 0,
            events: Vec::new(),
            worst: None,
            inside: false,
            closed: false,
        }
    }

    /// What was read last.
    pub const fn felt(&self) -> &Felt {
        &self.felt
    }

    /// Axes, each with its load cell.
    pub fn degrees_of_freedom(&self) -> usize {
        self.guard.commanded().len()
    }

    /// Of the client that is there, or was last.
    pub const fn driven(&self) -> Driven {
        self.driven
    }

    /// The last targets carried out, m.
    pub fn commanded(&self) -> &[f64] {
        self.guard.commanded()
    }

    /// The targets on the way to `targets`, none farther from the one before than the limit on an increment.
    pub fn way_to(&self, targets: &[f64]) -> Vec<Vec<f64>> {
        self.guard.way_to(targets)
    }

    /// Rig time, s.
    pub fn time(&self) -> f64 {
        self.guard.time()
    }

    /// How long one wait for a client may be, if `longest` is long enough by itself.
    pub fn wait(&self, longest: Duration) -> Duration {
        self.beat.map_or(longest, |beat| {
            beat.clamp(Duration::from_millis(1), longest)
        })
    }

    /// Takes a client, and reads where the rig stands.
    ///
    /// # Errors
    /// It cannot be read, or stands outside a limit.
    pub fn come(&mut self, client: String) -> Result<(), RigFault> {
        self.asked(&Request::Come { client });
        self.driven = Driven::default();
        self.inside = true;
        self.feel()
    }

    /// Checks the targets of all axes (m) and makes them ready; nothing moves. What stands in the way of one stands in
    /// the way of all.
    ///
    /// # Errors
    /// A limit stands in the way, or the rig refuses.
    pub fn propose(&mut self, targets: &[f64]) -> Result<(), RigFault> {
        self.propose_at(targets, None)
    }

    /// [`Self::propose`] at a speed, m/s; None: the rig's own.
    ///
    /// # Errors
    /// As there; or the speed is beyond its limit.
    pub fn propose_at(&mut self, targets: &[f64], speed: Option<f64>) -> Result<(), RigFault> {
        self.asked(&Request::targets_at(targets, speed));
        let proposed = self.guard.propose(targets, speed);
        if matches!(proposed, Err(RigFault::LimitBreached { .. })) {
            self.driven.refused += 1;
        }
        self.told(proposed)
    }

    /// Carries out what was proposed, settles and reads.
    ///
    /// # Errors
    /// The rig fails, or the reading lies outside a limit.
    pub fn execute(&mut self) -> Result<(), RigFault> {
        self.asked(&Request::Execute);
        let executed = self.guard.execute();
        self.told(executed)?;
        self.driven.targets += 1;
        self.feel()?;
        let step = self.steps.len() as u64 + 1;
        let (time, command) = (self.time(), self.commanded().to_vec());
        let Felt {
            displacement,
            force,
        } = self.felt.clone();
        self.steps.push(DrivenStep {
            step,
            time,
            command,
            displacement,
            force,
        });
        Ok(())
    }

    /// The client counts its step as done.
    pub fn commit(&mut self) {
        self.asked(&Request::Commit);
        self.commits += 1;
        let nothing = None;
        let felt = self.felt.displacement.iter().zip(&self.felt.force);
        // At rest, as it is whenever a client asks.
        let mut axes =
            self.guard
                .commanded()
                .iter()
                .zip(felt)
                .map(|(command, (displacement, force))| AxisReport {
                    command: *command,
                    displacement: *displacement,
                    force: *force,
                    velocity: 0.0,
                    acceleration: 0.0,
                });
        // A client of which nothing was ever read has done no step.
        let Some(AxisReport {
            command,
            displacement,
            force,
            ..
        }) = axes.next()
        else {
            return;
        };
        let others = axes.collect();
        self.observer.step_done(&StepReport {
            step: self.commits,
            time: self.guard.time(),
            command,
            displacement,
            velocity: nothing,
            acceleration: nothing,
            force,
            speed: self.guard.speed(),
            energy_error: nothing,
            others,
            tracking: None,
            tracking_energy_error: None,
        });
    }

    /// Reads anew.
    ///
    /// # Errors
    /// The rig fails, or the reading lies outside a limit.
    pub fn read(&mut self) -> Result<(), RigFault> {
        self.asked(&Request::Read);
        self.feel()
    }

    /// Forgets what was proposed, stops all motion and keeps the load.
    pub fn hold(&mut self) {
        self.asked(&Request::Hold);
        self.guard.hold();
    }

    /// A remark for the record.
    pub fn remark(&mut self, text: String) {
        self.asked(&Request::Remark { text: text.clone() });
        self.event(EventKind::Note, text);
    }

    /// The client is gone; the rig holds.
    pub fn leave(&mut self, parting: Parting, reason: String) {
        self.asked(&Request::Leave {
            parting,
            reason: reason.clone(),
        });
        self.guard.hold();
        self.inside = false;
        self.event(EventKind::Note, format!("session ended: {reason}"));
        if self
            .worst
            .as_ref()
            .is_none_or(|(worst, _)| *worst < parting)
        {
            self.worst = Some((parting, reason));
        }
    }

    /// Nobody is served any more.
    pub fn close(&mut self) {
        self.asked(&Request::Close);
        self.closed = true;
    }

    /// Hears the rig, where that is due: while a client is silent, and while one talks of other things than the rig.
    ///
    /// # Errors
    /// The rig fails, or stands outside a limit.
    pub fn listen(&mut self) -> Result<(), RigFault> {
        let Some(beat) = self.beat.filter(|beat| self.heard.elapsed() >= *beat) else {
            return Ok(());
        };
        self.stay(beat)
    }

    /// One request again, as the record has it. What comes of it is on record too.
    pub(crate) fn carry_out(&mut self, request: Request) {
        // A refusal has told its event, and what the client made of it are the requests that follow.
        if let Some((targets, speed)) = request.proposed() {
            let _ = self.propose_at(&targets, speed);
            return;
        }
        let _ = match request {
            Request::Propose { .. }
            | Request::ProposeAll { .. }
            | Request::ProposeAt { .. }
            | Request::ProposeNoNumber { .. } => Ok(()),
            Request::Come { client } => self.come(client),
            Request::Execute => self.execute(),
            Request::Read => self.read(),
            Request::Commit => {
                self.commit();
                Ok(())
            }
            Request::Hold => {
                self.hold();
                Ok(())
            }
            Request::Remark { text } => {
                self.remark(text);
                Ok(())
            }
            Request::Leave { parting, reason } => {
                self.leave(parting, reason);
                Ok(())
            }
            Request::Close => {
                self.close();
                Ok(())
            }
        };
    }

    /// A stay that failed in the record fails again.
    pub(crate) fn stay_again(&mut self) {
        let _ = self.stay(Duration::from_millis(1));
    }

    fn stay(&mut self, seconds: Duration) -> Result<(), RigFault> {
        let stayed = self.guard.pause(seconds.as_secs_f64());
        self.heard = Instant::now();
        self.told(stayed)
    }

    fn feel(&mut self) -> Result<(), RigFault> {
        let read = self.guard.read();
        self.heard = Instant::now();
        let reading = self.told(read)?;
        let largest = |values: &[f64], so_far: f64| {
            values
                .iter()
                .fold(so_far, |largest, value| largest.max(value.abs()))
        };
        self.driven.displacement = largest(&reading.displacement, self.driven.displacement);
        self.driven.force = largest(&reading.force, self.driven.force);
        self.felt = Felt {
            displacement: reading.displacement,
            force: reading.force,
        };
        Ok(())
    }

    fn asked(&mut self, request: &Request) {
        self.observer.asked(request);
    }

    /// A fault is an event of the record.
    fn told<T>(&mut self, result: Result<T, RigFault>) -> Result<T, RigFault> {
        if let Err(fault) = &result {
            let stop = Stop::Rig(fault.clone());
            self.event(stop.event_kind(), stop.to_string());
        }
        result
    }

    fn event(&mut self, kind: EventKind, text: String) {
        let event = Event {
            time: self.guard.time(),
            procedure: None,
            step: None,
            kind,
            text,
        };
        self.observer.event(&event);
        self.events.push(event);
    }

    /// A record that was cut off is no complete one.
    fn outcome(&self) -> Outcome {
        let cut_off = |place: &str| Outcome::Faulted {
            reason: format!("the record ends {place}"),
        };
        match &self.worst {
            _ if self.inside => cut_off("in the middle of a session"),
            _ if !self.closed => cut_off("while a client was waited for"),
            None | Some((Parting::Closed, _)) => Outcome::Completed,
            Some((Parting::Stopped, reason)) => Outcome::Aborted {
                reason: reason.clone(),
            },
            Some((Parting::Failed, reason)) => Outcome::Faulted {
                reason: reason.clone(),
            },
        }
    }
}
