//! An observer that several borrow in turn. In: the observer in a cell. Out: an observer.

use std::cell::RefCell;

use super::{Inspection, Motion, Next, Observer, StepReport};
use psd_plan::record::Event;

/// An observer that is also asked while no run is active: before a replayed run is resumed.
pub struct Shared<'a, O>(pub &'a RefCell<O>);

impl<O: Observer> Observer for Shared<'_, O> {
    fn procedure_started(&mut self, name: &str, keyword: &str, steps: Option<u64>) {
        self.0.borrow_mut().procedure_started(name, keyword, steps);
    }

    fn step_done(&mut self, report: &StepReport) {
        self.0.borrow_mut().step_done(report);
    }

    fn studying(&mut self, done: usize, of: usize) {
        self.0.borrow_mut().studying(done, of);
    }

    fn procedure_finished(&mut self, name: &str) {
        self.0.borrow_mut().procedure_finished(name);
    }

    fn stop_requested(&self) -> bool {
        self.0.borrow().stop_requested()
    }

    fn inspect(&mut self, note: &str) -> Inspection {
        self.0.borrow_mut().inspect(note)
    }

    fn release(&mut self, note: &str, motion: &Motion) -> Inspection {
        self.0.borrow_mut().release(note, motion)
    }

    fn may_unload(&mut self, question: &str, motion: &Motion) -> Option<Inspection> {
        self.0.borrow_mut().may_unload(question, motion)
    }

    fn next(&mut self) -> Next {
        self.0.borrow_mut().next()
    }

    fn event(&mut self, event: &Event) {
        self.0.borrow_mut().event(event);
    }
}
