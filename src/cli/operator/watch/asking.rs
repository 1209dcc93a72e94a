//! A person who answers questions by typing lines: on a terminal too small for the screen, and by hand. In: lines. Out: an answer
//! with its remark and name, what is done with a rig that holds. The end of the input never counts as yes.

use super::Stay;
use super::typed::{Heard, Typed};
use crate::cli::operator::question::{After, Choice, Kind, Question, WHY_RESUME};
use crate::cli::output::print_message;
use crate::rig::StopRequest;
use crate::run::Inspection;
use crate::text::diagnostic::excerpt::escape;

/// Where the conversation is.
#[derive(Default)]
pub struct Person {
    /// The lines typed, once anything has been asked.
    typed: Option<Typed>,
    state: State,
    /// Of the question that waits.
    remark: Option<String>,
    /// The rig is to unload: its question comes next.
    unload: bool,
    /// What is done with a rig that holds, at last.
    chosen: Option<Stay>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    #[default]
    Silent,
    Asked(Kind),
    /// Asked for the name to this answer.
    Naming(Kind, bool),
    /// Before a run that ended early.
    Choosing(After),
    /// Asked why it may go on.
    Resuming(After),
}

impl Person {
    /// Asks, or looks for an answer to what was asked. A name once given is kept.
    pub fn ask(&mut self, question: &Question, operator: &mut Option<String>) -> Inspection {
        let kind = question.kind;
        if !matches!(self.state, State::Asked(asked) | State::Naming(asked, _) if asked == kind) {
            self.show(question);
            self.remark = None;
            self.state = State::Asked(kind);
        }
        match self.typed().hear() {
            Heard::Nothing => Inspection::Wait,
            Heard::Ready => {
                print_message(&prompt(kind));
                Inspection::Wait
            }
            Heard::Line(line) => self.heard(&line, operator),
            Heard::End => {
                self.state = State::Silent;
                kind.unanswered()
            }
        }
    }

    /// The run has ended early, and the rig holds: whether it is to take the load off. None: it stays held. `told` is what there is to
    /// see, at this moment.
    pub fn ask_to_unload(
        &mut self,
        question: &Question,
        told: &[String],
        operator: &mut Option<String>,
    ) -> Option<Inspection> {
        if self.unload {
            match self.ask(question, operator) {
                Inspection::Wait => {}
                Inspection::Stop { by: None, .. } => self.leave(),
                Inspection::Stop { .. } => (self.unload, self.state) = (false, State::Silent),
                yes @ Inspection::GoOn { .. } => {
                    self.unload = false;
                    return Some(yes);
                }
            }
        } else if self.chosen.is_none() {
            self.choose(
                After::Held {
                    resume: true,
                    unload: true,
                },
                told,
            );
        }
        self.chosen.is_none().then_some(Inspection::Wait)
    }

    /// The run has ended early: what the person wants.
    pub fn stay(&mut self, after: After, told: &[String]) -> Stay {
        // Who left a held rig has not seen that nobody knows any more whether it holds.
        if after == After::NotHeld && self.state != State::Choosing(after) {
            self.chosen = None;
        }
        if self.chosen.is_none() {
            self.choose(after, told);
        }
        self.chosen.clone().unwrap_or(Stay::Wait)
    }

    /// Nothing more is to be done with the rig.
    pub fn leave(&mut self) {
        (self.unload, self.chosen) = (false, Some(Stay::Leave));
    }

    /// Shows what may be chosen, or looks for the choice.
    fn choose(&mut self, after: After, told: &[String]) {
        if ![State::Choosing(after), State::Resuming(after)].contains(&self.state) {
            print_message(&format!("\n  {}\n", told.join("\n  ")));
            self.typed().begin();
            self.state = State::Choosing(after);
        }
        match self.typed().hear() {
            Heard::Nothing => {}
            Heard::Ready => print_message(&choices(after)),
            Heard::End => self.leave(),
            Heard::Line(line) if self.state == State::Resuming(after) => {
                match escape(line.trim()) {
                    // No reason: back to the choice.
                    reason if reason.is_empty() => self.state = State::Silent,
                    reason => self.chosen = Some(Stay::Resume(reason)),
                }
            }
            Heard::Line(line) => match line.trim().parse().ok().and_then(|key| after.choice(key)) {
                Some(Choice::Leave) => self.leave(),
                Some(Choice::Unload) => self.unload = true,
                Some(Choice::Resume) => {
                    print_message(&format!(
                        "  {WHY_RESUME}\n  type the reason, or nothing: back > "
                    ));
                    self.state = State::Resuming(after);
                }
                None => print_message(&format!("  {}\n{}", told.join("\n  "), choices(after))),
            },
        }
    }

