//! Watching a run from a terminal: a progress bar, the questions at inspections, and Ctrl-C. In: what the run tells
//! its observer. Out: answers. Without a terminal there is no bar and nobody is asked.

use std::io::{BufRead as _, Write as _};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::output::tell;
use super::settings::Settings;
use crate::diagnostic::excerpt::escape;
use crate::quantity::Dimension;
use crate::quantity::display::readable;
use crate::run::{Inspection, Observer, StepReport};

/// How often a question looks whether Ctrl-C was pressed.
const LOOK: Duration = Duration::from_millis(50);

/// The observer of `psd run`.
pub struct Watcher {
    /// None without a terminal.
    styles: Option<Styles>,
    bar: Option<ProgressBar>,
    stop: Arc<AtomicBool>,
    asking: Asking,
}

/// Who answers at an inspection.
enum Asking {
    /// `--yes`
    Yes,
    /// A person at the terminal; the lines they type, once they have been asked.
    Person(Option<Receiver<String>>),
    /// No terminal, and nothing real moves.
    NobodyNeeded,
    /// No terminal, and a real rig waits for an answer that cannot come.
    Nobody,
}

impl Watcher {
    /// Watches a run on a simulated or a real rig, and catches the signals that end it.
    pub fn new(settings: Settings, yes: bool, simulated: bool) -> std::io::Result<Self> {
        let stop = Arc::new(AtomicBool::new(false));
        for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM, signal_hook::consts::SIGHUP] {
            signal_hook::flag::register(signal, Arc::clone(&stop))?;
        }
        let asking = match (yes, settings.can_ask, simulated) {
            (true, ..) => Asking::Yes,
            (false, true, _) => Asking::Person(None),
            (false, false, true) => Asking::NobodyNeeded,
            (false, false, false) => Asking::Nobody,
        };
        Ok(Self { styles: settings.stderr_terminal.then(|| Styles::new(settings.unicode)), bar: None, stop, asking })
    }

    /// Takes the bar off the terminal.
    pub fn finish(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }

    fn ask(&mut self, note: &str) -> Inspection {
        let Asking::Person(lines) = &mut self.asking else { unreachable!("only a person is asked") };
        let lines = lines.get_or_insert_with(typed_lines);
        let stop = &self.stop;
        let question = || {
            tell(&format!("\n  inspect: {}\n", escape(note)));
            loop {
                tell("  go on? [y, y and a note for the record, or n to stop here] ");
                let _ = std::io::stderr().flush();
                match next_line(lines, stop) {
                    Some(line) => {
                        if let Some(answer) = answer(&line) {
                            return answer;
                        }
                    }
                    None => return Inspection::Stop { reason: "no answer at an inspection".to_owned(), by: None },
                }
            }
        };
        match &self.bar {
            Some(bar) => bar.suspend(question),
            None => question(),
        }
    }
}

impl Observer for Watcher {
    fn procedure_started(&mut self, name: &str, keyword: &str, steps: Option<u64>) {
        let Some(styles) = &self.styles else { return };
        let style = if steps.is_some() { styles.counted.clone() } else { styles.endless.clone() };
        self.finish();
        let bar = ProgressBar::with_draw_target(steps, ProgressDrawTarget::stderr()).with_style(style);
        bar.set_prefix(format!("{name}, {keyword}"));
        self.bar = Some(bar);
    }

    fn step_done(&mut self, &StepReport { step, time, displacement, force, .. }: &StepReport) {
        let Some(bar) = &self.bar else { return };
        bar.set_position(step);
        // Most steps are never drawn: words are made for some only.
        if step.is_multiple_of(16) {
            let (time, displacement) = (readable(time, Dimension::TIME), readable(displacement, Dimension::LENGTH));
            bar.set_message(format!("{time}  {displacement}  {}", readable(force, Dimension::FORCE)));
        }
    }

    fn procedure_finished(&mut self, _: &str) {
        self.finish();
    }

    fn stop_requested(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    fn inspect(&mut self, note: &str) -> Inspection {
        match self.asking {
            Asking::Yes => Inspection::GoOn { note: Some("answered by --yes".to_owned()), by: None },
            Asking::NobodyNeeded => Inspection::GoOn { note: Some("nobody was asked: simulated rig, no terminal".to_owned()), by: None },
            Asking::Nobody => Inspection::Stop { reason: "nobody to ask at an inspection: no terminal, and no --yes".to_owned(), by: None },
            Asking::Person(_) => self.ask(note),
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

/// The next line typed. None at the end of the input, which never counts as yes, and on Ctrl-C.
fn next_line(lines: &Receiver<String>, stop: &AtomicBool) -> Option<String> {
    loop {
        match lines.recv_timeout(LOOK) {
            Ok(line) => return Some(line),
            Err(RecvTimeoutError::Disconnected) => return None,
            Err(RecvTimeoutError::Timeout) if stop.load(Ordering::Relaxed) => return None,
            Err(RecvTimeoutError::Timeout) => {}
        }
    }
}

/// Lines of standard input, read beside the run: a read that waits must not keep Ctrl-C from being heard.
fn typed_lines() -> Receiver<String> {
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

/// How the bar looks where the number of steps is known before, and where it is not.
struct Styles {
    counted: ProgressStyle,
    endless: ProgressStyle,
}

impl Styles {
    fn new(unicode: bool) -> Self {
        let template = |text| ProgressStyle::with_template(text).unwrap_or_else(|_| ProgressStyle::default_bar());
        let filled = if unicode { "━╸ " } else { "=> " };
        Self {
            counted: template("  {prefix}  {bar:28} {percent:>3} %  {msg}").progress_chars(filled),
            endless: template("  {prefix}  step {pos}  {msg}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_clear_yes_goes_on() {
        assert_eq!(answer("y"), Some(Inspection::go_on()));
        assert_eq!(answer(" Yes crack at\u{7} midspan "), Some(Inspection::GoOn { note: Some("crack at\\u{7} midspan".into()), by: None }));
        assert!(matches!(answer("no"), Some(Inspection::Stop { .. })));
        assert_eq!((answer(""), answer("yesterday"), answer("go")), (None, None, None));
    }

    #[test]
    fn the_end_of_the_input_is_no_yes() {
        let (send, receive) = channel();
        send.send("y".to_owned()).unwrap();
        drop(send);
        let stop = AtomicBool::new(false);
        assert_eq!(next_line(&receive, &stop).as_deref(), Some("y"));
        assert_eq!(next_line(&receive, &stop), None);
        let (_kept, receive) = channel();
        stop.store(true, Ordering::Relaxed);
        assert_eq!(next_line(&receive, &stop), None, "Ctrl-C while a question waits");
    }

    #[test]
    fn a_real_rig_stops_where_nobody_can_be_asked() {
        let settings = Settings { color: false, stdout_color: false, unicode: true, stderr_terminal: false, can_ask: false };
        let ask = |yes, simulated| Watcher::new(settings, yes, simulated).unwrap().inspect("look");
        assert!(matches!(ask(false, false), Inspection::Stop { .. }));
        assert!(matches!(ask(true, false), Inspection::GoOn { ..}));
        assert!(matches!(ask(false, true), Inspection::GoOn { ..}));
    }
}
