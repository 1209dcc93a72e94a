//! The terminal while the screen is on: raw mode, alternate page, no cursor. In: frames. Out: keys. The terminal is restored on every
//! exit. A closed terminal is reported and never waited for. Input is read here, byte by byte. An event queue is not used, because it can
//! lose a key when the window size changes.

use std::io::{BufWriter, Stderr, Write as _, stderr};
use std::mem::ManuallyDrop;
use std::sync::Once;
use std::time::Duration;

use ratatui::Terminal;
use ratatui::backend::CrosstermBackend;
use ratatui::crossterm::cursor::Show;
use ratatui::crossterm::execute;
use ratatui::crossterm::terminal::{
    EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode, enable_raw_mode, size,
};
use rustix::event::{PollFd, PollFlags, Timespec, poll};

use super::draw::{SMALLEST, View, draw};
use crate::operator::dialogue::keys::{Key, Keyboard};

/// The terminal is closed.
#[derive(Clone, Copy, Debug)]
pub struct TerminalLost;

/// Drawn on standard error: standard output may be a pipe.
pub struct Page {
    /// Never dropped. The destructor prints an error if it cannot show the cursor of a closed terminal. That print panics, and a panic
    /// puts the rig on hold. [`restore`] shows the cursor.
    terminal: ManuallyDrop<Terminal<CrosstermBackend<BufWriter<Stderr>>>>,
    keyboard: Keyboard,
}

/// Whether the terminal is large enough for the screen.
pub fn is_large_enough() -> bool {
    size().is_ok_and(|(columns, rows)| columns >= SMALLEST.0 && rows >= SMALLEST.1)
}

impl Page {
    /// Sets up the terminal.
    pub fn open() -> Result<Self, TerminalLost> {
        static HOOK: Once = Once::new();
        HOOK.call_once(|| {
            // The message of a panic must appear on the normal page.
            let before = std::panic::take_hook();
            std::panic::set_hook(Box::new(move |panic| {
                restore();
                before(panic);
            }));
        });
        enable_raw_mode().map_err(|_| TerminalLost)?;
        let opened = execute!(stderr(), EnterAlternateScreen).and_then(|()| {
            Terminal::new(CrosstermBackend::new(BufWriter::with_capacity(
                1 << 14,
                stderr(),
            )))
        });
        let Ok(terminal) = opened else {
            restore();
            return Err(TerminalLost);
        };
        Ok(Self {
            terminal: ManuallyDrop::new(terminal),
            keyboard: Keyboard::default(),
        })
    }

    pub fn draw(&mut self, view: &View<'_>) -> Result<(), TerminalLost> {
        self.terminal
            .draw(|frame| draw(frame, view))
            .map(|_| ())
            .map_err(|_| TerminalLost)
    }

    /// Rings the bell, for an operator who does not look at the screen.
    pub fn ring() {
        let _ = stderr().write_all(b"\x07").and_then(|()| stderr().flush());
    }

    /// The keys pressed within the time-out.
    pub fn keys(&mut self, timeout: Duration) -> Result<Vec<Key>, TerminalLost> {
        if !has_input(timeout)? {
            self.keyboard.quiet();
            return Ok(Vec::new());
        }
        let mut typed = [0; 256];
        match rustix::io::read(std::io::stdin(), &mut typed) {
            Ok(0) => Err(TerminalLost),
            Ok(count) => Ok(self.keyboard.typed(&typed[..count])),
            Err(rustix::io::Errno::INTR | rustix::io::Errno::AGAIN) => Ok(Vec::new()),
            Err(_) => Err(TerminalLost),
        }
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        restore();
    }
}

/// Restores the terminal. A second call has no effect.
fn restore() {
    let _ = disable_raw_mode();
    let _ = execute!(stderr(), LeaveAlternateScreen, Show);
    let _ = stderr().flush();
}

/// Whether a key is waiting. psd reads only if there is input: the read never blocks, and ends immediately on a closed terminal.
fn has_input(timeout: Duration) -> Result<bool, TerminalLost> {
    let stdin = std::io::stdin();
    let mut watched = [PollFd::new(&stdin, PollFlags::IN)];
    let wait = Timespec {
        tv_sec: timeout.as_secs().try_into().unwrap_or(1),
        tv_nsec: timeout.subsec_nanos().into(),
    };
    match poll(&mut watched, Some(&wait)) {
        // No input yet; or for example the window size changed.
        Ok(0) | Err(rustix::io::Errno::INTR) => Ok(false),
        Err(_) => Err(TerminalLost),
        Ok(_) => {
            let found = watched[0].revents();
            let gone = found.intersects(PollFlags::HUP | PollFlags::ERR | PollFlags::NVAL);
            let readable = rustix::io::ioctl_fionread(&stdin).is_ok_and(|bytes| bytes > 0);
            if gone || !readable {
                Err(TerminalLost)
            } else {
                Ok(true)
            }
        }
    }
}
