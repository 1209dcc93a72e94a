//! A rig that a client drives, behind the guard. In: the client's requests, one after the other. Out: the reading after each, events, and
//! a summary of the requests. It knows no protocol.
//!
//! Every action of a protocol on the rig uses [`Specimen`], which reports it to the observer first. The logged requests are repeated
//! through `Specimen::carry_out`. They make the same calls to the guard and the rig again.

use std::time::Duration;

use crate::run::stop::Stop;
use crate::run::{Observer, StepReport};
use psd_plan::record::remote::{Disconnect, DrivenStep, Request};
use psd_plan::record::{Event, EventKind, Outcome};
use psd_rig::{Guard, RigFault};

/// Summary of a session, SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Driven {
    /// Number of executed moves.
    pub targets: u64,
    /// Number of targets that were refused because of a limit.
    pub refused: u64,
    /// Largest abs(displacement) that was read \[m\].
    pub displacement: f64,
    /// Largest abs(force) that was read \[N\].
    pub force: f64,
}

/// Displacement \[m\] and force \[N\] of every axis, settled and inside the limits.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Feedback {
    pub displacement: Vec<f64>,
    pub force: Vec<f64>,
}

/// The specimen on a rig, behind its guard: an entry for every axis.
pub struct Specimen<'session, 'rig> {
    guard: &'session mut Guard<'rig>,
    observer: &'session mut dyn Observer,
    /// A real rig must be polled at least this often.
    beat: Option<Duration>,
    clock: &'session dyn Fn() -> f64,
    /// When the rig was polled last, by the clock \[s\].
    heard: f64,
    feedback: Feedback,
    driven: Driven,
    pub(super) steps: Vec<DrivenStep>,
    commits: u64,
    pub(super) events: Vec<Event>,
    /// How the worst session ended, and why.
    worst: Option<(Disconnect, String)>,
    /// Whether a client is connected.
    inside: bool,
    closed: bool,
}

impl<'session, 'rig> Specimen<'session, 'rig> {
    /// `beat`: for a rig that must be polled at least this often. `clock`: seconds since a fixed moment.
    pub fn new(
        guard: &'session mut Guard<'rig>,
        observer: &'session mut dyn Observer,
        beat: Option<Duration>,
        clock: &'session dyn Fn() -> f64,
    ) -> Self {
        Self {
            guard,
            observer,
            beat,
            clock,
            heard: clock(),
            feedback: Feedback::default(),
            driven: Driven::default(),
            steps: Vec::new(),
            commits: 0,
            events: Vec::new(),
            worst: None,
            inside: false,
            closed: false,
        }
    }

    /// The last reading.
    pub const fn feedback(&self) -> &Feedback {
        &self.feedback
    }

    /// Number of axes, each with its load cell.
    pub fn degrees_of_freedom(&self) -> usize {
        self.guard.commanded().len()
    }

    /// Summary of the present client, or of the last one.
    pub const fn driven(&self) -> Driven {
        self.driven
    }

    /// The last executed targets \[m\].
    pub fn commanded(&self) -> &[f64] {
        self.guard.commanded()
    }

    /// The targets on the path to `targets`, in increments inside the limit.
    pub fn increments_to(&self, targets: &[f64]) -> Vec<Vec<f64>> {
        self.guard.increments_to(targets)
    }

    /// Seconds since a fixed moment, by the clock of the session.
    pub fn now(&self) -> f64 {
        (self.clock)()
    }

    /// Rig time \[s\].
    pub fn time(&self) -> f64 {
        self.guard.time()
    }

    /// Longest single wait for a client, at most `longest`.
    pub fn wait(&self, longest: Duration) -> Duration {
        self.beat.map_or(longest, |beat| {
            beat.clamp(Duration::from_millis(1), longest)
        })
    }

    /// Admits a client, and reads the present position of the rig.
    ///
    /// # Errors
    /// It cannot be read, or is outside a limit.
    pub fn come(&mut self, client: String) -> Result<(), RigFault> {
        self.asked(&Request::Come { client });
        self.driven = Driven::default();
        self.inside = true;
        self.read_feedback()
    }

    /// Checks the targets of all axes \[m\] and prepares them; nothing moves. A refusal of one refuses all.
    ///
    /// # Errors
    /// A limit is exceeded, or the rig refuses.
    pub fn propose(&mut self, targets: &[f64]) -> Result<(), RigFault> {
        self.propose_at(targets, None)
    }

    /// [`Self::propose`] at a speed \[m/s\]; None: the rig's own.
    ///
    /// # Errors
    /// As for [`Self::propose`]; or the speed is outside its limit.
    pub fn propose_at(&mut self, targets: &[f64], speed: Option<f64>) -> Result<(), RigFault> {
        self.asked(&Request::targets_at(targets, speed));
        let proposed = self.guard.propose(targets, speed);
        if matches!(proposed, Err(RigFault::LimitBreached { .. })) {
            self.driven.refused += 1;
        }
        self.note_fault(proposed)
    }

