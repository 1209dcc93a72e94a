//! An operator who answers questions by typing lines: on a terminal too small for the screen, and for manual moves. In: lines. Out: an
//! answer with its remark and name, or the choice for a rig on hold. The end of the input never counts as yes.

use super::Stay;
use super::typed::{Input, Typed};
use crate::cli::operator::question::{After, Choice, Kind, Question, WHY_RESUME};
use crate::cli::output::print_message;
use crate::rig::StopRequest;
use crate::run::Inspection;
use crate::text::diagnostic::excerpt::escape;

/// State of the dialogue.
#[derive(Default)]
pub struct Person {
    /// The typed lines, after the first question.
    typed: Option<Typed>,
    state: State,
    /// The remark to the open question.
    remark: Option<String>,
    /// The rig is to unload: its question comes next.
    unload: bool,
    /// The final choice for a rig on hold.
    chosen: Option<Stay>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    #[default]
    Silent,
    Asked(Kind),
    /// Asks for the name to this answer.
    Naming(Kind, bool),
    /// Asks for the choice after the early end of a run.
    Choosing(After),
    /// Asks for the reason to resume.
    Resuming(After),
}

impl Person {
    /// Asks, or checks for an answer to the open question. A name is asked for only once.
    pub fn ask(&mut self, question: &Question, operator: &mut Option<String>) -> Inspection {
        let kind = question.kind;
        if !matches!(self.state, State::Asked(asked) | State::Naming(asked, _) if asked == kind) {
            self.show(question);
            self.remark = None;
            self.state = State::Asked(kind);
        }
        match self.typed().read() {
            Input::Nothing => Inspection::Wait,
            Input::Ready => {
                print_message(&prompt(kind));
                Inspection::Wait
            }
            Input::Line(line) => self.answered(&line, operator),
            Input::End => {
                self.state = State::Silent;
                kind.unanswered()
            }
        }
    }

    /// The run has ended early, and the rig is on hold: asks whether it is to unload. None: it stays on hold. `state_lines` is the present state
    /// of the rig in lines.
    pub fn ask_to_unload(
        &mut self,
        question: &Question,
        state_lines: &[String],
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
                state_lines,
            );
        }
        self.chosen.is_none().then_some(Inspection::Wait)
    }

    /// The operator's choice after the early end of the run.
    pub fn stay(&mut self, after: After, state_lines: &[String]) -> Stay {
        // An operator who left a rig on hold has not seen that the hold is no longer confirmed.
        if after == After::NotHeld && self.state != State::Choosing(after) {
            self.chosen = None;
        }
        if self.chosen.is_none() {
            self.choose(after, state_lines);
        }
        self.chosen.clone().unwrap_or(Stay::Wait)
    }

    /// Ends the dialogue: the rig keeps its state.
    pub fn leave(&mut self) {
        (self.unload, self.chosen) = (false, Some(Stay::Leave));
    }

    /// Shows the available choices, or checks for the choice.
    fn choose(&mut self, after: After, state_lines: &[String]) {
        if ![State::Choosing(after), State::Resuming(after)].contains(&self.state) {
            print_message(&format!("\n  {}\n", state_lines.join("\n  ")));
            self.typed().begin();
            self.state = State::Choosing(after);
        }
        match self.typed().read() {
            Input::Nothing => {}
            Input::Ready => print_message(&choices(after)),
            Input::End => self.leave(),
            Input::Line(line) if self.state == State::Resuming(after) => {
                match escape(line.trim()) {
                    // No reason: back to the choice.
                    reason if reason.is_empty() => self.state = State::Silent,
                    reason => self.chosen = Some(Stay::Resume(reason)),
                }
            }
            Input::Line(line) => match line.trim().parse().ok().and_then(|key| after.choice(key)) {
                Some(Choice::Leave) => self.leave(),
                Some(Choice::Unload) => self.unload = true,
                Some(Choice::Resume) => {
                    print_message(&format!(
                        "  {WHY_RESUME}\n  type the reason, or nothing: back > "
                    ));
                    self.state = State::Resuming(after);
                }
                None => print_message(&format!(
                    "  {}\n{}",
                    state_lines.join("\n  "),
                    choices(after)
                )),
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

    fn answered(&mut self, line: &str, operator: &mut Option<String>) -> Inspection {
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
        kind.to_inspection(yes, self.remark.take(), by)
    }
}

/// The text of a question in lines.
fn shown(question: &Question) -> String {
    format!(
        "\n  {}\n  {}\n",
        question.kind.title(),
        question.lines.join("\n  ")
    )
}

/// The possible input at a question.
fn prompt(kind: Kind) -> String {
    let remark = if kind == Kind::Jog {
        ""
    } else {
        ", or i and an observation for the run log"
    };
    format!(
        "  type {}, or n: {}{remark} > ",
        kind.word(),
        kind.declined()
    )
}

/// The possible input after the early end of a run; any other line shows the state of the rig again.
fn choices(after: After) -> String {
    let lines: Vec<String> = after
        .choices()
        .into_iter()
        .map(|(key, _, does)| format!("  type {key}: {does}\n"))
        .collect();
    format!("{}  > ", lines.concat())
}

/// The next line typed. None at the end of the input, which never counts as yes, and on Ctrl-C. While there is no input, `meanwhile` is
/// repeated: the rig must be polled however long the operator thinks.
///
/// # Errors
/// As `meanwhile`.
pub fn next_line<E>(
    typed: &mut Typed,
    stop_request: &StopRequest,
    mut meanwhile: impl FnMut() -> Result<(), E>,
) -> Result<Option<String>, E> {
    loop {
        match typed.read() {
            Input::Line(line) => return Ok(Some(line)),
            Input::End => return Ok(None),
            Input::Nothing | Input::Ready if stop_request.end_requested() => return Ok(None),
            Input::Nothing | Input::Ready => meanwhile()?,
        }
    }
}

/// Asks for one motion; only its confirmation text is a yes. As [`next_line`].
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
        match typed.read() {
            Input::Ready => print_message(&prompt(question.kind)),
            Input::Line(line) => match question.kind.answer(&line) {
                Some(yes) => return Ok(yes),
                None => print_message(&prompt(question.kind)),
            },
            Input::End => return Ok(false),
            Input::Nothing if stop_request.end_requested() => return Ok(false),
            Input::Nothing => {}
        }
        meanwhile()?;
    }
}

#[cfg(test)]
mod tests;
