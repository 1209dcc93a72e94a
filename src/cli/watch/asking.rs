//! A person who answers inspections by typing lines: on a terminal too small for the screen. In: lines. Out: an answer
//! with its remark and name. The end of the input never counts as yes.

use std::io::BufRead as _;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use crate::cli::output::tell;
use crate::diagnostic::excerpt::escape;
use crate::rig::Wish;
use crate::run::Inspection;

/// How long one look for an answer takes: Ctrl-C and the rig are heard between two.
const LOOK: Duration = Duration::from_millis(50);

/// Where the conversation is.
#[derive(Default)]
pub struct Person {
    /// The lines typed, once anything has been asked.
    lines: Option<Receiver<String>>,
    state: State,
    /// What is asked is whether to unload.
    unload: bool,
}

#[derive(Default)]
enum State {
    #[default]
    Silent,
    /// Asked whether to go on.
    Asked,
    /// Asked for the name to this answer.
    Naming(Inspection),
}

impl Person {
    /// Asks, or looks for an answer to what was asked. A name once given is kept.
    pub fn ask(&mut self, note: &str, operator: &mut Option<String>) -> Inspection {
        if matches!(self.state, State::Silent) {
            let what = if self.unload { "" } else { "inspect: " };
            tell(&format!("\n  {what}{}\n", escape(note)));
            self.question();
        }
        let lines = self.lines.get_or_insert_with(typed_lines);
        match lines.recv_timeout(LOOK) {
            Ok(line) => self.heard(&line, operator),
            Err(RecvTimeoutError::Timeout) => Inspection::Wait,
            Err(RecvTimeoutError::Disconnected) => {
                self.state = State::Silent;
                Inspection::Stop { reason: "no answer at an inspection".to_owned(), by: None }
            }
        }
    }

    /// Asks whether a rig that a person stopped is to unload. The run has ended: the end of the input is no answer at all.
    pub fn ask_to_unload(&mut self, question: &str, operator: &mut Option<String>) -> Option<Inspection> {
        if !std::mem::replace(&mut self.unload, true) {
            self.state = State::Silent;
        }
        match self.ask(question, operator) {
            Inspection::Stop { by: None, .. } => None,
            Inspection::Stop { by, .. } => Some(Inspection::Stop { reason: "no".to_owned(), by }),
            answer => Some(answer),
        }
    }

    fn question(&mut self) {
        tell(if self.unload {
            "  unload? [y and it MOVES, n and it stays held] "
        } else {
            "  go on? [y, y and a note for the record, or n to stop here] "
        });
        self.state = State::Asked;
    }

    fn heard(&mut self, line: &str, operator: &mut Option<String>) -> Inspection {
        let answer = match std::mem::take(&mut self.state) {
            State::Naming(answer) => {
                let name = escape(line.trim());
                if !name.is_empty() {
                    *operator = Some(name);
                }
                answer
            }
            State::Silent | State::Asked => {
                let Some(answer) = answer(line) else {
                    self.question();
                    return Inspection::Wait;
                };
                answer
            }
        };
        let by = operator.clone();
        if by.is_none() {
            tell("  your name? ");
            self.state = State::Naming(answer);
            return Inspection::Wait;
        }
        match answer {
            Inspection::GoOn { note, .. } => Inspection::GoOn { note, by },
            Inspection::Stop { reason, .. } => Inspection::Stop { reason, by },
            Inspection::Wait => Inspection::Wait,
        }
    }
}

/// `y`, `y and what was seen`, `n`; anything else is no answer.
fn answer(line: &str) -> Option<Inspection> {
    let line = line.trim();
    let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    match word.to_ascii_lowercase().as_str() {
        "y" | "yes" => {
            let note = escape(rest.trim());
            Some(Inspection::GoOn { note: (!note.is_empty()).then_some(note), by: None })
        }
        "n" | "no" | "stop" => Some(Inspection::Stop { reason: "stopped by a person at an inspection".to_owned(), by: None }),
        _ => None,
    }
}

/// The next line typed. None at the end of the input, which never counts as yes, and on Ctrl-C. While nothing is typed,
/// `meanwhile` is done again and again: a rig must hear from the program however long a person thinks.
///
/// # Errors
/// As `meanwhile`.
pub fn next_line<E>(
    lines: &Receiver<String>,
    wish: &Wish,
    mut meanwhile: impl FnMut() -> Result<(), E>,
) -> Result<Option<String>, E> {
    loop {
        match lines.recv_timeout(LOOK) {
            Ok(line) => return Ok(Some(line)),
            Err(RecvTimeoutError::Disconnected) => return Ok(None),
            Err(RecvTimeoutError::Timeout) if wish.wants_end() => return Ok(None),
            Err(RecvTimeoutError::Timeout) => meanwhile()?,
        }
    }
}

/// Lines of standard input, read beside the run: a read that waits must not keep Ctrl-C from being heard.
pub fn typed_lines() -> Receiver<String> {
    let (send, receive) = channel();
    std::thread::spawn(move || {
        for line in std::io::stdin().lock().lines() {
            let Ok(line) = line else { break };
            if send.send(line).is_err() {
                break;
            }
        }
    });
    receive
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What comes of these lines and then the end of the input.
    fn said(lines: &[&str], operator: Option<&str>) -> Inspection {
        let (send, receive) = channel();
        for line in lines {
            send.send((*line).to_owned()).unwrap();
        }
        drop(send);
        let mut person = Person { lines: Some(receive), ..Person::default() };
        let mut operator = operator.map(str::to_owned);
        loop {
            match person.ask("look", &mut operator) {
                Inspection::Wait => {}
                answer => return answer,
            }
        }
    }

    #[test]
    fn only_a_clear_yes_with_a_name_goes_on() {
        let by = |name: &str| Some(name.to_owned());
        assert_eq!(said(&["y"], Some("A")), Inspection::GoOn { note: None, by: by("A") });
        let note = Some("crack at\\u{7} midspan".to_owned());
        assert_eq!(said(&["what", " Yes crack at\u{7} midspan ", "", "B"], None), Inspection::GoOn { note, by: by("B") });
        assert!(matches!(said(&["no"], Some("A")), Inspection::Stop { by: Some(_), .. }));
        assert_eq!((answer(""), answer("yesterday"), answer("go")), (None, None, None));
    }

    #[test]
    fn a_line_ends_with_the_input_and_with_ctrl_c() {
        let wish = Wish::default();
        let (send, receive) = channel();
        send.send("y".to_owned()).unwrap();
        drop(send);
        let line = |receive: &Receiver<String>| next_line(receive, &wish, || Ok::<_, ()>(()));
        assert_eq!(line(&receive), Ok(Some("y".to_owned())));
        assert_eq!(line(&receive), Ok(None));
        let (kept, receive) = channel();
        wish.stop_after_step();
        assert_eq!(line(&receive), Ok(None), "Ctrl-C while a question waits");
        let wish = Wish::default();
        let mut looks = 0;
        let heard = next_line(&receive, &wish, || {
            looks += 1;
            if looks == 3 { kept.send("late".to_owned()) } else { Ok(()) }
        });
        assert_eq!((heard, looks), (Ok(Some("late".to_owned())), 3), "the rig is heard from while a person thinks");
        let (_kept, receive) = channel::<String>();
        assert_eq!(next_line(&receive, &wish, || Err("it trips")), Err("it trips"));
    }

    #[test]
    fn the_end_of_the_input_is_no_yes() {
        for lines in [&[][..], &["yesterday"], &["y"], &["y", " "]] {
            assert!(matches!(said(lines, None), Inspection::Stop { by: None, .. }), "{lines:?}");
        }
    }
}
