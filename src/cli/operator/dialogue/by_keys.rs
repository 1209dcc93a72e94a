//! The operator's input at the keys of the screen. In: keys with their time. Out: stop requests, pauses, entered lines and choices of the
//! dialogue. A key does not count before its question could be read.

use std::time::Duration;

use super::keys::Key;
use super::{Dialogue, Typing, What};
use crate::operator::question::{After, Choice, QuestionKind};
use crate::operator::watch::interrupt;
use psd_rig::StopRequest;

/// Largest number of characters of one typed line.
const LONGEST_LINE: usize = 200;

impl Dialogue {
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
                return self.choose_by_key(after, key);
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
        let question = self.question.as_ref();
        let unload = question.is_some_and(|question| question.kind == QuestionKind::Unload);
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

    /// Processes a key at the choice for a rig on hold.
    fn choose_by_key(&mut self, after: After, key: Key) {
        let choice = match key {
            Key::Character(character) => after.choice(character),
            Key::Interrupt if after != After::NotHeld => Some(Choice::Leave),
            _ => None,
        };
        // After the choice to unload, its question comes next.
        if let Some(choice) = choice.filter(|_| !self.unload) {
            self.choose(choice);
        }
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
            Key::Enter => {
                let text = std::mem::take(&mut typing.text);
                self.enter(&text);
            }
            Key::Escape if matches!(typing.what, What::Remark | What::AnswerName { .. }) => {
                self.line(What::Answer);
            }
            Key::Escape if typing.what == What::Reason => self.back_to_the_choice(),
            Key::Escape => self.typing = None,
            Key::End if matches!(typing.what, What::Note | What::NoteName { .. }) => {}
            Key::End => self.no_answer(),
            Key::Interrupt | Key::Quit => {}
        }
    }
}

#[cfg(test)]
mod tests;
