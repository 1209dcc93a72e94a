//! Observation of a run by the operator: live screen, progress bar or plain lines, answers at an
//! inspection, signals. In: reports of the run. Out: answers and stop requests. It does not know
//! which procedure runs.

mod plain;
mod signals;

use std::time::Instant;

use super::dialogue::Dialogue;
use super::dialogue::by_lines::Person;
use super::pace::{Pace, Part};
use super::question::{self, After, Question, QuestionKind, Stay};
use super::screen::{self, Screen};
use super::shown::Shown;
use crate::args::ScreenForm;
use crate::commands::explain_plan::dry_rig::Reach;
use crate::settings::{Settings, today};
use plain::{Bar, Lines};
use psd::report::report_status;
use psd::run::{Extent, Inspection, Motion, Next, Observer, StepReport};
use psd_plan::Plan;
use psd_plan::record::{Event, EventKind, NO_OPERATOR_ASKED};
use psd_plan::schema::plan_block::OPERATOR;
use psd_rig::{Live, StopRequest};
use psd_text::diagnostic::excerpt::escape;
pub use signals::{Signals, catch_full_files, interrupt};

/// The observer of `psd run`.
pub struct Watcher {
    face: Face,
    asking: Asking,
    stop_request: StopRequest,
    /// The expected demand of the run.
    expected: Extent,
    /// The calibrations that are overdue today.
    overdue: Vec<String>,
    /// The motion for which the rig was released.
    released: Option<Motion>,
    /// The time left.
    pace: Pace,
    /// The reason for the early end of the run.
    ended: Option<String>,
    /// The alarm that the hold of the rig is not confirmed.
    alarm: Option<String>,
    /// The live readings of a rig.
    live: Option<Live>,
    /// Number of stop requests when the operator was first asked about a rig on hold.
    stops_before: Option<u32>,
    _signals: Signals,
}

/// The display for the operator.
enum Face {
    Screen(Screen),
    Bar(Bar),
    Lines(Lines),
}

impl Face {
    /// Removes the bar from the terminal.
    fn clear(&mut self) {
        if let Self::Bar(bar) = self {
            bar.clear();
        }
    }
}

/// The source of answers at an inspection.
#[expect(clippy::large_enum_variant, reason = "a run has one")]
enum Asking {
    /// `--yes`, and the name of the operator.
    Yes(Option<String>),
    /// An operator at the screen.
    Screen,
    /// An operator who types lines.
    Person(Person),
    /// No terminal, and no real rig moves.
    NoOperatorNeeded,
    /// No terminal, and a real rig waits for an answer that cannot come.
    NoOperator,
}

/// The command-line options about the operator.
#[derive(Clone, Debug, Default)]
pub struct Attendance {
    /// `--yes`
    pub yes: bool,
    /// `--operator`
    pub operator: Option<String>,
    /// `--screen`
    pub screen: Option<ScreenForm>,
}

impl Attendance {
    /// The operator that the command line or the plan names.
    pub fn operator_of(&self, plan: &Plan) -> Option<String> {
        let mut particulars = plan.particulars.iter();
        let of_plan = particulars.find(|(field, _)| *field == OPERATOR.name);
        self.operator
            .clone()
            .or_else(|| of_plan.map(|(_, name)| name.clone()))
            .filter(|name| !name.trim().is_empty())
    }
}

/// Whether the terminal can show the live screen.
pub fn can_draw(settings: Settings) -> bool {
    settings.can_ask && settings.unicode && screen::is_large_enough()
}

impl Watcher {
    /// Observes a run on a simulated or a real rig. Keys and signals set the stop request of `signals`. A rig that can hold in the middle
    /// of a step also receives it. Not `drawn`: in lines, also on a terminal, because a client drives, and there is no procedure to draw.
    pub fn new(
        settings: Settings,
        attendance: &Attendance,
        plan: &Plan,
        simulated: bool,
        signals: Signals,
        drawn: bool,
    ) -> Self {
        let stop_request = signals.stop_request().clone();
        let operator = attendance.operator_of(plan);
        let form = attendance.screen;
        let shown = Shown::of(plan);
        let face = match form {
            Some(ScreenForm::Never) => Face::Lines(Lines::silent()),
            Some(ScreenForm::Full) | None if drawn && can_draw(settings) => {
                Face::Screen(Screen::new(
                    plan,
                    simulated,
                    // A short simulation has nothing to watch.
                    form.is_some() || !simulated,
                    operator.clone(),
                    stop_request.clone(),
                    settings.color,
                ))
            }
            None if drawn && settings.stderr_terminal => {
                Face::Bar(Bar::new(settings.unicode, shown))
            }
            _ => Face::Lines(Lines::new(shown)),
        };
        let asking = match (attendance.yes, settings.can_ask, simulated, &face) {
            (true, ..) => Asking::Yes(operator),
            (false, true, _, Face::Screen(_)) => Asking::Screen,
            (false, true, ..) => Asking::Person(Person::new(operator)),
            (false, false, true, _) => Asking::NoOperatorNeeded,
            (false, false, false, _) => Asking::NoOperator,
        };
        if !matches!(face, Face::Screen(_)) {
            signals.print_signals(settings.stderr_terminal);
        }
        Self {
            face,
            asking,
            stop_request,
            expected: Extent::default(),
            overdue: report_status::overdue(plan, &today()),
            released: None,
            pace: Pace::default(),
            ended: None,
            alarm: None,
            live: None,
            stops_before: None,
            _signals: signals,
        }
    }

