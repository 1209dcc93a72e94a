//! What the person at the keys wants. In: keys with their time, questions of the run. Out: wishes, answers, words for the record.
//! Only the word of a question, typed and entered after it could be read, goes on; nothing else ever counts as yes.

use std::collections::VecDeque;
use std::time::Duration;

use super::keys::Key;
use crate::cli::operator::question::{After, Choice, DEAF, Kind, Question};
use crate::cli::operator::watch::{Stay, interrupt};
use crate::rig::StopRequest;
use crate::run::{Inspection, Next};
use crate::text::diagnostic::excerpt::escape;

/// Characters of one typed line.
const LONGEST_LINE: usize = 200;

/// The keys' side of the screen.
#[derive(Clone, Debug, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own")]
pub struct Dialogue {
    /// Who answers, once it is known.
    pub operator: Option<String>,
    pub paused: bool,
    /// The run waits, and the rig rests.
    pub waiting: bool,
    pub help: bool,
    /// What the run asks a person.
    pub question: Option<Question>,
    /// A remark to the answer, once it is typed.
    pub remark: Option<String>,
    /// What was entered last answers nothing.
    pub unclear: bool,
    pub typing: Option<Typing>,
    /// What may be chosen after the early end of the run.
    pub after: Option<After>,
    /// Only watching: nothing runs that could be paused.
    pub monitor: bool,
    /// Somebody has stopped the run at these keys.
    pub attended: bool,
    /// How many questions and choices have appeared.
    pub appeared: u64,
    /// From when on keys count for the last of them; None: it has not been drawn yet.
    heard_from: Option<Duration>,
    /// Steps asked for while paused.
    single: u32,
    said: VecDeque<String>,
    answer: Option<Inspection>,
    /// The rig is to unload: its question comes next.
    unload: bool,
    /// What the person chose at last.
    chosen: Option<Stay>,
    /// The terminal is gone: nobody answers any more.
    lost: bool,
}

/// A line that is being typed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Typing {
    pub what: What,
    pub text: String,
}

/// What the line is for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum What {
    Note,
    /// Whose note it is.
    NoteName {
        note: String,
    },
    /// The word of the question, or `n`.
    Answer,
    /// A remark to the answer.
    Remark,
    /// Who answers.
    AnswerName {
        yes: bool,
    },
    /// Why a held run goes on.
    Reason,
}

impl Dialogue {
    pub fn new(operator: Option<String>) -> Self {
        Self {
            operator,
            ..Self::default()
        }
    }

    /// Nothing to pause and nothing asked: only an end and the help.
    pub fn of_monitor() -> Self {
        Self {
            monitor: true,
            ..Self::default()
        }
    }

    /// A key was pressed, `now`.
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
            // What stands there has not been read: only a Ctrl-C that stops a run counts.
            if interrupts && self.after.is_none() {
                self.interrupt(stop_request);
            }
            return;
        }
        match self.after {
            Some(after) if self.typing.is_none() && self.question.is_none() => {
                return self.choose(after, key);
            }
            // The run has ended: it is the motion that is not wanted.
            Some(_) if interrupts => return self.back_to_the_choice(),
            None if interrupts => return self.interrupt(stop_request),
            _ => {}
        }
        // The help closes with any key; one that it names as a way to stop also does that.
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
                self.said.push_back(format!("{did}{}", self.signature()));
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

    /// At a question. As long as nothing is typed, single keys are what they are elsewhere.
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

    /// What is done with a rig that holds. None of it moves anything yet.
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
                Some(_) => self.say(&text),
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
            // A note, an answer and a resumption have somebody's name and reason: a blank one is asked for again.
            What::NoteName { .. } | What::AnswerName { .. } | What::Reason if text.is_empty() => {
                self.line(what);
            }
            What::NoteName { note } => {
                self.operator = Some(text);
                self.say(&note);
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

    fn say(&mut self, note: &str) {
        self.said.push_back(format!("{note}{}", self.signature()));
    }

    fn signature(&self) -> String {
        self.operator
            .as_ref()
            .map_or_else(|| " by a person".to_owned(), |name| format!(" ({name})"))
    }

    fn settle(&mut self, yes: bool, name: String) {
        let Some(question) = self.question.take() else {
            return;
        };
        self.answer = Some(question.kind.said(yes, self.remark.take(), name));
    }

    fn no_answer(&mut self) {
        let Some(question) = self.question.take() else {
            return;
        };
        (self.typing, self.remark) = (None, None);
        self.answer = Some(question.kind.unanswered());
    }

    /// A question waits until the line that is being typed is done: no letter of a note is taken for an answer.
    fn open_question(&mut self) {
        if self.question.is_some() && self.typing.is_none() {
            self.line(What::Answer);
            self.appear();
        }
    }

    /// Something stands there that waits for a person: keys count for it once it has been drawn and could be read.
    const fn appear(&mut self) {
        self.appeared += 1;
        self.heard_from = None;
    }

    /// What appeared as this number has been drawn, `now`.
    pub fn drawn(&mut self, appeared: u64, now: Duration) {
        if self.appeared == appeared && self.heard_from.is_none() {
            self.heard_from = Some(now + DEAF);
        }
    }

    /// Whether it has not been drawn yet.
    pub const fn is_new(&self) -> bool {
        self.is_asking() && self.heard_from.is_none()
    }

    /// Whether keys count by now for what waits for an answer.
    pub fn hears(&self, now: Duration) -> bool {
        self.heard_from.is_some_and(|from| now >= from)
    }

    /// Whether something stands there that waits for an answer.
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

    /// The run asks; asked again, the answer is given once it is known.
    pub fn ask(&mut self, question: &Question) -> Inspection {
        if self.lost {
            return Inspection::Stop {
                reason: "nobody to ask at an inspection: the terminal is gone".to_owned(),
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

    /// The run has ended early, and the rig holds: whether it is to take the load off. None: it stays held.
    pub fn ask_to_unload(&mut self, question: &Question) -> Option<Inspection> {
        if self.lost || self.chosen.is_some() {
            return None;
        }
        let choice = After::Held {
            resume: true,
            unload: true,
        };
        if self.after != Some(choice) {
            self.offer(choice);
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

    /// The run has ended early: what the person before it wants.
    pub fn stay(&mut self, after: After) -> Stay {
        if self.lost {
            return Stay::Leave;
        }
        // Who left a held rig has not seen that nobody knows any more whether it holds.
        let news = after == After::NotHeld && self.after != Some(after);
        if let Some(chosen) = self.chosen.clone().filter(|_| !news) {
            return chosen;
        }
        if self.after != Some(after) {
            self.offer(after);
        }
        Stay::Wait
    }

    fn offer(&mut self, after: After) {
        (self.after, self.chosen, self.help) = (Some(after), None, false);
        self.back_to_the_choice();
    }

    /// What a person wants between two steps.
    pub fn next(&mut self) -> Next {
        if let Some(said) = self.said.pop_front() {
            return Next::Record(said);
        }
        self.waiting = self.paused && !self.lost && self.single == 0;
        if self.waiting {
            return Next::Wait;
        }
        self.single = self.single.saturating_sub(1);
        Next::GoOn
    }

    /// The terminal is gone: the rig holds, and nothing is answered.
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
