//! The two streams: what is told to a person goes to standard error, results to standard output. A reader that went
//! away (`psd explain | head`, a terminal that was closed) is no failure; a full disk behind standard output is.

use std::io::{Error, ErrorKind, Stdout, Write as _};

use ratatui::crossterm::terminal::size;
use rustix::fs::{FileType, fstat};
use rustix::io::Errno;

use super::exit::Failure;
use super::settings::Settings;
use crate::text::sanitize;

/// Tells a person. Nobody listening is no reason to fail. Nothing but colours reaches a terminal as a command.
pub fn tell(text: &str) {
    let _ = std::io::stderr()
        .lock()
        .write_all(sanitize::terminal(text).as_bytes());
}

/// Tells a person lines of words: on a terminal none is broken at its edge.
pub fn tell_words(text: &str, settings: Settings) {
    let columns = settings
        .stderr_terminal
        .then(|| size().ok())
        .flatten()
        .map(|(columns, _)| usize::from(columns));
    match columns {
        Some(columns) if columns > 2 * INDENT => tell(&wrapped(text, columns)),
        _ => tell(text),
    }
}

/// How far what goes on from the line above is set in.
const INDENT: usize = 8;

/// Every line broken at its blanks where it is longer than `width`; what only colours takes no room.
fn wrapped(text: &str, width: usize) -> String {
    let mut all = String::new();
    for line in text.split_inclusive('\n') {
        let mut length = 0;
        for word in line.split_inclusive(' ') {
            let shown = letters(word.trim_end());
            if length > INDENT && length + shown > width {
                all.truncate(all.trim_end_matches(' ').len());
                all.push('\n');
                all.push_str(&" ".repeat(INDENT));
                length = INDENT;
            }
            all.push_str(word);
            length += letters(word.trim_end_matches('\n'));
        }
    }
    all
}

/// How many letters a terminal shows of it.
fn letters(text: &str) -> usize {
    let mut colours = false;
    let seen = text.chars().filter(|letter| {
        let hidden = colours || *letter == '\u{1b}';
        colours = hidden && *letter != 'm';
        !hidden
    });
    seen.count()
}

/// Gives a result, as [`tell`] does.
pub fn give(text: &str) -> Result<(), Failure> {
    give_on(text).map(drop)
}

/// [`give`], and whether anybody reads on: what would never end by itself ends with its reader.
pub fn give_on(text: &str) -> Result<bool, Failure> {
    let stdout = std::io::stdout();
    let mut locked = stdout.lock();
    match locked
        .write_all(sanitize::terminal(text).as_bytes())
        .and_then(|()| locked.flush())
    {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == ErrorKind::BrokenPipe || is_closed(&stdout, &error) => {
            Ok(false)
        }
        Err(error) => Err(Failure::Stdout(error)),
    }
}

/// Whether this is what a terminal says whose window is gone. A disk that fails says the same, and is none.
fn is_closed(stdout: &Stdout, error: &Error) -> bool {
    let device = || {
        fstat(stdout)
            .is_ok_and(|file| FileType::from_raw_mode(file.st_mode) == FileType::CharacterDevice)
    };
    Errno::from_io_error(error) == Some(Errno::IO) && device()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_word_is_broken_at_the_edge_of_a_terminal() {
        let text = "\u{1b}[1;31mABORTED\u{1b}[0m  a test\n  inconclusive  stays in travel  the procedure hit is not in this run\n  short\n";
        let narrow = wrapped(text, 40);
        let expected = "\u{1b}[1;31mABORTED\u{1b}[0m  a test\n  inconclusive  stays in travel  the\n        procedure hit is not in this run\n  short\n";
        assert_eq!(narrow, expected);
        assert!(narrow.lines().all(|line| letters(line) <= 40));
        assert_eq!(wrapped(text, 400), text);
    }
}
