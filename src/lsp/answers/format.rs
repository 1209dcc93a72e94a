//! Formatting, of a whole document and while one types. In: a document without syntax errors. Out: the lines that change.

use std::ops::Range;

use gen_lsp_types as lsp;
use psd_language::syntax::ast::Ast;
use psd_language::syntax::{format, format_document, parse};
use psd_text::markdown::is_document;
use psd_text::source::Sources;
use similar::{Algorithm, DiffOp, capture_diff_slices};

use super::View;
use crate::text::narrow;

pub fn whole(view: &View<'_>, _: &lsp::DocumentFormattingParams) -> Option<Vec<lsp::TextEdit>> {
    let changes = changes(view, None)?;
    Some(changes.into_iter().map(|(_, edit)| edit).collect())
}

/// The lines of the item before the cursor. The line of the cursor stays as it is.
pub fn on_type(
    view: &View<'_>,
    params: &lsp::DocumentOnTypeFormattingParams,
) -> Option<Vec<lsp::TextEdit>> {
    let line = usize::try_from(params.position.line).ok()?;
    let is_closed = params.ch == "}";
    let last = if is_closed {
        line
    } else {
        line.checked_sub(1)?
    };
    let offset = view.text().line(last).end;
    let items = &view.analysis.tree(view.file)?.items;
    let item = items
        .iter()
        .rfind(|item| item.span.range().start < offset)?;
    let first = view.text().line_of(item.span.range().start);
    let changes = changes(view, (!is_closed).then_some(line))?.into_iter();
    let inside = changes.filter(|(lines, _)| first <= lines.start && lines.end <= last + 1);
    Some(inside.map(|(_, edit)| edit).collect())
}

fn formatted(view: &View<'_>, tree: &Ast, text: &str) -> String {
    if is_document(view.name()) {
        format_document(text)
    } else {
        format(tree, text)
    }
}

/// The changes of a whole document, each with the lines that it replaces; None if it has syntax errors. The line `typed` is left out if it
/// is blank: the formatter would remove it.
fn changes(view: &View<'_>, typed: Option<usize>) -> Option<Vec<(Range<usize>, lsp::TextEdit)>> {
    let tree = view.analysis.tree(view.file).filter(|tree| tree.sound)?;
    let whole = view.text().as_str();
    let blank = typed
        .map(|line| view.text().line(line))
        .filter(|line| whole[line.clone()].trim().is_empty());
    let (text, formatted) = if let Some(line) = blank {
        let end = line.end + whole[line.end..].find('\n').map_or(0, |at| at + 1);
        let mut text = whole.to_owned();
        text.replace_range(line.start..end, "");
        let mut sources = Sources::default();
        let file = sources.add(view.name(), text.as_str());
        let (tree, _) = parse(&sources, file);
        let formatted = formatted(view, &tree, &text);
        (text, formatted)
    } else {
        (whole.to_owned(), formatted(view, tree, whole))
    };
    let text = text.as_str();
    let lines =
        |text: &str| -> Vec<String> { text.split_inclusive('\n').map(str::to_owned).collect() };
    let (old, new) = (lines(text), lines(&formatted));
    let operations = capture_diff_slices(Algorithm::Myers, &old, &new);
    let changed = operations
        .iter()
        .filter(|one| !matches!(one, DiffOp::Equal { .. }));
    let edit = |one: &DiffOp| {
        let replaced = one.old_range();
        let position = |line: usize| {
            if line < old.len() {
                lsp::Position::new(narrow(line), 0)
            } else {
                view.text().position(text.len())
            }
        };
        let range = lsp::Range::new(position(replaced.start), position(replaced.end));
        let new_text = new[one.new_range()].concat();
        (replaced, lsp::TextEdit { range, new_text })
    };
    Some(changed.map(edit).collect())
}
