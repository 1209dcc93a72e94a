//! The formatter. In: a file without syntax errors. Out: the same plan in the canonical layout. It
//! works on tokens, so that no text of the author is lost; `rows` finds the lines, `value` formats a
//! value.

mod document;
mod rows;
mod value;

use super::{ast::Ast, layout, lexical::tokens::Tokens};
pub use document::format_document;
use rows::{Row, RowKind};

/// Number of spaces by which the fields of a block are indented.
const INDENT: usize = 2;
/// Largest number of columns of a one-line block.
const BLOCK_WIDTH: usize = 100;
/// Largest number of columns of a value on one line; a longer list or call is broken into lines.
const WIDTH: usize = 110;

/// The canonical form of `text`, from which `ast` was parsed without an error. Formatting it again changes nothing, and
/// the meaning of the plan is unchanged.
#[must_use]
pub fn format(ast: &Ast, text: &str) -> String {
    let tokens = Tokens::read(text, ast.file);
    let (pieces, _) = layout::cut(&tokens);
    let rows = rows::rows(&tokens, &pieces);
    let mut lines = Vec::new();
    let mut at = 0;
    while at < rows.len() {
        let end = run_end(&rows, at);
        write_run(&tokens, &rows[at..end], &mut lines);
        at = end;
    }
    let mut text = lines.join("\n");
    if !text.is_empty() {
        text.push('\n');
    }
    text
}

/// The end of the run that starts at `start`: rows of one kind, with comments between them but no blank line.
fn run_end(rows: &[Row], start: usize) -> usize {
    let mut kind = None;
    let mut end = start;
    for (index, row) in rows.iter().enumerate().skip(start) {
        match row.kind {
            RowKind::Blank => break,
            RowKind::Comment => {}
            other if kind.is_none_or(|kind| kind == other && other.aligns()) => {
                kind = Some(other);
                end = index + 1;
            }
            _ => break,
        }
    }
    end.max(start + 1)
}

fn write_run(tokens: &Tokens, run: &[Row], lines: &mut Vec<String>) {
    let widths: Vec<usize> = (0..3)
        .map(|column| {
            run.iter()
                .filter(|row| row.kind != RowKind::Comment)
                .filter_map(|row| row.lead.get(column))
                .map(|text| text.chars().count())
                .max()
                .unwrap_or(0)
        })
        .collect();
    let several = run
        .iter()
        .filter(|row| row.kind != RowKind::Comment)
        .count()
        > 1;
    let written: Vec<Vec<String>> = run
        .iter()
        .map(|row| row_lines(tokens, row, &widths, several))
        .collect();
    // A value over several lines is not aligned: its comment follows its last bracket.
    let commented = run
        .iter()
        .zip(&written)
        .filter(|(row, lines)| row.comment.is_some() && lines.len() == 1);
    let widths = commented.map(|(_, lines)| lines[0].chars().count());
    // A long row does not move the comments of other rows far to the right: only its own comment follows it.
    let column = widths.filter(|width| *width <= WIDTH).max().unwrap_or(0);
    for (row, mut row_lines) in run.iter().zip(written) {
        let single = row_lines.len() == 1;
        if let (Some(comment), Some(last)) = (&row.comment, row_lines.last_mut()) {
            let column = if single { column } else { 0 };
            *last = format!("{last:<column$}  {comment}");
        }
        lines.append(&mut row_lines);
    }
}

/// The lines of one row, without its comment.
fn row_lines(tokens: &Tokens, row: &Row, widths: &[usize], several: bool) -> Vec<String> {
    let indent = " ".repeat(row.indent);
    let lead = |column: usize| row.lead.get(column).map_or("", String::as_str);
    let head = match row.kind {
        RowKind::Blank => String::new(),
        RowKind::Comment | RowKind::Plain | RowKind::Use => format!("{indent}{}", lead(0)),
        RowKind::Field => format!("{indent}{:<width$} = ", lead(0), width = widths[0]),
        RowKind::Binding => format!(
            "{:<first$} {:<second$} = ",
            lead(0),
            lead(1),
            first = widths[0],
            second = widths[1]
        ),
        RowKind::Require => {
            format!(
                "require {:<width$}{}",
                lead(0),
                if several { "  " } else { " " },
                width = widths[0]
            )
        }
    };
    match row.value {
        None => vec![head],
        Some((start, end)) => value::lines(tokens, start, end, &head, row.indent),
    }
}

#[cfg(test)]
mod tests;
