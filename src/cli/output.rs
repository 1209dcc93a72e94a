//! The two streams: what is told to a person goes to standard error, results to standard output. A reader that went
//! away (`psd explain | head`, a terminal that was closed) is no failure; a full disk behind standard output is.

use std::io::{Error, ErrorKind, Stdout, Write as _};

use rustix::fs::{FileType, fstat};
use rustix::io::Errno;

use super::exit::Failure;
use crate::inert;

/// Tells a person. Nobody listening is no reason to fail. Nothing but colours reaches a terminal as a command.
pub fn tell(text: &str) {
    let _ = std::io::stderr().lock().write_all(inert::terminal(text).as_bytes());
}

/// Gives a result, as [`tell`] does.
pub fn give(text: &str) -> Result<(), Failure> {
    give_on(text).map(drop)
}

/// [`give`], and whether anybody reads on: what would never end by itself ends with its reader.
pub fn give_on(text: &str) -> Result<bool, Failure> {
    let stdout = std::io::stdout();
    let mut locked = stdout.lock();
    match locked.write_all(inert::terminal(text).as_bytes()).and_then(|()| locked.flush()) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == ErrorKind::BrokenPipe || is_closed(&stdout, &error) => Ok(false),
        Err(error) => Err(Failure::Stdout(error)),
    }
}

/// Whether this is what a terminal says whose window is gone. A disk that fails says the same, and is none.
fn is_closed(stdout: &Stdout, error: &Error) -> bool {
    let device = || fstat(stdout).is_ok_and(|file| FileType::from_raw_mode(file.st_mode) == FileType::CharacterDevice);
    Errno::from_io_error(error) == Some(Errno::IO) && device()
}
