//! The operator's input at the keys. In: keys with their time, questions of the run. Out: stop requests, answers, notes for the run log.
//! Only the confirmation text, typed and entered after the question could be read, permits a motion.

use std::collections::VecDeque;
use std::time::Duration;

use super::keys::Key;
use crate::cli::operator::question::{After, Choice, DEAF, Kind, Question};
use crate::cli::operator::watch::{Stay, interrupt};
use crate::rig::StopRequest;
use crate::run::{Inspection, Next};
use crate::text::diagnostic::excerpt::escape;

/// Largest number of characters of one typed line.
const LONGEST_LINE: usize = 200;

/// The keyboard part of the screen.
#[derive(Clone, Debug, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own")]
pub struct Dialogue {
    /// The name of the operator who answers, once it is known.
    pub operator: Option<String>,
    pub paused: bool,
    /// The run is paused, and the rig is at rest.
    pub waiting: bool,
    pub help: bool,
    /// The question of the run to the operator.
    pub question: Option<Question>,
    /// A remark to the answer, once it is typed.
    pub remark: Option<String>,
    /// The last input was not a valid answer.
    pub unclear: bool,
    pub typing: Option<Typing>,
    /// The available choices after the early end of the run.
    pub after: Option<After>,
    /// Observation only: there is no run to pause.
    pub monitor: bool,
    /// The operator has stopped the run at these keys.
    pub attended: bool,
    /// Number of questions and choices that have appeared.
    pub appeared: u64,
    /// Time from which keys count for the last of them; None: it has not been drawn yet.
    heard_from: Option<Duration>,
    /// Number of single steps requested while paused.
    single: u32,
    notes: VecDeque<String>,
    answer: Option<Inspection>,
    /// The rig is to unload: its question comes next.
    unload: bool,
    /// The final choice of the operator.
    chosen: Option<Stay>,
    /// The terminal is closed: no more answers are possible.
    lost: bool,
}

/// A line that is being typed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Typing {
    pub what: What,
    pub text: String,
}

/// The purpose of the line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum What {
    Note,
    /// The author of a note.
    NoteName {
        note: String,
    },
    /// The confirmation text of the question, or `n`.
    Answer,
    /// A remark to the answer.
    Remark,
    /// The name of the operator who answers.
    AnswerName {
        yes: bool,
    },
    /// The reason to resume a held run.
    Reason,
}

impl Dialogue {
    pub fn new(operator: Option<String>) -> Self {
        Self {
            operator,
            ..Self::default()
        }
    }

    /// Without a pause and without questions: only exit and help.
    pub fn of_monitor() -> Self {
        Self {
            monitor: true,
            ..Self::default()
        }
    }

    /// Processes a key that was pressed at the time `now`.
    pub fn press(&mut self, key: Key, now: Duration, stop_request: &StopRequest) {
        self.pressed(key, now, stop_request);
        self.open_question();
    }

    fn pressed(&mut self, key: Key, now: Duration, stop_request: &StopRequest) {
        if key == Key::Quit && self.after.is_none() {
            self.attended = true;
            return stop_request.hold_now();
        }
        let interrupts = key == Key::Interrupt;
        if self.is_asking() && !self.hears(now) {
            // The operator cannot have read the question yet: only a Ctrl-C that stops a run counts.
            if interrupts && self.after.is_none() {
                self.interrupt(stop_request);
            }
            return;
        }
        match self.after {
            Some(after) if self.typing.is_none() && self.question.is_none() => {
                return self.choose(after, key);
            }
            // The run has ended: the operator refuses the motion.
            Some(_) if interrupts => return self.back_to_the_choice(),
            None if interrupts => return self.interrupt(stop_request),
            _ => {}
        }
        // Any key closes the help. A stop key that the help names also stops the run.
        if std::mem::take(&mut self.help) && !matches!(key, Key::Character('h' | 'H' | 'q' | 'Q')) {
            return;
        }
        match &self.typing {
            Some(Typing {
                what: What::Answer, ..
            }) => self.answer(key, stop_request),
            Some(_) => self.edit(key),
            None => self.command(key, stop_request),
        }
    }

    fn interrupt(&mut self, stop_request: &StopRequest) {
        self.attended = true;
        interrupt(stop_request);
    }

    fn command(&mut self, key: Key, stop_request: &StopRequest) {
        let Key::Character(character) = key else {
            return;
        };
        match character.to_ascii_lowercase() {
            'q' | 'h' => self.stop(character, stop_request),
            '?' => self.help = true,
            _ if self.monitor => {}
            'p' => {
                self.paused = !self.paused;
                self.single = 0;
                let did = if self.paused { "paused" } else { "went on" };
                self.notes.push_back(format!("{did}{}", self.signature()));
            }
            's' | ' ' if self.paused => self.single += 1,
            'i' => self.line(What::Note),
            _ => {}
        }
    }

