//! The recorded observer: steps are compared with the run log as long as it has entries, and logged after it. The answers
//! of the operator come from the run log, and no question is asked twice.

use std::cell::RefCell;
use std::rc::Rc;

use super::entry::{AxisBody, OperatorBody, OperatorEntry, StepBody};
use super::state::State;
use crate::run::{AxisReport, Inspection, Motion, Next, Observer, Request, StepReport};
use psd_plan::record::Event;
use psd_rig::journal::EntryKind;

/// An observer of a run whose answers are all logged.
pub struct RecordedObserver<'run, 'rig> {
    inner: &'run mut dyn Observer,
    state: Rc<RefCell<State<'rig>>>,
    /// Whether the last question to the operator has no answer yet.
    inspecting: bool,
    /// The present procedure.
    procedure: Option<String>,
}

impl<'run, 'rig> RecordedObserver<'run, 'rig> {
    pub(super) fn new(inner: &'run mut dyn Observer, state: Rc<RefCell<State<'rig>>>) -> Self {
        Self {
            inner,
            state,
            inspecting: false,
            procedure: None,
        }
    }

    /// Whether answers still come from the run log.
    fn answers_from_the_log(&self) -> bool {
        self.state.borrow_mut().answers_from_the_log()
    }

    /// Appends an entry, if the run is live. A run log that fails stops the run at the next call on the rig.
    fn append(&self, kind: EntryKind, body: &impl serde::Serialize) {
        let mut state = self.state.borrow_mut();
        if state.can_continue() {
            let _ = state.append(kind, body);
        }
    }

    /// Appends a statement of the operator or a client, with the time of day.
    fn append_operator(&self, statement: OperatorBody) {
        let wall = self.state.borrow().wall();
        self.append(EntryKind::Operator, &OperatorEntry { statement, wall });
    }

    /// A run log with an END is complete: a call after its last entry means that an entry was removed.
    fn beyond_the_end(&self, called: &str) -> bool {
        let mut state = self.state.borrow_mut();
        let beyond = state.is_at_the_logged_end();
        if beyond {
            state.report_mismatch(called.to_owned());
        }
        beyond
    }
}

impl Observer for RecordedObserver<'_, '_> {
    fn procedure_started(&mut self, name: &str, keyword: &str, steps: Option<u64>) {
        self.procedure = Some(name.to_owned());
        self.inner.procedure_started(name, keyword, steps);
    }

    fn step_done(&mut self, report: &StepReport) {
        self.inspecting = false;
        if self.state.borrow().digests() {
            // A fault stops the run at its next call on the rig.
            let _ = self
                .state
                .borrow_mut()
                .add_to_digest("the end of a step", |digest| digest.step(report));
            self.inner.step_done(report);
            return;
        }
        let step = StepBody::of(report);
        if self.answers_from_the_log() {
            let mut state = self.state.borrow_mut();
            if let Ok(recorded) = state.peek::<StepBody>(EntryKind::Step, "the end of a step") {
                if recorded.same(&step) {
                    state.consume();
                } else {
                    let called = serde_json::to_string(&step).unwrap_or_default();
                    state.report_mismatch(called);
                }
            }
        } else if !self.beyond_the_end("another step") {
            self.append(EntryKind::Step, &step);
        }
        self.inner.step_done(report);
    }

    fn procedure_finished(&mut self, name: &str) {
        self.inner.procedure_finished(name);
    }

    fn studying(&mut self, done: usize, of: usize) {
        self.inner.studying(done, of);
    }

    fn event(&mut self, event: &Event) {
        if self.answers_from_the_log() {
            let mut state = self.state.borrow_mut();
            if let Ok(recorded) = state.peek::<Event>(EntryKind::Event, &event.text) {
                if recorded == *event {
                    state.consume();
                } else {
                    state.report_mismatch(event.text.clone());
                }
            }
        } else if !self.beyond_the_end(&event.text) {
            self.append(EntryKind::Event, event);
        }
        self.inner.event(event);
    }

    fn asked(&mut self, request: &Request) {
        if self.answers_from_the_log() {
            let mut state = self.state.borrow_mut();
            match state.peek(EntryKind::Operator, "a request of the client") {
                Ok(OperatorBody::Asked { request: recorded }) if recorded == *request => {
                    state.consume();
                }
                Ok(_) => {
                    let asked = serde_json::to_string(request).unwrap_or_default();
                    state.report_mismatch(format!("the request {asked}"));
                }
                Err(_) => {}
            }
        } else if !self.beyond_the_end("a request of the client") {
            self.append_operator(OperatorBody::Asked {
                request: request.clone(),
            });
        }
        self.inner.asked(request);
    }

    fn stop_requested(&self) -> bool {
        if self.answers_from_the_log() {
            let mut state = self.state.borrow_mut();
            let asked = state.next_kind() == Some(EntryKind::Operator)
                && match state.peek(EntryKind::Operator, "a request to stop") {
                    Ok(OperatorBody::AskedToStop) => !self.inspecting,
                    Ok(OperatorBody::AskedToStopInspecting) => self.inspecting,
                    _ => false,
                };
            if asked {
                state.consume();
            }
            return asked;
        }
        let asked = self.inner.stop_requested();
        if asked {
            let asked = if self.inspecting {
                OperatorBody::AskedToStopInspecting
            } else {
                OperatorBody::AskedToStop
            };
            self.append_operator(asked);
        }
        asked
    }

