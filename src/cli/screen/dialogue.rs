//! What the person at the keys wants. In: keys, and questions of the run. Out: wishes, answers, words for the record.
//! Only a `y` typed at a question, then its line and a name, goes on; nothing else ever counts as yes.

use std::collections::VecDeque;

use super::keys::Key;
use crate::cli::watch::interrupt;
use crate::diagnostic::excerpt::escape;
use crate::rig::Wish;
use crate::run::{Inspection, Next};

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
    /// What is asked is whether the rig is to unload: the run has ended.
    pub unload: bool,
    pub help: bool,
    /// What the run asks a person to look at.
    pub question: Option<String>,
    pub typing: Option<Typing>,
    /// Only watching: nothing runs that could be paused.
    pub monitor: bool,
    /// Steps asked for while paused.
    single: u32,
    said: VecDeque<String>,
    answer: Option<Inspection>,
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
    /// `y` or `n`.
    Answer,
    /// A remark to the answer.
    Remark {
        yes: bool,
    },
    /// Who answers.
    AnswerName {
        yes: bool,
        remark: String,
    },
}

impl Dialogue {
    pub fn new(operator: Option<String>) -> Self {
        Self { operator, ..Self::default() }
    }

    /// Nothing to pause and nothing asked: only an end and the help.
    pub fn of_monitor() -> Self {
        Self { monitor: true, ..Self::default() }
    }

    /// A key was pressed.
    pub fn press(&mut self, key: Key, wish: &Wish) {
        match key {
            Key::Interrupt => return interrupt(wish),
            Key::Quit => return wish.hold_now(),
            _ => {}
        }
        // The help closes with any key; one that it names as a way to stop also does that.
        if std::mem::take(&mut self.help) && !matches!(key, Key::Character('h' | 'H' | 'q' | 'Q')) {
            return;
        }
        match &self.typing {
            Some(Typing { what: What::Answer, .. }) => self.choose(key, wish),
            Some(_) => self.edit(key),
            None => self.command(key, wish),
        }
        self.open_question();
    }

    fn command(&mut self, key: Key, wish: &Wish) {
        let Key::Character(character) = key else { return };
        match character.to_ascii_lowercase() {
            'q' => wish.stop_after_step(),
            'h' => wish.hold_now(),
            '?' => self.help = true,
            _ if self.monitor => {}
            'p' => {
                self.paused = !self.paused;
                self.single = 0;
                let did = if self.paused { "paused" } else { "went on" };
                self.said.push_back(format!("{did}{}", self.signature()));
            }
            's' | ' ' if self.paused => self.single += 1,
            'i' => self.typing = Some(Typing { what: What::Note, text: String::new() }),
            _ => {}
        }
    }

    /// At a question.
    fn choose(&mut self, key: Key, wish: &Wish) {
        match key {
            Key::Character('y' | 'Y') => self.line(What::Remark { yes: true }),
            Key::Character('n' | 'N') => self.line(What::Remark { yes: false }),
            Key::Character('q' | 'Q') if self.unload => self.no_answer(),
            Key::Character('q' | 'Q') => wish.stop_after_step(),
            Key::Character('h' | 'H') => wish.hold_now(),
            Key::End => self.no_answer(),
            _ => {}
        }
    }

