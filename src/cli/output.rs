//! The two streams: what is told to a person goes to standard error, results to standard output. A reader that went
//! away (`psd explain | head`) is no failure; a full disk behind standard output is.

use std::io::{ErrorKind, Write as _};

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
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(inert::terminal(text).as_bytes()).and_then(|()| stdout.flush()) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(false),
        Err(error) => Err(Failure::Stdout(error)),
    }
}