    fn stop(&mut self, key: char, stop_request: &StopRequest) {
        self.attended = true;
        if key.eq_ignore_ascii_case(&'h') {
            stop_request.hold_now();
        } else {
            stop_request.stop_after_step();
        }
    }

    /// Processes a key at a question. As long as no text is typed, single keys have their usual meaning.
    fn answer(&mut self, key: Key, stop_request: &StopRequest) {
        let nothing_typed = self
            .typing
            .as_ref()
            .is_none_or(|typing| typing.text.is_empty());
        let unload = self.is_unload();
        self.unclear = false;
        match key {
            Key::Character('i' | 'I') if nothing_typed => self.line(What::Remark),
            Key::Character('?') if nothing_typed => self.help = true,
            Key::Character(key @ ('q' | 'Q' | 'h' | 'H')) if nothing_typed && !unload => {
                self.stop(key, stop_request);
            }
            Key::Escape if unload => self.back_to_the_choice(),
            Key::Escape => self.line(What::Answer),
            key => self.edit(key),
        }
    }

    /// Processes a choice for a rig on hold. No choice moves the rig yet.
    fn choose(&mut self, after: After, key: Key) {
        // Its question comes next.
        if self.unload {
            return;
        }
        let choice = match key {
            Key::Character(character) => after.choice(character),
            Key::Interrupt if after != After::NotHeld => Some(Choice::Leave),
            _ => None,
        };
        match choice {
            Some(Choice::Leave) => self.chosen = Some(Stay::Leave),
            Some(Choice::Resume) => self.line(What::Reason),
            Some(Choice::Unload) => self.unload = true,
            None => {}
        }
    }

    fn back_to_the_choice(&mut self) {
        (
            self.question,
            self.typing,
            self.remark,
            self.answer,
            self.unload,
        ) = (None, None, None, None, false);
        self.appear();
    }

    fn edit(&mut self, key: Key) {
        let Some(typing) = &mut self.typing else {
            return;
        };
        match key {
            Key::Character(character) => {
                if typing.text.chars().count() < LONGEST_LINE {
                    typing.text.push(character);
                }
            }
            Key::Erase => {
                typing.text.pop();
            }
            Key::EraseLine => typing.text.clear(),
            Key::Enter => self.enter(),
            Key::Escape if matches!(typing.what, What::Remark | What::AnswerName { .. }) => {
                self.line(What::Answer);
            }
            Key::Escape if typing.what == What::Reason => self.back_to_the_choice(),
            Key::Escape => self.typing = None,
            Key::End if self.question.is_some() && !typing.what.is_note() => self.no_answer(),
            Key::End | Key::Interrupt | Key::Quit => {}
        }
    }

    fn enter(&mut self) {
        let Some(Typing { what, text }) = self.typing.take() else {
            return;
        };
        let text = escape(text.trim());
        match what {
            What::Note if text.is_empty() => {}
            What::Note => match &self.operator {
                Some(_) => self.record_note(&text),
                None => self.line(What::NoteName { note: text }),
            },
            What::Answer => match (
                self.question
                    .as_ref()
                    .and_then(|question| question.kind.answer(&text)),
                &self.operator,
            ) {
                (Some(yes), Some(name)) => {
                    let name = name.clone();
                    self.settle(yes, name);
                }
                (Some(yes), None) => self.line(What::AnswerName { yes }),
                (None, _) => {
                    self.unclear = !text.is_empty();
                    self.line(what);
                }
            },
            What::Remark => {
                self.remark = Some(text).filter(|text| !text.is_empty());
                self.line(What::Answer);
            }
            // A note, an answer and a resumption require a name or a reason: an empty text is asked for again.
            What::NoteName { .. } | What::AnswerName { .. } | What::Reason if text.is_empty() => {
                self.line(what);
            }
            What::NoteName { note } => {
                self.operator = Some(text);
                self.record_note(&note);
            }
            What::AnswerName { yes } => {
                self.operator = Some(text.clone());
                self.settle(yes, text);
            }
            What::Reason => self.chosen = Some(Stay::Resume(text)),
        }
    }

    fn line(&mut self, what: What) {
        self.typing = Some(Typing {
            what,
            text: String::new(),
        });
    }

    fn record_note(&mut self, note: &str) {
        self.notes.push_back(format!("{note}{}", self.signature()));
    }

    fn signature(&self) -> String {
        self.operator.as_ref().map_or_else(
            || " by the operator".to_owned(),
            |name| format!(" ({name})"),
        )
    }