    fn typed(&mut self) -> &mut Typed {
        self.typed.get_or_insert_with(Typed::from_the_terminal)
    }

    fn show(&mut self, question: &Question) {
        print_message(&shown(question));
        self.typed().begin();
    }

    fn heard(&mut self, line: &str, operator: &mut Option<String>) -> Inspection {
        let (kind, yes) = match self.state {
            State::Naming(kind, yes) => {
                let name = escape(line.trim());
                if !name.is_empty() {
                    *operator = Some(name);
                }
                (kind, yes)
            }
            State::Asked(kind) => {
                let remark = line
                    .trim()
                    .strip_prefix("i ")
                    .map(str::trim)
                    .filter(|remark| !remark.is_empty());
                if let Some(remark) = remark {
                    self.remark = Some(escape(remark));
                }
                let Some(yes) = kind.answer(line) else {
                    print_message(&prompt(kind));
                    return Inspection::Wait;
                };
                (kind, yes)
            }
            _ => return Inspection::Wait,
        };
        let Some(by) = operator.clone() else {
            print_message("  your name? ");
            self.state = State::Naming(kind, yes);
            return Inspection::Wait;
        };
        self.state = State::Silent;
        kind.said(yes, self.remark.take(), by)
    }
}

/// A question as it is told in lines.
fn shown(question: &Question) -> String {
    format!(
        "\n  {}\n  {}\n",
        question.kind.title(),
        question.lines.join("\n  ")
    )
}

/// What may be typed.
fn prompt(kind: Kind) -> String {
    let remark = if kind == Kind::Jog {
        ""
    } else {
        ", i and a remark for the record"
    };
    format!(
        "  type {}, or n: {}{remark} > ",
        kind.word(),
        kind.declined()
    )
}

/// What may be typed before a run that ended early; any other line shows once more where the rig stands.
fn choices(after: After) -> String {
    let lines: Vec<String> = after
        .choices()
        .into_iter()
        .map(|(key, _, does)| format!("  type {key}: {does}\n"))
        .collect();
    format!("{}  > ", lines.concat())
}

/// The next line typed. None at the end of the input, which never counts as yes, and on Ctrl-C. While nothing is typed,
/// `meanwhile` is done again and again: a rig must hear from the program however long a person thinks.
///
/// # Errors
/// As `meanwhile`.
pub fn next_line<E>(
    typed: &mut Typed,
    stop_request: &StopRequest,
    mut meanwhile: impl FnMut() -> Result<(), E>,
) -> Result<Option<String>, E> {
    loop {
        match typed.hear() {
            Heard::Line(line) => return Ok(Some(line)),
            Heard::End => return Ok(None),
            Heard::Nothing | Heard::Ready if stop_request.end_requested() => return Ok(None),
            Heard::Nothing | Heard::Ready => meanwhile()?,
        }
    }
}

/// Asks for one motion; only its word is a yes. As [`next_line`].
///
/// # Errors
/// As `meanwhile`.
pub fn agrees<E>(
    typed: &mut Typed,
    question: &Question,
    stop_request: &StopRequest,
    mut meanwhile: impl FnMut() -> Result<(), E>,
) -> Result<bool, E> {
    print_message(&shown(question));
    typed.begin();
    loop {
        match typed.hear() {
            Heard::Ready => print_message(&prompt(question.kind)),
            Heard::Line(line) => match question.kind.answer(&line) {
                Some(yes) => return Ok(yes),
                None => print_message(&prompt(question.kind)),
            },
            Heard::End => return Ok(false),
            Heard::Nothing if stop_request.end_requested() => return Ok(false),
            Heard::Nothing => {}
        }
        meanwhile()?;
    }
}

#[cfg(test)]
mod tests;