    /// Shows the live readings of this rig.
    pub fn watch(&mut self, live: Live) {
        if let Face::Screen(screen) = &self.face {
            screen.watch(live.clone());
        }
        self.live = Some(live);
    }

    /// Sets the expected demand of the run, for the operator who releases the rig.
    pub const fn expect(&mut self, expected: Extent) {
        self.expected = expected;
    }

    /// Sets the share of each procedure in the run, for the time left.
    pub fn pace(&mut self, parts: Vec<Part>) {
        self.pace = Pace::of(parts);
    }

    /// The run is resumed here: the steps before have another pace.
    pub const fn resumed(&mut self) {
        self.pace.resumed();
    }

    /// Shows the predicted curves of these procedures beside the measured ones.
    pub fn predict(&mut self, procedures: Vec<Reach>) {
        if let Face::Screen(screen) = &self.face {
            screen.predict(procedures);
        }
    }

    /// The operator's choice after the early end of a run, while the rig is observed. `resume`: whether the run can be resumed.
    pub fn stay(&mut self, resume: bool) -> Stay {
        let after = if self.alarm.is_some() {
            After::NotHeld
        } else {
            After::Held {
                resume,
                unload: false,
            }
        };
        self.wait_after_the_end(&Stay::Wait, |dialogue| dialogue.stay(after))
            .unwrap_or(Stay::Leave)
    }

    /// As [`Self::wait_for`] after the early end of a run: Ctrl-C at typed lines leaves a rig on hold.
    fn wait_after_the_end<T: PartialEq>(
        &mut self,
        none_yet: &T,
        ask: impl Fn(&mut Dialogue) -> T,
    ) -> Option<T> {
        let interrupted = self.is_interrupted();
        if !self.stop_request.prompts_allowed() {
            return None;
        }
        if let Asking::Person(person) = &mut self.asking
            && interrupted
            && self.alarm.is_none()
        {
            person.leave();
        }
        self.wait_for(none_yet, ask)
    }

    /// The result of the dialogue with the operator; None: no operator can answer.
    fn wait_for<T: PartialEq>(
        &mut self,
        none_yet: &T,
        ask: impl Fn(&mut Dialogue) -> T,
    ) -> Option<T> {
        let state_lines = self.rig_state_lines();
        let at_the_screen = matches!(self.asking, Asking::Screen) || self.alarm.is_some();
        match (&mut self.face, &mut self.asking) {
            (Face::Screen(screen), _) if at_the_screen || screen.is_attended() => {
                Some(screen.wait_for(none_yet, ask))
            }
            (face, Asking::Person(person)) => {
                face.clear();
                Some(person.wait_for(&state_lines, none_yet, ask))
            }
            _ => None,
        }
    }

    /// Whether Ctrl-C came after the operator was first asked about a rig on hold.
    fn is_interrupted(&mut self) -> bool {
        let now = self.stop_request.requests();
        now != *self.stops_before.get_or_insert(now)
    }

    /// The lines about a rig whose run has ended early: the alarm alone, or the reason of the hold and the measured forces.
    fn rig_state_lines(&self) -> Vec<String> {
        if let Some(alarm) = &self.alarm {
            return vec![alarm.clone()];
        }
        let reading = self.live.as_ref().and_then(Live::newest);
        let of_axes = reading
            .iter()
            .flat_map(|reading| reading.displacement.iter().zip(&reading.force));
        let of_axes = of_axes
            .map(|(displacement, force)| question::position_and_force(*displacement, *force));
        ["HELD".to_owned()]
            .into_iter()
            .chain(self.ended.clone())
            .chain(of_axes)
            .collect()
    }

