//! What is told while results are made: how much of them is done. In: pieces as they are begun. Out: on a terminal one line that
//! goes on, also while a long piece is made; in a pipe a line for the tables, the figures and the report each. It writes no file.

use std::io::Write;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::output::tell;
use super::settings::Settings;
use crate::output::{Part, Piece, Shelf};

/// Between two looks of a person at the line.
const TICK: Duration = Duration::from_millis(250);

/// A shelf, and who is told what is put on it.
pub struct Telling<'a> {
    shelf: &'a mut dyn Shelf,
    terminal: bool,
    /// On a terminal, from the first piece on.
    line: Option<ProgressBar>,
    told: Option<Part>,
}

impl<'a> Telling<'a> {
    pub fn over(shelf: &'a mut dyn Shelf, settings: Settings) -> Self {
        Self { shelf, terminal: settings.stderr_terminal, line: None, told: None }
    }
}

/// The line as it begins, and goes on by itself.
fn line(piece: &Piece) -> ProgressBar {
    let style = ProgressStyle::with_template("  writing tables, figures, report: {pos} of {len}  ({msg}, {elapsed})");
    let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
    let line = ProgressBar::with_draw_target(Some(piece.of as u64), ProgressDrawTarget::stderr()).with_style(style);
    let line = line.with_message(piece.part.name()).with_position(piece.number as u64);
    line.enable_steady_tick(TICK);
    line
}

impl Shelf for Telling<'_> {
    fn put(&mut self, path: &str, write: &mut dyn FnMut(&mut dyn Write) -> std::io::Result<()>) -> std::io::Result<()> {
        self.shelf.put(path, write)
    }

    fn begin(&mut self, piece: &Piece) {
        let new = self.told.replace(piece.part) != Some(piece.part);
        if self.terminal {
            let line = self.line.get_or_insert_with(|| line(piece));
            line.set_message(piece.part.name());
            line.set_position(piece.number as u64);
        } else if new {
            tell(&said(piece));
        }
    }
}

/// What a pipe is told of the first piece of a part.
fn said(piece: &Piece) -> String {
    let Piece { part, number, of } = piece;
    format!("  writing {}: {number} of {of}\n", part.name())
}

impl Drop for Telling<'_> {
    /// The line goes, also where a piece failed.
    fn drop(&mut self) {
        if let Some(line) = &self.line {
            line.finish_and_clear();
        }
    }
}
