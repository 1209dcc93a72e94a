//! The operator of a session. In: the questions of psd. Out: the drawn answers. What the operator releases, the witness knows.

use std::cell::Cell;

use super::case::Operator as Answers;
use super::laws::Released;
use super::world::World;
use crate::run::{Inspection, Motion, Next, Observer};
use psd_plan::record::Event;
use psd_rig::StopRequest;

pub(super) struct Operator {
    answers: Answers,
    /// The motion of the plan in force.
    plan: Released,
    world: World,
    stop_request: StopRequest,
    waits: Cell<u8>,
    noted: bool,
}

impl Operator {
    pub(super) const fn new(
        answers: Answers,
        plan: Released,
        world: World,
        stop_request: StopRequest,
    ) -> Self {
        Self {
            answers,
            plan,
            world,
            stop_request,
            waits: Cell::new(answers.waits),
            noted: false,
        }
    }

    fn answer(&self, agrees: bool) -> Inspection {
        if self.waits.get() > 0 {
            self.waits.set(self.waits.get() - 1);
            return Inspection::Wait;
        }
        self.waits.set(self.answers.waits);
        let by = Some("A. Operator".to_owned());
        if agrees {
            Inspection::GoOn { note: None, by }
        } else {
            let reason = "not now".to_owned();
            Inspection::Stop { reason, by }
        }
    }
}

impl Observer for Operator {
    fn stop_requested(&self) -> bool {
        self.stop_request.end_requested()
    }

    fn inspect(&mut self, _: &str) -> Inspection {
        self.answer(self.answers.goes_on)
    }

    fn release(&mut self, _: &str, _: &Motion) -> Inspection {
        let answer = self.answer(self.answers.releases);
        if matches!(answer, Inspection::GoOn { .. }) {
            self.world.lock().witness.released = Some(self.plan.clone());
        }
        answer
    }

    fn may_unload(&mut self, _: &str, _: &Motion) -> Option<Inspection> {
        Some(self.answer(self.answers.unloads))
    }

    fn next(&mut self) -> Next {
        if self.answers.notes && !std::mem::replace(&mut self.noted, true) {
            return Next::Record("a crack".to_owned());
        }
        self.noted = false;
        Next::GoOn
    }

    fn event(&mut self, _: &Event) {}
}
