//! Progress while results are written. In: pieces as they are begun. Out: on a terminal one line that is updated; in a pipe one
//! line for each of tables, figures and report, and one for every second without a new one. It writes no file.

use std::io::Write;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::output::print_message;
use crate::settings::Settings;
use psd::report::{OutputPiece, OutputSink};

/// Time between two updates of the line.
const TICK: Duration = Duration::from_millis(250);

/// Longest time without a line in a pipe.
const SILENT: Duration = Duration::from_secs(1);

/// A sink that reports its progress.
pub struct ProgressSink<'a> {
    sink: &'a mut dyn OutputSink,
    progress: Progress,
}

/// The display, from the first piece on.
enum Progress {
    NotBegun { terminal: bool },
    Terminal(ProgressBar),
    Pipe(Lines),
}

impl<'a> ProgressSink<'a> {
    pub fn new(sink: &'a mut dyn OutputSink, settings: Settings) -> Self {
        Self {
            sink,
            progress: Progress::NotBegun {
                terminal: settings.stderr_terminal,
            },
        }
    }
}

/// Lines in a pipe, printed by a separate thread: the thread that writes is busy.
struct Lines {
    /// None once all is written.
    pieces: Option<Sender<OutputPiece>>,
    thread: Option<JoinHandle<()>>,
}

impl Lines {
    fn begin() -> Self {
        let (pieces, received) = channel();
        let thread = std::thread::spawn(move || print_lines(&received, SILENT, print_message));
        Self {
            pieces: Some(pieces),
            thread: Some(thread),
        }
    }

    fn begin_piece(&self, piece: &OutputPiece) {
        // Fails only if the thread has ended.
        let _ = self.pieces.as_ref().map(|pieces| pieces.send(*piece));
    }
}

impl Drop for Lines {
    fn drop(&mut self) {
        self.pieces = None;
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

/// Prints a line for the first piece of each part, and one after every `silent` without a line, until the sender is dropped.
fn print_lines(pieces: &Receiver<OutputPiece>, silent: Duration, mut print: impl FnMut(&str)) {
    let (began, mut printed_at) = (Instant::now(), Instant::now());
    let mut current: Option<OutputPiece> = None;
    loop {
        let is_new = match pieces.recv_timeout(silent.saturating_sub(printed_at.elapsed())) {
            Ok(piece) => current.replace(piece).map(|before| before.part) != Some(piece.part),
            Err(RecvTimeoutError::Timeout) => true,
            Err(RecvTimeoutError::Disconnected) => return,
        };
        if let Some(piece) = current.filter(|_| is_new) {
            print(&line(&piece, began.elapsed()));
        }
        if is_new {
            printed_at = Instant::now();
        }
    }
}

/// The line on a terminal, which updates itself.
fn progress_bar(piece: &OutputPiece) -> ProgressBar {
    let style = ProgressStyle::with_template(
        "  writing tables, figures, report: {pos} of {len}  ({msg}, {elapsed})",
    );
    let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::with_draw_target(Some(piece.total as u64), ProgressDrawTarget::stderr())
        .with_style(style)
        .with_message(piece.part.name())
        .with_position(piece.number as u64);
    bar.enable_steady_tick(TICK);
    bar
}

impl OutputSink for ProgressSink<'_> {
    fn put(
        &mut self,
        path: &str,
        write: &mut dyn FnMut(&mut dyn Write) -> std::io::Result<()>,
    ) -> std::io::Result<()> {
        self.sink.put(path, write)
    }

    fn begin(&mut self, piece: &OutputPiece) {
        if let Progress::NotBegun { terminal } = self.progress {
            self.progress = if terminal {
                Progress::Terminal(progress_bar(piece))
            } else {
                Progress::Pipe(Lines::begin())
            };
        }
        match &self.progress {
            Progress::Terminal(bar) => {
                bar.set_message(piece.part.name());
                bar.set_position(piece.number as u64);
            }
            Progress::Pipe(lines) => lines.begin_piece(piece),
            Progress::NotBegun { .. } => {}
        }
    }
}

/// The line in a pipe, with the time since the first piece if it is a second or more.
fn line(piece: &OutputPiece, since: Duration) -> String {
    let OutputPiece {
        part,
        number,
        total,
    } = piece;
    let seconds = since.as_secs();
    let since = if seconds == 0 {
        String::new()
    } else {
        format!("  ({seconds} s)")
    };
    format!("  writing {}: {number} of {total}{since}\n", part.name())
}

impl Drop for ProgressSink<'_> {
    /// Removes the line, also after an error.
    fn drop(&mut self) {
        if let Progress::Terminal(bar) = &self.progress {
            bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd::report::OutputPart;

    /// The first piece takes a long time, the second follows immediately, the third is of a different part.
    #[test]
    fn a_long_piece_is_printed_repeatedly() {
        let (send, pieces) = channel();
        let mut lines = Vec::new();
        let piece = |part, number| OutputPiece {
            part,
            number,
            total: 3,
        };
        send.send(piece(OutputPart::Tables, 1)).unwrap();
        let mut send = Some(send);
        print_lines(&pieces, Duration::from_millis(20), |text| {
            lines.push(text.to_owned());
            if lines.len() == 3 {
                let send = send.take().unwrap();
                send.send(piece(OutputPart::Tables, 2)).unwrap();
                send.send(piece(OutputPart::Report, 3)).unwrap();
            }
        });
        let [first, second, third, report] = &lines[..] else {
            panic!("{lines:?}")
        };
        assert_eq!([first, second, third], ["  writing tables: 1 of 3\n"; 3]);
        assert_eq!(report, "  writing report: 3 of 3\n");
        assert_eq!(
            line(&piece(OutputPart::Figures, 2), Duration::from_millis(2900)),
            "  writing figures: 2 of 3  (2 s)\n"
        );
    }
}