    fn edit(&mut self, key: Key) {
        let Some(typing) = &mut self.typing else { return };
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
            Key::Escape => self.typing = None,
            Key::End if self.question.is_some() && !typing.what.is_note() => self.no_answer(),
            Key::End | Key::Interrupt | Key::Quit => {}
        }
    }

    fn enter(&mut self) {
        let Some(Typing { what, text }) = self.typing.take() else { return };
        let text = escape(text.trim());
        match what {
            What::Note if text.is_empty() => {}
            What::Note => match &self.operator {
                Some(_) => self.say(&text),
                None => self.line(What::NoteName { note: text }),
            },
            What::Remark { yes } => match self.operator.clone() {
                Some(name) => self.settle(yes, &text, name),
                None => self.line(What::AnswerName { yes, remark: text }),
            },
            // A note or an answer has somebody's name: a blank one is asked for again.
            What::NoteName { .. } | What::AnswerName { .. } if text.is_empty() => self.line(what),
            What::NoteName { note } => {
                self.operator = Some(text);
                self.say(&note);
            }
            What::AnswerName { yes, remark } => {
                self.operator = Some(text.clone());
                self.settle(yes, &remark, text);
            }
            What::Answer => {}
        }
    }

    fn line(&mut self, what: What) {
        self.typing = Some(Typing { what, text: String::new() });
    }

    fn say(&mut self, note: &str) {
        self.said.push_back(format!("{note}{}", self.signature()));
    }

    fn signature(&self) -> String {
        self.operator.as_ref().map_or_else(|| " by a person".to_owned(), |name| format!(" ({name})"))
    }

    fn settle(&mut self, yes: bool, remark: &str, name: String) {
        let remark = (!remark.is_empty()).then(|| remark.to_owned());
        let by = Some(name);
        self.question = None;
        self.answer = Some(if yes {
            Inspection::GoOn { note: remark, by }
        } else if self.unload {
            Inspection::Stop { reason: remark.map_or_else(|| "no".to_owned(), |remark| format!("no: {remark}")), by }
        } else {
            let reason = "stopped by a person at an inspection";
            Inspection::Stop { reason: remark.map_or_else(|| reason.to_owned(), |remark| format!("{reason}: {remark}")), by }
        });
    }

    fn no_answer(&mut self) {
        self.question = None;
        self.typing = None;
        self.answer = Some(Inspection::Stop { reason: "no answer at an inspection".to_owned(), by: None });
    }

    /// A question waits until the line that is being typed is done: no letter of a note is taken for an answer.
    fn open_question(&mut self) {
        if self.question.is_some() && self.typing.is_none() {
            self.line(What::Answer);
        }
    }

    /// The run asks; asked again, the answer is given once it is known.
    pub fn ask(&mut self, note: &str) -> Inspection {
        if self.lost {
            return Inspection::Stop { reason: "nobody to ask at an inspection: the terminal is gone".to_owned(), by: None };
        }
        if let Some(answer) = self.answer.take() {
            return answer;
        }
        if self.question.is_none() {
            self.question = Some(note.to_owned());
            self.help = false;
        }
        self.open_question();
        Inspection::Wait
    }

    /// A person stopped the run: asks whether the rig is to take the load off. None: nobody answers, and it stays held.
    pub fn ask_to_unload(&mut self, question: &str) -> Option<Inspection> {
        if !std::mem::replace(&mut self.unload, true) {
            (self.question, self.answer, self.typing) = (None, None, None);
        }
        match self.ask(question) {
            Inspection::Stop { by: None, .. } => None,
            answer => Some(answer),
        }
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
    pub fn lose(&mut self, wish: &Wish) {
        self.lost = true;
        wish.hold_now();
    }
}

