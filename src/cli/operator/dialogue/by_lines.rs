//! An operator who answers questions by typing lines: on a terminal too small for the screen, and for manual moves. In: lines. Out: what
//! the dialogue makes of them. The end of the input never counts as yes.

use std::time::Duration;

use super::typed::{Input, Typed};
use super::{Dialogue, What};
use crate::operator::question::{Question, QuestionKind, WHY_RESUME};
use crate::output::print_message;
use psd::run::Inspection;
use psd_rig::StopRequest;

/// The dialogue in lines.
#[derive(Default)]
pub struct Person {
    dialogue: Dialogue,
    /// The typed lines, after the first question.
    typed: Option<Typed>,
}

impl Person {
    pub fn new(operator: Option<String>) -> Self {
        Self {
            dialogue: Dialogue::new(operator),
            typed: None,
        }
    }

    /// Ends the dialogue: the rig keeps its state.
    pub fn leave(&mut self) {
        self.dialogue.leave();
    }

    /// Asks for one motion; only its confirmation text is a yes. As [`next_line`].
    ///
    /// # Errors
    /// As `meanwhile`.
    pub fn agrees<E>(
        &mut self,
        question: &Question,
        stop_request: &StopRequest,
        mut meanwhile: impl FnMut() -> Result<(), E>,
    ) -> Result<bool, E> {
        loop {
            match self.wait_for(&[], &Inspection::Wait, |dialogue| dialogue.ask(question)) {
                Inspection::Wait if stop_request.end_requested() => self.dialogue.no_answer(),
                Inspection::Wait => meanwhile()?,
                answer => return Ok(matches!(answer, Inspection::GoOn { .. })),
            }
        }
    }

    /// The lines of the terminal.
    pub fn typed(&mut self) -> &mut Typed {
        self.typed.get_or_insert_with(Typed::from_the_terminal)
    }

    /// The result of the dialogue. While there is none, it waits a moment for a line. `state_lines` is the present state of the rig.
    pub fn wait_for<T: PartialEq>(
        &mut self,
        state_lines: &[String],
        none_yet: &T,
        ask: impl Fn(&mut Dialogue) -> T,
    ) -> T {
        let answer = ask(&mut self.dialogue);
        if answer != *none_yet {
            return answer;
        }
        self.listen(state_lines);
        ask(&mut self.dialogue)
    }

    /// Shows a question or choice that has appeared; passes a line to the dialogue.
    fn listen(&mut self, state_lines: &[String]) {
        if self.dialogue.is_new() {
            let question = self.dialogue.question.as_ref();
            print_message(&question.map_or_else(
                || format!("\n  {}\n", state_lines.join("\n  ")),
                Question::text,
            ));
            self.dialogue.drawn(self.dialogue.appeared, Duration::ZERO);
            self.typed().begin();
        }
        match self.typed().read() {
            Input::Nothing => {}
            Input::Ready => print_message(&self.prompt()),
            Input::End if self.dialogue.after.is_some() => self.leave(),
            Input::End => self.dialogue.no_answer(),
            Input::Line(line) => {
                self.entered(&line, state_lines);
                if !self.dialogue.is_new() {
                    print_message(&self.prompt());
                }
            }
        }
    }

    fn entered(&mut self, line: &str, state_lines: &[String]) {
        let dialogue = &mut self.dialogue;
        let what = dialogue.typing.as_ref().map(|typing| typing.what.clone());
        let line = line.trim();
        match (what, line.strip_prefix("i ")) {
            (Some(What::Answer), Some(remark)) => {
                dialogue.line(What::Remark);
                dialogue.enter(remark);
            }
            // No reason: back to the choice.
            (Some(What::Reason), _) if line.is_empty() => dialogue.back_to_the_choice(),
            (Some(_), _) => dialogue.enter(line),
            (None, _) => {
                let key = line.parse().ok();
                match key.and_then(|key| dialogue.after?.choice(key)) {
                    Some(choice) => dialogue.choose(choice),
                    None => print_message(&format!("  {}\n", state_lines.join("\n  "))),
                }
            }
        }
    }

    /// The possible input now; empty if nothing is asked any more. At a choice any other line shows the state of the rig again.
    fn prompt(&self) -> String {
        let dialogue = &self.dialogue;
        let what = dialogue.typing.as_ref().map(|typing| &typing.what);
        match (what, &dialogue.question, dialogue.after) {
            (Some(What::AnswerName { .. }), ..) => "  your name? ".to_owned(),
            (Some(What::Reason), ..) => {
                format!("  {WHY_RESUME}\n  type the reason, or nothing: back > ")
            }
            (_, Some(question), _) => answers(question.kind),
            (None, None, Some(after)) if !dialogue.unload && dialogue.chosen.is_none() => {
                let choices = after.choices().into_iter();
                let lines: Vec<String> = choices
                    .map(|(key, _, does)| format!("  type {key}: {does}\n"))
                    .collect();
                format!("{}  > ", lines.concat())
            }
            _ => String::new(),
        }
    }
}

/// The possible input at a question.
fn answers(kind: QuestionKind) -> String {
    let remark = if kind == QuestionKind::Jog {
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

#[cfg(test)]
mod tests;
