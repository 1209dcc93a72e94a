//! The dialogue with the operator. In: questions of the run; entered lines and choices. Out: answers, the choice for a rig on hold, notes
//! for the run log. Only the confirmation text, entered after the question could be read, permits a motion. The operator types it at the
//! keys of the screen ([`by_keys`]) or as a line ([`by_lines`]).

mod by_keys;
pub mod by_lines;
pub mod keys;
pub mod typed;

use std::collections::VecDeque;
use std::time::Duration;

use super::question::{After, Choice, DEAF, Question, Stay};
use psd::run::{Inspection, Next};
use psd_rig::StopRequest;
use psd_text::diagnostic::excerpt::escape;

/// Questions, answers, notes and pauses.
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

    /// Makes a choice for a rig on hold. No choice moves the rig yet.
    fn choose(&mut self, choice: Choice) {
        match choice {
            Choice::Leave => self.leave(),
            Choice::Resume => self.line(What::Reason),
            Choice::Unload => self.unload = true,
        }
    }

    /// Ends the dialogue about a rig on hold: it keeps its state.
    pub fn leave(&mut self) {
        (self.unload, self.chosen) = (false, Some(Stay::Leave));
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

    /// The open line is entered with this text.
    fn enter(&mut self, text: &str) {
        let Some(Typing { what, .. }) = self.typing.take() else {
            return;
        };
        let text = escape(text.trim());
        match what {
            What::Note if text.is_empty() => {}
            What::Note => self.note(text),
            What::Answer => {
                let question = self.question.as_ref();
                if let Some(yes) = question.and_then(|question| question.kind.answer(&text)) {
                    self.settle(yes);
                } else {
                    self.unclear = !text.is_empty();
                    self.line(what);
                }
            }
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
                self.note(note);
            }
            What::AnswerName { yes } => {
                self.operator = Some(text);
                self.settle(yes);
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

    /// Keeps a note, once its author is known.
    fn note(&mut self, note: String) {
        if self.operator.is_none() {
            return self.line(What::NoteName { note });
        }
        self.notes.push_back(format!("{note}{}", self.signature()));
    }

    fn signature(&self) -> String {
        self.operator.as_ref().map_or_else(
            || " by the operator".to_owned(),
            |name| format!(" ({name})"),
        )
    }

    /// Answers the question, once the name of the operator is known.
    fn settle(&mut self, yes: bool) {
        let Some(name) = self.operator.clone() else {
            return self.line(What::AnswerName { yes });
        };
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
