//! An operator at a terminal: a pseudo-terminal too small for the screen, or large enough. In: the typed keys. Out: a program
//! whose questions are answered, or not.

use std::fs::File;
use std::io::{ErrorKind, Read as _, Write as _};
use std::os::unix::ffi::OsStrExt as _;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use rustix::process::Signal;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{Winsize, tcsetwinsize};

use crate::stage::{PATIENCE, signal, until};

/// The text after each question once it can be answered, in line mode.
pub const RELEASE: &str = "type RELEASE, or n: nothing moves";
pub const GO_ON: &str = "type RELEASE, or n: the run ends here";
pub const UNLOAD: &str = "type UNLOAD, or n: it stays HELD";
pub const TO_UNLOAD: &str = "type u: unload";
pub const TO_RESUME: &str = "type r: resume";
pub const LEAVE: &str = "type x: leave; the rig stays HELD";
pub const MOVE: &str = "type MOVE, or n: nothing moves";

pub struct Terminal {
    pub child: Child,
    keys: File,
    shown: Arc<Mutex<Vec<u8>>>,
    closed: Arc<AtomicBool>,
    reader: JoinHandle<()>,
    /// Length of the output that is already checked.
    read: usize,
}

impl Terminal {
    /// Starts a program with an operator at its terminal.
    pub fn start(command: &mut Command) -> Self {
        Self::of_size(0, command)
    }

    /// Starts a program that uses the whole screen.
    pub fn with_screen(command: &mut Command) -> Self {
        Self::of_size(
            100,
            command
                .env("TERM", "xterm-256color")
                .env("LC_ALL", "C.UTF-8"),
        )
    }

    fn of_size(columns: u16, command: &mut Command) -> Self {
        // No program started meanwhile inherits it.
        let keys = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC).unwrap();
        grantpt(&keys).unwrap();
        unlockpt(&keys).unwrap();
        tcsetwinsize(&keys, size(columns)).unwrap();
        let name = ptsname(&keys, Vec::new()).unwrap();
        let path = std::ffi::OsStr::from_bytes(name.as_bytes());
        let end = File::options().read(true).write(true).open(path).unwrap();
        let (output, error) = (end.try_clone().unwrap(), end.try_clone().unwrap());
        let child = command
            .stdin(end)
            .stdout(output)
            .stderr(error)
            .spawn()
            .unwrap();
        // Only the program has the terminal: its output ends when the program does.
        command
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        let shown = Arc::new(Mutex::new(Vec::new()));
        // Read without waiting, so that it can be closed at any time.
        rustix::io::ioctl_fionbio(&keys, true).unwrap();
        let (mut screen, sink) = (File::from(keys.try_clone().unwrap()), Arc::clone(&shown));
        let closed = Arc::new(AtomicBool::new(false));
        let close = Arc::clone(&closed);
        let reader = std::thread::spawn(move || {
            let mut buffer = [0; 4096];
            while !close.load(Ordering::SeqCst) {
                match screen.read(&mut buffer) {
                    Ok(count) => sink.lock().unwrap().extend_from_slice(&buffer[..count]),
                    Err(error) if error.kind() == ErrorKind::WouldBlock => {
                        std::thread::sleep(Duration::from_millis(2));
                    }
                    // A terminal with no more output ends with an error.
                    Err(_) => return,
                }
            }
        });
        Self {
            child,
            keys: File::from(keys),
            shown,
            closed,
            reader,
            read: 0,
        }
    }

    /// Closes the window. Returns the program and its output until then.
    pub fn dies(self) -> (Child, String) {
        let shown = self.shown();
        let Self {
            child,
            keys,
            closed,
            reader,
            ..
        } = self;
        closed.store(true, Ordering::SeqCst);
        reader.join().unwrap();
        drop(keys);
        (child, shown)
    }

    /// Waits until the program has ended and its last output is read.
    pub fn code(&mut self) -> Option<i32> {
        let since = Instant::now();
        let status = loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                break status;
            }
            assert!(
                since.elapsed() < PATIENCE,
                "a program did not come to its end: {}",
                self.shown()
            );
            std::thread::sleep(Duration::from_millis(5));
        };
        until("the end of the output", || self.reader.is_finished());
        status.code()
    }

    pub fn shown(&self) -> String {
        String::from_utf8_lossy(&self.shown.lock().unwrap()).into_owned()
    }

    pub fn press(&mut self, keys: &str) {
        self.keys.write_all(keys.as_bytes()).unwrap();
    }

    /// Waits until this text is drawn again.
    pub fn redrawn(&self, text: &str) {
        let before = self.shown().len();
        until(text, || {
            self.shown()
                .get(before..)
                .is_some_and(|shown| shown.contains(text))
        });
    }

    /// Changes the size of the window, as a window manager does.
    pub fn resize(&self, columns: u16) {
        tcsetwinsize(&self.keys, size(columns)).unwrap();
        signal(&self.child, Signal::WINCH);
    }

    /// Waits for a question after the last one, then types.
    pub fn answer(&mut self, question: &str, keys: &str) {
        let behind = |shown: &str| {
            shown
                .get(self.read..)
                .and_then(|new| new.find(question))
                .map(|at| self.read + at + question.len())
        };
        until(question, || behind(&self.shown()).is_some());
        self.read = behind(&self.shown()).unwrap();
        self.press(keys);
    }

    /// Waits until this text is on the screen, which is redrawn completely only after a change of its size.
    pub fn drawn(&self, text: &str) {
        let mut columns = 100;
        until(text, || {
            columns = 210 - columns;
            let before = self.shown().len();
            self.resize(columns);
            std::thread::sleep(Duration::from_millis(300));
            self.shown()
                .get(before..)
                .is_some_and(|shown| shown.contains(text))
        });
    }
}

const fn size(columns: u16) -> Winsize {
    Winsize {
        ws_row: if columns == 0 { 0 } else { 30 },
        ws_col: columns,
        ws_xpixel: 0,
        ws_ypixel: 0,
    }
}