impl What {
    const fn is_note(&self) -> bool {
        matches!(self, Self::Note | Self::NoteName { .. })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn type_in(dialogue: &mut Dialogue, text: &str) {
        let wish = Wish::default();
        for character in text.chars() {
            let key = match character {
                '\n' => Key::Enter,
                '\u{1b}' => Key::Escape,
                '\u{4}' => Key::End,
                other => Key::Character(other),
            };
            dialogue.press(key, &wish);
        }
    }

    fn answered(operator: Option<&str>, typed: &str) -> Inspection {
        let mut dialogue = Dialogue::new(operator.map(str::to_owned));
        assert_eq!(dialogue.ask("look"), Inspection::Wait);
        type_in(&mut dialogue, typed);
        dialogue.ask("look")
    }

    #[test]
    fn only_yes_with_a_name_goes_on() {
        let by = |name: &str| Some(name.to_owned());
        assert_eq!(answered(Some("A. Engineer"), "y\n"), Inspection::GoOn { note: None, by: by("A. Engineer") });
        let typed = Inspection::GoOn { note: Some("no crack".to_owned()), by: by("B") };
        assert_eq!(answered(None, "yno crack\n  \nB\n"), typed, "a blank name is asked for again");
        for undecided in ["", "\n", " ", "x", "y", "yyes", "y\n", "y\n  \n", "y\u{1b}", "p", "i"] {
            assert_eq!(answered(None, undecided), Inspection::Wait, "{undecided:?}");
        }
        assert!(matches!(answered(None, "\u{4}"), Inspection::Stop { .. }), "the end of the input is no yes");
        assert!(matches!(answered(None, "yfine\u{4}"), Inspection::Stop { .. }));
        let stop = answered(Some("C"), "ncrack\u{202e}\n");
        let reason = "stopped by a person at an inspection: crack\\u{202e}".to_owned();
        assert_eq!(stop, Inspection::Stop { reason, by: by("C") });
    }

    #[test]
    fn a_note_being_typed_is_no_answer() {
        let mut dialogue = Dialogue::new(Some("A".to_owned()));
        type_in(&mut dialogue, "i");
        assert_eq!(dialogue.ask("look"), Inspection::Wait);
        type_in(&mut dialogue, "yes\n");
        assert_eq!(dialogue.next(), Next::Record("yes (A)".to_owned()));
        assert_eq!(dialogue.ask("look"), Inspection::Wait, "the question comes after the note");
        type_in(&mut dialogue, "y\n");
        assert!(matches!(dialogue.ask("look"), Inspection::GoOn { .. }));
    }

    #[test]
    fn a_paused_run_goes_on_step_by_step() {
        let mut dialogue = Dialogue::new(None);
        type_in(&mut dialogue, "s");
        assert_eq!(dialogue.next(), Next::GoOn);
        type_in(&mut dialogue, "p");
        assert_eq!(dialogue.next(), Next::Record("paused by a person".to_owned()));
        assert_eq!(dialogue.next(), Next::Wait);
        type_in(&mut dialogue, "s ");
        assert_eq!([dialogue.next(), dialogue.next(), dialogue.next()], [Next::GoOn, Next::GoOn, Next::Wait]);
        type_in(&mut dialogue, "p");
        assert_eq!(dialogue.next(), Next::Record("went on by a person".to_owned()));
        assert_eq!(dialogue.next(), Next::GoOn);
    }

    #[test]
    fn the_help_lets_the_keys_through_that_it_names_for_stopping() {
        for (key, held) in [('h', true), ('H', true), ('q', false), ('p', false)] {
            let wish = Wish::default();
            let mut dialogue = Dialogue::new(None);
            dialogue.press(Key::Character('?'), &wish);
            dialogue.press(Key::Character(key), &wish);
            assert_eq!((wish.wants_hold(), wish.wants_end()), (held, key != 'p'), "{key}");
            assert!(!dialogue.help && !dialogue.paused, "any other key only closes it");
        }
    }

    #[test]
    fn a_pause_is_one_when_the_step_has_ended() {
        let mut dialogue = Dialogue::new(Some("A".to_owned()));
        type_in(&mut dialogue, "p");
        assert!(dialogue.paused && !dialogue.waiting, "the rig still moves");
        assert!(matches!(dialogue.next(), Next::Record(_)));
        assert_eq!((dialogue.next(), dialogue.waiting), (Next::Wait, true));
        type_in(&mut dialogue, "s");
        assert_eq!((dialogue.next(), dialogue.waiting), (Next::GoOn, false), "one step moves");
    }

    #[test]
    fn only_a_yes_with_a_name_unloads() {
        let answered = |typed: &str| {
            let mut dialogue = Dialogue::new(Some("A".to_owned()));
            assert_eq!(dialogue.ask("look"), Inspection::Wait);
            type_in(&mut dialogue, "n\n");
            assert!(matches!(dialogue.ask("look"), Inspection::Stop { .. }));
            assert_eq!(dialogue.ask_to_unload("unload?"), Some(Inspection::Wait));
            type_in(&mut dialogue, typed);
            dialogue.ask_to_unload("unload?")
        };
        assert!(matches!(answered("y\n"), Some(Inspection::GoOn { by: Some(_), .. })));
        let no = Inspection::Stop { reason: "no: cracked".to_owned(), by: Some("A".to_owned()) };
        assert_eq!(answered("ncracked\n"), Some(no));
        for undecided in ["", "\n", "y", "x"] {
            assert_eq!(answered(undecided), Some(Inspection::Wait), "{undecided:?}");
        }
        assert_eq!((answered("q"), answered("\u{4}"), answered("y\u{4}")), (None, None, None));
        let mut dialogue = Dialogue::new(None);
        dialogue.lose(&Wish::default());
        assert_eq!(dialogue.ask_to_unload("unload?"), None, "nobody there");
    }

    #[test]
    fn stop_and_hold_are_wishes_and_a_lost_terminal_is_a_hold() {
        let wish = Wish::default();
        let mut dialogue = Dialogue::default();
        dialogue.press(Key::Character('q'), &wish);
        assert!(wish.wants_end() && !wish.wants_hold());
        dialogue.press(Key::Interrupt, &wish);
        assert!(wish.wants_hold());
        let wish = Wish::default();
        dialogue.press(Key::Quit, &wish);
        assert!(wish.wants_hold());
        let wish = Wish::default();
        dialogue.paused = true;
        dialogue.lose(&wish);
        assert!(wish.wants_hold());
        assert_eq!(dialogue.next(), Next::GoOn, "a pause does not outlast its terminal");
        assert!(matches!(dialogue.ask("look"), Inspection::Stop { .. }));
    }
}
