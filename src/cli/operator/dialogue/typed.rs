//! Lines typed on a terminal during a run. In: lines, a clock. Out: the lines that count for the open question. Input typed before it
//! could be read is discarded.

use std::io::BufRead as _;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, LazyLock, Mutex, PoisonError};
use std::time::{Duration, Instant};

use rustix::termios::{QueueSelector, tcflush};

use crate::operator::question::DEAF;

/// Duration of one wait for a line: Ctrl-C and the rig are checked between two waits.
const LOOK: Duration = Duration::from_millis(50);

/// Standard input, read in parallel with the run: a read that waits must not delay Ctrl-C. There is one for the program: the answers to a
/// resumed run are the lines after those of the run before it.
static STANDARD_INPUT: LazyLock<Arc<Mutex<Receiver<String>>>> = LazyLock::new(|| {
    let (send, lines) = channel();
    std::thread::spawn(move || {
        for line in std::io::stdin().lock().lines() {
            let Ok(line) = line else { break };
            if send.send(line).is_err() {
                break;
            }
        }
    });
    Arc::new(Mutex::new(lines))
});

/// The result of a wait for a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Input {
    Nothing,
    /// From here on lines count: the answer can be asked for.
    Ready,
    Line(String),
    /// The end of the input.
    End,
}

/// The lines of a terminal.
pub struct Typed {
    lines: Arc<Mutex<Receiver<String>>>,
    clock: Box<dyn Fn() -> Duration>,
    /// Input before this time does not count.
    deaf_until: Option<Duration>,
    /// Discards the unread input of the terminal.
    flush: fn(),
}

impl Typed {
    /// Standard input.
    pub fn from_the_terminal() -> Self {
        throw_away();
        let began = Instant::now();
        let clock = Box::new(move || began.elapsed());
        Self {
            lines: Arc::clone(&STANDARD_INPUT),
            clock,
            deaf_until: None,
            flush: throw_away,
        }
    }

    #[cfg(test)]
    pub fn of(lines: Receiver<String>, clock: Box<dyn Fn() -> Duration>) -> Self {
        Self {
            lines: Arc::new(Mutex::new(lines)),
            clock,
            deaf_until: None,
            flush: || (),
        }
    }

    /// A question has been shown: input before it and in its first second does not count.
    pub fn begin(&mut self) {
        self.forget();
        self.deaf_until = Some((self.clock)() + DEAF);
    }

    /// Waits a moment for a line.
    pub fn read(&mut self) -> Input {
        let line = self
            .lines
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .recv_timeout(LOOK);
        if let Some(until) = self.deaf_until {
            if line == Err(RecvTimeoutError::Disconnected) {
                return Input::End;
            }
            if (self.clock)() < until {
                return Input::Nothing;
            }
            self.forget();
            self.deaf_until = None;
            return Input::Ready;
        }
        match line {
            Ok(line) => Input::Line(line),
            Err(RecvTimeoutError::Timeout) => Input::Nothing,
            Err(RecvTimeoutError::Disconnected) => Input::End,
        }
    }

    fn forget(&self) {
        (self.flush)();
        let lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner);
        while lines.try_recv().is_ok() {}
    }
}

/// Discards the unread input of the terminal.
pub fn throw_away() {
    // Standard input that is not a terminal has no early input.
    let _ = tcflush(std::io::stdin(), QueueSelector::IFlush);
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;
    use std::rc::Rc;

    use super::*;

    #[test]
    fn what_was_typed_before_a_question_could_be_read_does_not_count() {
        let (send, lines) = channel();
        let now = Rc::new(Cell::new(Duration::ZERO));
        let clock = Rc::clone(&now);
        let mut typed = Typed::of(lines, Box::new(move || clock.get()));
        let type_line = |line: &str| send.send(line.to_owned()).unwrap();
        type_line("before");
        typed.begin();
        assert_eq!(typed.read(), Input::Nothing);
        now.set(Duration::from_millis(999));
        type_line("RELEASE");
        assert_eq!(typed.read(), Input::Nothing, "in its first second");
        type_line("still there when the second is over");
        now.set(Duration::from_secs(1));
        assert_eq!(typed.read(), Input::Ready);
        assert_eq!(typed.read(), Input::Nothing);
        type_line("RELEASE");
        assert_eq!(typed.read(), Input::Line("RELEASE".to_owned()));
        type_line("for the next");
        typed.begin();
        now.set(Duration::from_secs(5));
        assert_eq!((typed.read(), typed.read()), (Input::Ready, Input::Nothing));
        drop(send);
        typed.begin();
        assert_eq!(typed.read(), Input::End);
    }
}
