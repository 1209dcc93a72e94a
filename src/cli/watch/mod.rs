//! Watching a run: the live screen on a terminal, a bar on one that is too small, plain lines in a pipe; who answers at
//! an inspection; signals. In: what the run tells its observer. Out: answers and wishes.

mod asking;
mod plain;
mod signals;

use std::cell::RefCell;

use super::screen::{self, Screen};
use super::settings::Settings;
use crate::plan::Plan;
use crate::record::Event;
use crate::rig::{Live, Wish};
use crate::run::{Inspection, Next, Observer, StepReport};
use asking::Person;
pub use asking::{next_line, typed_lines};
use plain::{Bar, Lines};
pub use signals::{Signals, catch_full_files, interrupt};

/// The observer of `psd run`.
pub struct Watcher {
    face: Face,
    asking: Asking,
    operator: Option<String>,
    wish: Wish,
    /// Whether the end was wanted already when it was first asked whether to unload.
    wanted_end: Option<bool>,
    _signals: Signals,
}

/// What the person sees.
#[expect(clippy::large_enum_variant, reason = "a run has one")]
enum Face {
    Screen(Screen),
    Bar(Bar),
    Lines(Lines),
}

/// Who answers at an inspection.
enum Asking {
    /// `--yes`
    Yes,
    /// A person at the screen.
    Screen,
    /// A person who types lines.
    Person(Person),
    /// No terminal, and nothing real moves.
    NobodyNeeded,
    /// No terminal, and a real rig waits for an answer that cannot come.
    Nobody,
}

/// What the command line says of the person.
#[derive(Clone, Debug, Default)]
pub struct Attendance {
    /// `--yes`
    pub yes: bool,
    /// `--operator`
    pub operator: Option<String>,
}

impl Watcher {
    /// Watches a run on a simulated or a real rig. Keys and signals become the wish of `signals`, which a rig that can hold in
    /// the middle of a step is given too.
    pub fn new(settings: Settings, attendance: &Attendance, plan: &Plan, simulated: bool, signals: Signals) -> Self {
        Self::watching(settings, attendance, plan, simulated, signals, true)
    }

    /// Watches in lines, also on a terminal: a client drives, and there is no procedure to draw.
    pub fn in_lines(settings: Settings, attendance: &Attendance, plan: &Plan, simulated: bool, signals: Signals) -> Self {
        Self::watching(settings, attendance, plan, simulated, signals, false)
    }

    fn watching(
        settings: Settings,
        attendance: &Attendance,
        plan: &Plan,
        simulated: bool,
        signals: Signals,
        drawn: bool,
    ) -> Self {
        let wish = signals.wish().clone();
        let named = plan.particulars.iter().find(|(field, _)| *field == "operator").map(|(_, name)| name.clone());
        let operator = attendance.operator.clone().or(named).filter(|name| !name.trim().is_empty());
        let face = if drawn && settings.can_ask && settings.unicode && screen::is_large_enough() {
            Face::Screen(Screen::new(plan, simulated, operator.clone(), wish.clone(), settings.color))
        } else if drawn && settings.stderr_terminal {
            Face::Bar(Bar::new(settings.unicode))
        } else {
            Face::Lines(Lines::default())
        };
        let asking = match (attendance.yes, settings.can_ask, simulated, &face) {
            (true, ..) => Asking::Yes,
            (false, true, _, Face::Screen(_)) => Asking::Screen,
            (false, true, ..) => Asking::Person(Person::default()),
            (false, false, true, _) => Asking::NobodyNeeded,
            (false, false, false, _) => Asking::Nobody,
        };
        if !matches!(face, Face::Screen(_)) {
            signals.told_in_lines(settings.stderr_terminal);
        }
        Self { face, asking, operator, wish, wanted_end: None, _signals: signals }
    }

    /// Shows the numbers of this rig as it reads them, where there is a screen.
    pub fn watch(&self, live: Live) {
        if let Face::Screen(screen) = &self.face {
            screen.watch(live);
        }
    }