    /// Executes the proposal, settles and reads.
    ///
    /// # Errors
    /// The rig fails, or the reading is outside a limit.
    pub fn execute(&mut self) -> Result<(), RigFault> {
        self.asked(&Request::Execute);
        let executed = self.guard.execute();
        self.note_fault(executed)?;
        self.driven.targets += 1;
        self.read_feedback()?;
        let step = self.steps.len() as u64 + 1;
        let (time, command) = (self.time(), self.commanded().to_vec());
        let Feedback {
            displacement,
            force,
        } = self.feedback.clone();
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
        // At rest, as always when a client sends a request.
        let report = StepReport {
            speed: self.guard.speed(),
            ..StepReport::of_readings(
                self.commits,
                self.guard.time(),
                self.guard.commanded(),
                &self.feedback.displacement,
                &self.feedback.force,
            )
        };
        // A client without any reading has done no step.
        if !report.axes.is_empty() {
            self.observer.step_done(&report);
        }
    }

    /// Reads again.
    ///
    /// # Errors
    /// The rig fails, or the reading is outside a limit.
    pub fn read(&mut self) -> Result<(), RigFault> {
        self.asked(&Request::Read);
        self.read_feedback()
    }

    /// Discards the proposal, stops all motion and keeps the load.
    pub fn hold(&mut self) {
        self.asked(&Request::Hold);
        self.guard.hold();
    }

    /// A remark for the run log.
    pub fn remark(&mut self, text: String) {
        self.asked(&Request::Remark { text: text.clone() });
        self.event(EventKind::Note, text);
    }

    /// The client has disconnected; the rig holds.
    pub fn leave(&mut self, disconnect: Disconnect, reason: String) {
        self.asked(&Request::Leave {
            disconnect,
            reason: reason.clone(),
        });
        self.guard.hold();
        self.inside = false;
        self.event(EventKind::Note, format!("session ended: {reason}"));
        if self
            .worst
            .as_ref()
            .is_none_or(|(worst, _)| *worst < disconnect)
        {
            self.worst = Some((disconnect, reason));
        }
    }

    /// No further client is served.
    pub fn close(&mut self) {
        self.asked(&Request::Close);
        self.closed = true;
    }

    /// Polls the rig if that is due: while a client is silent, and while it sends other messages.
    ///
    /// # Errors
    /// The rig fails, or is outside a limit.
    pub fn listen(&mut self) -> Result<(), RigFault> {
        let due = |beat: &Duration| self.now() - self.heard >= beat.as_secs_f64();
        let Some(beat) = self.beat.filter(due) else {
            return Ok(());
        };
        self.stay(beat)
    }

    /// Repeats one logged request. Its result is logged too.
    pub(crate) fn carry_out(&mut self, request: Request) {
        // The event of a refusal is logged, and the reaction of the client is in the requests that follow.
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
            Request::Leave { disconnect, reason } => {
                self.leave(disconnect, reason);
                Ok(())
            }
            Request::Close => {
                self.close();
                Ok(())
            }
        };
    }

    /// A wait that failed in the run log fails again.
    pub(crate) fn repeat_stay(&mut self) {
        let _ = self.stay(Duration::from_millis(1));
    }

    fn stay(&mut self, seconds: Duration) -> Result<(), RigFault> {
        let stayed = self.guard.pause(seconds.as_secs_f64());
        self.heard = self.now();
        self.note_fault(stayed)
    }

    fn read_feedback(&mut self) -> Result<(), RigFault> {
        let read = self.guard.read();
        self.heard = self.now();
        let reading = self.note_fault(read)?;
        let largest = |values: &[f64], so_far: f64| {
            values
                .iter()
                .fold(so_far, |largest, value| largest.max(value.abs()))
        };
        self.driven.displacement = largest(&reading.displacement, self.driven.displacement);
        self.driven.force = largest(&reading.force, self.driven.force);
        self.feedback = Feedback {
            displacement: reading.displacement,
            force: reading.force,
        };
        Ok(())
    }

    fn asked(&mut self, request: &Request) {
        self.observer.asked(request);
    }

    /// Adds a fault to the events of the record.
    fn note_fault<T>(&mut self, result: Result<T, RigFault>) -> Result<T, RigFault> {
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

    /// The outcome of an interrupted run log is a fault.
    pub(super) fn outcome(&self) -> Outcome {
        let cut_off = |position: &str| Outcome::Faulted {
            reason: format!("the run log ends {position}"),
        };
        match &self.worst {
            _ if self.inside => cut_off("during a session"),
            _ if !self.closed => cut_off("before the next client"),
            None | Some((Disconnect::Closed, _)) => Outcome::Completed,
            Some((Disconnect::Stopped, reason)) => Outcome::Aborted {
                reason: reason.clone(),
            },
            Some((Disconnect::Failed, reason)) => Outcome::Faulted {
                reason: reason.clone(),
            },
        }
    }
}