    /// Removes screen and bar from the terminal.
    pub fn finish(&mut self) {
        if let Face::Screen(screen) = &mut self.face {
            screen.finish();
        }
        self.face.clear();
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
        self.pace.procedure_started();
        self.face().procedure_started(name, keyword, steps);
    }

    fn step_done(&mut self, report: &StepReport) {
        // A look at the clock takes as long as a part of a simulated step. Sixteen of these are over before a person notices.
        if self.live.is_some() || report.step.is_multiple_of(16) {
            let now = Instant::now();
            self.pace.step_done(report.step, now);
            let left = self.pace.left();
            match &mut self.face {
                Face::Screen(screen) => screen.set_left(left),
                Face::Bar(bar) => bar.left = left,
                Face::Lines(lines) => (lines.left, lines.now) = (left, Some(now)),
            }
        }
        self.face().step_done(report);
    }

    fn studying(&mut self, done: usize, of: usize) {
        self.face().studying(done, of);
    }

    fn procedure_finished(&mut self, name: &str) {
        self.face().procedure_finished(name);
    }

    fn stop_requested(&self) -> bool {
        self.stop_request.end_requested()
    }

    fn inspect(&mut self, note: &str) -> Inspection {
        self.ask(&Question::look(note, self.released.as_ref()))
    }

    fn release(&mut self, _: &str, motion: &Motion) -> Inspection {
        let motion = motion.clone().expecting(self.expected);
        let mut question = Question::of(QuestionKind::Release, &motion);
        question.lines.extend(
            self.overdue
                .iter()
                .map(|calibration| escape(&format!("{:<9} NOT ISSUABLE: {calibration}", "report"))),
        );
        self.released = Some(motion);
        self.ask(&question)
    }

    fn may_unload(&mut self, _: &str, motion: &Motion) -> Option<Inspection> {
        let question = Question::of(QuestionKind::Unload, motion);
        let answer = self.wait_after_the_end(&Some(Inspection::Wait), |dialogue| {
            dialogue.ask_to_unload(&question)
        })?;
        if matches!(answer, Some(Inspection::GoOn { .. })) {
            // A Ctrl-C during a move stops that move.
            self.stops_before = None;
        }
        answer
    }

    fn next(&mut self) -> Next {
        let next = self.face().next();
        if next == Next::Wait {
            self.pace.interrupted();
        }
        next
    }

    fn event(&mut self, event: &Event) {
        match event.kind {
            EventKind::NotHeld => self.alarm = Some(escape(&event.text)),
            EventKind::Held => self.alarm = None,
            EventKind::Hold | EventKind::LimitBreach | EventKind::Fault => {
                self.ended = Some(escape(&event.text));
            }
            _ => {}
        }
        self.face().event(event);
    }
}

impl Watcher {
    fn ask(&mut self, question: &Question) -> Inspection {
        self.pace.interrupted();
        match &self.asking {
            Asking::Yes(operator) => Inspection::GoOn {
                note: Some(match question.kind {
                    QuestionKind::Release => "released with --yes, without a prompt".to_owned(),
                    _ => "answered by --yes".to_owned(),
                }),
                by: operator.clone(),
            },
            Asking::NoOperatorNeeded => Inspection::GoOn {
                note: Some(NO_OPERATOR_ASKED.to_owned()),
                by: None,
            },
            Asking::NoOperator => Inspection::Stop {
                reason: "no operator can be asked at an inspection: no terminal, and no --yes"
                    .to_owned(),
                by: None,
            },
            Asking::Screen | Asking::Person(_) => self
                .wait_for(&Inspection::Wait, |dialogue| dialogue.ask(question))
                .unwrap_or_else(|| question.kind.unanswered()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd_testing::plans::empty_plan;

    #[test]
    fn a_real_rig_stops_where_nobody_can_be_asked() {
        let settings = Settings::PLAIN;
        let mut plan = empty_plan();
        plan.particulars
            .push(("operator", "A. Engineer".to_owned()));
        let ask = |yes, simulated| {
            let attendance = Attendance {
                yes,
                ..Attendance::default()
            };
            let signals = Signals::caught(&StopRequest::default()).unwrap();
            Watcher::new(settings, &attendance, &plan, simulated, signals, true).inspect("look")
        };
        assert!(matches!(ask(false, false), Inspection::Stop { .. }));
        let yes = Inspection::GoOn {
            note: Some("answered by --yes".to_owned()),
            by: Some("A. Engineer".to_owned()),
        };
        assert_eq!(ask(true, false), yes);
        assert!(matches!(
            ask(false, true),
            Inspection::GoOn { by: None, .. }
        ));
    }
}