    /// Takes screen and bar off the terminal.
    pub fn finish(&mut self) {
        match &mut self.face {
            Face::Screen(screen) => screen.finish(),
            Face::Bar(bar) => bar.clear(),
            Face::Lines(_) => {}
        }
    }

    fn face(&mut self) -> &mut dyn Observer {
        match &mut self.face {
            Face::Screen(screen) => screen,
            Face::Bar(bar) => bar,
            Face::Lines(lines) => lines,
        }
    }
}

impl Observer for Watcher {
    fn procedure_started(&mut self, name: &str, keyword: &str, steps: Option<u64>) {
        self.face().procedure_started(name, keyword, steps);
    }

    fn step_done(&mut self, report: &StepReport) {
        self.face().step_done(report);
    }

    fn studying(&mut self, done: usize, of: usize) {
        self.face().studying(done, of);
    }

    fn procedure_finished(&mut self, name: &str) {
        self.face().procedure_finished(name);
    }

    fn stop_requested(&self) -> bool {
        self.wish.wants_end()
    }

    fn inspect(&mut self, note: &str) -> Inspection {
        let by = self.operator.clone();
        match &mut self.asking {
            Asking::Yes => Inspection::GoOn { note: Some("answered by --yes".to_owned()), by },
            Asking::NobodyNeeded => {
                Inspection::GoOn { note: Some("nobody was asked: simulated rig, no terminal".to_owned()), by: None }
            }
            Asking::Nobody => {
                Inspection::Stop { reason: "nobody to ask at an inspection: no terminal, and no --yes".to_owned(), by: None }
            }
            Asking::Screen => self.face().inspect(note),
            Asking::Person(person) => {
                if let Face::Bar(bar) = &mut self.face {
                    bar.clear();
                }
                person.ask(note, &mut self.operator)
            }
        }
    }

    fn may_unload(&mut self, question: &str) -> Option<Inspection> {
        let wanted_end = *self.wanted_end.get_or_insert(self.wish.wants_end());
        // Ctrl-C at this question is no yes.
        if !self.wish.may_ask() || !wanted_end && self.wish.wants_end() {
            return None;
        }
        match &mut self.asking {
            Asking::Yes | Asking::NobodyNeeded | Asking::Nobody => None,
            Asking::Screen => self.face().may_unload(question),
            Asking::Person(person) => {
                if let Face::Bar(bar) = &mut self.face {
                    bar.clear();
                }
                person.ask_to_unload(question, &mut self.operator)
            }
        }
    }

    fn next(&mut self) -> Next {
        self.face().next()
    }

    fn event(&mut self, event: &Event) {
        self.face().event(event);
    }
}

/// A watcher that is also asked while nothing runs: before a record that was played is gone on with.
pub struct Shared<'a>(pub &'a RefCell<Watcher>);

impl Observer for Shared<'_> {
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

    fn may_unload(&mut self, question: &str) -> Option<Inspection> {
        self.0.borrow_mut().may_unload(question)
    }

    fn next(&mut self) -> Next {
        self.0.borrow_mut().next()
    }

    fn event(&mut self, event: &Event) {
        self.0.borrow_mut().event(event);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::testing::empty_plan;

    #[test]
    fn a_real_rig_stops_where_nobody_can_be_asked() {
        let settings = Settings::PLAIN;
        let mut plan = empty_plan();
        plan.particulars.push(("operator", "A. Engineer".to_owned()));
        let ask = |yes, simulated| {
            let attendance = Attendance { yes, operator: None };
            let signals = Signals::caught(&Wish::default()).unwrap();
            Watcher::new(settings, &attendance, &plan, simulated, signals).inspect("look")
        };
        assert!(matches!(ask(false, false), Inspection::Stop { .. }));
        let yes = Inspection::GoOn { note: Some("answered by --yes".to_owned()), by: Some("A. Engineer".to_owned()) };
        assert_eq!(ask(true, false), yes);
        assert!(matches!(ask(false, true), Inspection::GoOn { by: None, .. }));
    }
}