    fn settle(&mut self, yes: bool, name: String) {
        let Some(question) = self.question.take() else {
            return;
        };
        self.answer = Some(question.kind.to_inspection(yes, self.remark.take(), name));
    }

    fn no_answer(&mut self) {
        let Some(question) = self.question.take() else {
            return;
        };
        (self.typing, self.remark) = (None, None);
        self.answer = Some(question.kind.unanswered());
    }

    /// Opens a question after the line that is being typed is complete: no character of a note is read as an answer.
    fn open_question(&mut self) {
        if self.question.is_some() && self.typing.is_none() {
            self.line(What::Answer);
            self.appear();
        }
    }

    /// A question or choice appears. Keys count for it only after it has been drawn and could be read.
    const fn appear(&mut self) {
        self.appeared += 1;
        self.heard_from = None;
    }

    /// The question or choice of this number was drawn at the time `now`.
    pub fn drawn(&mut self, appeared: u64, now: Duration) {
        if self.appeared == appeared && self.heard_from.is_none() {
            self.heard_from = Some(now + DEAF);
        }
    }

    /// Whether it has not been drawn yet.
    pub const fn is_new(&self) -> bool {
        self.is_asking() && self.heard_from.is_none()
    }

    /// Whether keys already count for the open question or choice.
    pub fn hears(&self, now: Duration) -> bool {
        self.heard_from.is_some_and(|from| now >= from)
    }

    /// Whether a question or choice waits for an answer.
    const fn is_asking(&self) -> bool {
        match &self.typing {
            Some(Typing {
                what: What::Answer, ..
            }) => !self.help,
            Some(_) => false,
            None => self.after.is_some() && self.question.is_none(),
        }
    }

    fn is_unload(&self) -> bool {
        self.question
            .as_ref()
            .is_some_and(|question| question.kind == Kind::Unload)
    }

    /// Asks a question of the run; a later call returns the answer once it is known.
    pub fn ask(&mut self, question: &Question) -> Inspection {
        if self.lost {
            return Inspection::Stop {
                reason: "no operator can be asked at an inspection: the terminal was closed"
                    .to_owned(),
                by: None,
            };
        }
        if let Some(answer) = self.answer.take() {
            return answer;
        }
        if self.question.is_none() {
            self.question = Some(question.clone());
            (self.help, self.unclear, self.remark) = (false, false, None);
        }
        self.open_question();
        Inspection::Wait
    }

    /// The run has ended early, and the rig is on hold: asks whether it is to unload. None: it stays on hold.
    pub fn ask_to_unload(&mut self, question: &Question) -> Option<Inspection> {
        if self.lost || self.chosen.is_some() {
            return None;
        }
        let choice = After::Held {
            resume: true,
            unload: true,
        };
        if self.after != Some(choice) {
            self.show_choices(choice);
        }
        if self.unload {
            match self.ask(question) {
                Inspection::Stop { .. } => self.back_to_the_choice(),
                Inspection::Wait => {}
                yes @ Inspection::GoOn { .. } => {
                    (self.after, self.unload) = (None, false);
                    return Some(yes);
                }
            }
        }
        Some(Inspection::Wait)
    }

    /// The operator's choice after the early end of the run.
    pub fn stay(&mut self, after: After) -> Stay {
        if self.lost {
            return Stay::Leave;
        }
        // An operator who left a rig on hold has not seen that the hold is no longer confirmed.
        let news = after == After::NotHeld && self.after != Some(after);
        if let Some(chosen) = self.chosen.clone().filter(|_| !news) {
            return chosen;
        }
        if self.after != Some(after) {
            self.show_choices(after);
        }
        Stay::Wait
    }

    fn show_choices(&mut self, after: After) {
        (self.after, self.chosen, self.help) = (Some(after), None, false);
        self.back_to_the_choice();
    }

    /// The operator's request between two steps.
    pub fn next(&mut self) -> Next {
        if let Some(note) = self.notes.pop_front() {
            return Next::Record(note);
        }
        self.waiting = self.paused && !self.lost && self.single == 0;
        if self.waiting {
            return Next::Wait;
        }
        self.single = self.single.saturating_sub(1);
        Next::GoOn
    }

    /// The terminal is closed: the rig goes on hold, and questions stay unanswered.
    pub fn lose(&mut self, stop_request: &StopRequest) {
        self.lost = true;
        stop_request.hold_now();
    }
}

impl What {
    const fn is_note(&self) -> bool {
        matches!(self, Self::Note | Self::NoteName { .. })
    }
}

#[cfg(test)]
mod tests;