    fn next(&mut self) -> Next {
        if self.answers_from_the_log() {
            let mut state = self.state.borrow_mut();
            return match state.next_kind() {
                _ if state.mismatch().is_some() => Next::GoOn,
                Some(EntryKind::Operator) => match state.peek(EntryKind::Operator, "a note") {
                    Ok(OperatorBody::Noted { text }) => {
                        state.consume();
                        Next::Record(text)
                    }
                    // The operator had paused the run before the stop.
                    Ok(OperatorBody::AskedToStop) => Next::Wait,
                    _ => Next::GoOn,
                },
                Some(EntryKind::Fault)
                    if state.front_is_pause_fault_in(self.procedure.as_deref()) =>
                {
                    Next::Wait
                }
                _ => Next::GoOn,
            };
        }
        if !self.state.borrow().can_continue() {
            return Next::GoOn;
        }
        let next = self.inner.next();
        if let Next::Record(text) = &next {
            self.append_operator(OperatorBody::Noted { text: text.clone() });
        }
        next
    }

    fn may_unload(&mut self, question: &str, motion: &Motion) -> Option<Inspection> {
        if self.answers_from_the_log() {
            let mut state = self.state.borrow_mut();
            return match state.next_kind() {
                Some(EntryKind::Fault) if state.front_is_pause_fault() => Some(Inspection::Wait),
                Some(EntryKind::Operator) => match state.peek(EntryKind::Operator, question) {
                    Ok(OperatorBody::AnsweredToUnload {
                        question: asked,
                        answer,
                    }) if asked == question => {
                        state.consume();
                        Some(answer)
                    }
                    _ => None,
                },
                _ => None,
            };
        }
        let answer = self
            .state
            .borrow()
            .can_continue()
            .then(|| self.inner.may_unload(question, motion))
            .flatten()?;
        if answer != Inspection::Wait {
            self.append_operator(OperatorBody::AnsweredToUnload {
                question: question.to_owned(),
                answer: answer.clone(),
            });
        }
        Some(answer)
    }

    fn inspect(&mut self, note: &str) -> Inspection {
        self.answer(note, |observer| observer.inspect(note))
    }

    fn release(&mut self, note: &str, motion: &Motion) -> Inspection {
        self.answer(note, |observer| observer.release(note, motion))
    }
}

impl RecordedObserver<'_, '_> {
    /// The operator's answer to `note`: from the run log, otherwise from `ask`.
    fn answer(
        &mut self,
        note: &str,
        ask: impl FnOnce(&mut dyn Observer) -> Inspection,
    ) -> Inspection {
        if self.answers_from_the_log() {
            let mut state = self.state.borrow_mut();
            if state.front_is_pause_fault() {
                return Inspection::Wait;
            }
            let answer = match state.peek(EntryKind::Operator, "an answer") {
                Ok(OperatorBody::Answered {
                    note: asked,
                    answer,
                }) if asked == note => {
                    state.consume();
                    answer
                }
                Ok(OperatorBody::AskedToStopInspecting) => Inspection::Wait,
                Ok(_) => stopped(
                    state
                        .report_mismatch(format!("an answer to `{note}`"))
                        .to_string(),
                ),
                Err(fault) => stopped(fault.to_string()),
            };
            drop(state);
            self.inspecting = answer == Inspection::Wait;
            return answer;
        }
        if !self.state.borrow().can_continue() {
            return stopped(super::state::ended().to_string());
        }
        let answer = ask(self.inner);
        self.inspecting = answer == Inspection::Wait;
        if answer != Inspection::Wait {
            self.append_operator(OperatorBody::Answered {
                note: note.to_owned(),
                answer: answer.clone(),
            });
        }
        answer
    }
}

fn stopped(reason: String) -> Inspection {
    Inspection::Stop { reason, by: None }
}

impl StepBody {
    /// The run log has the first axis beside the step.
    fn of(report: &StepReport) -> Self {
        let (first, others) = (report.axes[0], &report.axes[1..]);
        Self {
            step: report.step,
            time: report.time,
            u: first.command,
            x: first.displacement,
            v: first.velocity,
            a: first.acceleration,
            r: first.force,
            e: report.energy_error.filter(|error| error.is_finite()),
            axes: others.iter().map(AxisBody::of).collect(),
        }
    }

    /// Compares bit by bit.
    fn same(&self, other: &Self) -> bool {
        let numbers = |body: &Self| {
            [
                Some(body.time),
                Some(body.u),
                Some(body.x),
                body.v,
                body.a,
                Some(body.r),
                body.e,
            ]
            .map(|value| value.map(f64::to_bits))
        };
        let others = |body: &Self| {
            body.axes
                .iter()
                .flat_map(AxisBody::bits)
                .collect::<Vec<u64>>()
        };
        self.step == other.step && numbers(self) == numbers(other) && others(self) == others(other)
    }
}

impl AxisBody {
    pub(super) fn of(axis: &AxisReport) -> Self {
        Self {
            u: axis.command,
            x: axis.displacement,
            v: axis.velocity.unwrap_or(0.0),
            a: axis.acceleration.unwrap_or(0.0),
            r: axis.force,
        }
    }

    fn bits(&self) -> [u64; 5] {
        [self.u, self.x, self.v, self.a, self.r].map(f64::to_bits)
    }
}
