//! The two streams: messages to the operator go to standard error, results to standard output. A reader that has gone
//! (`psd explain | head`, a closed terminal) is not an error; a full disk behind standard output is.

use std::io::{Error, ErrorKind, Stdout, Write as _};

use ratatui::crossterm::cursor::MoveTo;
use ratatui::crossterm::execute;
use ratatui::crossterm::terminal::{Clear, ClearType, size};
use rustix::fs::{FileType, fstat};
use rustix::io::Errno;

use super::exit::Failure;
use super::settings::Settings;
use psd_text::sanitize;

/// Prints a message to the operator. A closed stream is not an error. Control sequences other than colours are removed.
pub fn print_message(text: &str) {
    let _ = std::io::stderr()
        .lock()
        .write_all(sanitize::terminal(text).as_bytes());
}

/// Removes the text of an earlier check from the terminal.
pub fn clear_terminal(settings: Settings) {
    if settings.stderr_terminal {
        let _ = execute!(std::io::stderr(), Clear(ClearType::All), MoveTo(0, 0));
    }
}

/// Prints lines of text; on a terminal they are wrapped between words.
pub fn print_wrapped(text: &str, settings: Settings) {
    let columns = settings
        .stderr_terminal
        .then(|| size().ok())
        .flatten()
        .map(|(columns, _)| usize::from(columns));
    match columns {
        Some(columns) if columns > 2 * INDENT => print_message(&wrapped(text, columns)),
        _ => print_message(text),
    }
}

/// Indent of a continued line, in columns.
const INDENT: usize = 8;

/// Every line longer than `width` broken between words. Colour codes have no width.
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

/// Number of characters that a terminal shows.
fn letters(text: &str) -> usize {
    let mut colours = false;
    let shown = text.chars().filter(|letter| {
        let hidden = colours || *letter == '\u{1b}';
        colours = hidden && *letter != 'm';
        !hidden
    });
    shown.count()
}

/// Prints a result to standard output, without control sequences other than colours.
pub fn print_result(text: &str) -> Result<(), Failure> {
    print_while_read(text).map(drop)
}

/// As [`print_result`]; returns whether the reader is still there, so that an endless output ends with its reader.
pub fn print_while_read(text: &str) -> Result<bool, Failure> {
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

/// Whether this is the error of a terminal whose window is closed. A failing disk gives the same error, but is not a terminal.
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
