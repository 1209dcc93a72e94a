//! What is told while results are made: how much of them is done. In: pieces as they are begun. Out: on a terminal one line that
//! goes on, also while a long piece is made; in a pipe a line for the tables, the figures and the report each, and one for every second in
//! which nothing was told. It writes no file.

use std::io::Write;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::cli::output::tell;
use crate::cli::settings::Settings;
use crate::report::{Piece, Shelf};

/// Between two looks of a person at the line.
const TICK: Duration = Duration::from_millis(250);

/// A pipe is silent for so long at most.
const SILENT: Duration = Duration::from_secs(1);

/// A shelf, and who is told what is put on it.
pub struct Telling<'a> {
    shelf: &'a mut dyn Shelf,
    told: Told,
}

/// What tells it, from the first piece on.
enum Told {
    Nothing { terminal: bool },
    Terminal(ProgressBar),
    Pipe(Lines),
}

impl<'a> Telling<'a> {
    pub fn over(shelf: &'a mut dyn Shelf, settings: Settings) -> Self {
        Self {
            shelf,
            told: Told::Nothing {
                terminal: settings.stderr_terminal,
            },
        }
    }
}

/// Lines in a pipe, by a thread of their own: the one that writes is busy.
struct Lines {
    /// None once all is written.
    pieces: Option<Sender<Piece>>,
    thread: Option<JoinHandle<()>>,
}

impl Lines {
    fn begin() -> Self {
        let (pieces, heard) = channel();
        let thread = std::thread::spawn(move || told_in_lines(&heard, SILENT, tell));
        Self {
            pieces: Some(pieces),
            thread: Some(thread),
        }
    }

    fn piece(&self, piece: &Piece) {
        // The thread lives as long as there is somebody to hear.
        let _ = self.pieces.as_ref().map(|pieces| pieces.send(*piece));
    }
}

impl Drop for Lines {
    fn drop(&mut self) {
        self.pieces = None;
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

/// Says a line for the first piece of each part, and one whenever nothing was said for `silent`, until no more pieces come.
fn told_in_lines(pieces: &Receiver<Piece>, silent: Duration, mut say: impl FnMut(&str)) {
    let (began, mut said_at) = (Instant::now(), Instant::now());
    let mut now: Option<Piece> = None;
    loop {
        let new = match pieces.recv_timeout(silent.saturating_sub(said_at.elapsed())) {
            Ok(piece) => now.replace(piece).map(|before| before.part) != Some(piece.part),
            Err(RecvTimeoutError::Timeout) => true,
            Err(RecvTimeoutError::Disconnected) => return,
        };
        if let Some(piece) = now.filter(|_| new) {
            say(&said(&piece, began.elapsed()));
        }
        if new {
            said_at = Instant::now();
        }
    }
}

/// The line as it begins, and goes on by itself.
fn line(piece: &Piece) -> ProgressBar {
    let style = ProgressStyle::with_template(
        "  writing tables, figures, report: {pos} of {len}  ({msg}, {elapsed})",
    );
    let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
    let line = ProgressBar::with_draw_target(Some(piece.of as u64), ProgressDrawTarget::stderr())
        .with_style(style);
    let line = line
        .with_message(piece.part.name())
        .with_position(piece.number as u64);
    line.enable_steady_tick(TICK);
    line
}

impl Shelf for Telling<'_> {
    fn put(
        &mut self,
        path: &str,
        write: &mut dyn FnMut(&mut dyn Write) -> std::io::Result<()>,
    ) -> std::io::Result<()> {
        self.shelf.put(path, write)
    }

    fn begin(&mut self, piece: &Piece) {
        if let Told::Nothing { terminal } = self.told {
            self.told = if terminal {
                Told::Terminal(line(piece))
            } else {
                Told::Pipe(Lines::begin())
            };
        }
        match &self.told {
            Told::Terminal(line) => {
                line.set_message(piece.part.name());
                line.set_position(piece.number as u64);
            }
            Told::Pipe(lines) => lines.piece(piece),
            Told::Nothing { .. } => {}
        }
    }
}

/// What a pipe is told; a piece that takes longer is told with the time since the first.
fn said(piece: &Piece, since: Duration) -> String {
    let Piece { part, number, of } = piece;
    let seconds = since.as_secs();
    let since = if seconds == 0 {
        String::new()
    } else {
        format!("  ({seconds} s)")
    };
    format!("  writing {}: {number} of {of}{since}\n", part.name())
}

impl Drop for Telling<'_> {
    /// The line goes, also where a piece failed.
    fn drop(&mut self) {
        if let Told::Terminal(line) = &self.told {
            line.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Part;

    /// The first piece is never ended, the second follows at once, the third is of another part.
    #[test]
    fn a_long_piece_is_told_again_and_again() {
        let (send, pieces) = channel();
        let mut lines = Vec::new();
        let piece = |part, number| Piece {
            part,
            number,
            of: 3,
        };
        send.send(piece(Part::Tables, 1)).unwrap();
        let mut send = Some(send);
        told_in_lines(&pieces, Duration::from_millis(20), |text| {
            lines.push(text.to_owned());
            if lines.len() == 3 {
                let send = send.take().unwrap();
                send.send(piece(Part::Tables, 2)).unwrap();
                send.send(piece(Part::Report, 3)).unwrap();
            }
        });
        let [first, second, third, report] = &lines[..] else {
            panic!("{lines:?}")
        };
        assert_eq!([first, second, third], ["  writing tables: 1 of 3\n"; 3]);
        assert_eq!(report, "  writing report: 3 of 3\n");
        assert_eq!(
            said(&piece(Part::Figures, 2), Duration::from_millis(2900)),
            "  writing figures: 2 of 3  (2 s)\n"
        );
    }
}
