//! Selections that grow: a word, its expression, its value, its entry, its item. In: positions. Out: a chain of ranges for each.

use gen_lsp_types as lsp;
use psd_language::syntax::ast::{Expr, ItemKind};
use psd_text::source::Span;

use super::View;
use crate::occurrences::parts;

pub fn selection(view: &View<'_>, params: &lsp::SelectionRangeParams) -> Vec<lsp::SelectionRange> {
    let one = |position: lsp::Position| {
        let offset = view.text().offset(position);
        let mut spans = spans(view, offset);
        spans.sort_by_key(|span| std::cmp::Reverse((span.end - span.start, span.start)));
        spans.dedup();
        let mut range = None;
        for span in spans {
            range = Some(lsp::SelectionRange {
                range: view.range(span.range()),
                parent: range.map(Box::new),
            });
        }
        range.unwrap_or(lsp::SelectionRange {
            range: view.range(offset..offset),
            parent: None,
        })
    };
    params
        .positions
        .iter()
        .map(|position| one(*position))
        .collect()
}

/// Every part of the tree around an offset.
fn spans(view: &View<'_>, offset: usize) -> Vec<Span> {
    let holds = |span: Span| span.range().start <= offset && offset <= span.range().end;
    let mut found = vec![Span::new(view.file, 0, view.text().as_str().len())];
    let word = view.analysis.at(view.file, offset);
    found.extend(word.map(|word| word.span));
    let items = view
        .analysis
        .tree(view.file)
        .map_or(&[][..], |tree| &tree.items);
    let Some(item) = items.iter().find(|item| holds(item.span)) else {
        return found;
    };
    found.push(item.span);
    let mut values: Vec<&Expr> = match &item.kind {
        ItemKind::Use { .. } => Vec::new(),
        ItemKind::Let { value, .. } => vec![value],
        ItemKind::Param { value, bounds, .. } => std::iter::once(value).chain(bounds).collect(),
        ItemKind::Require { condition, .. } => vec![condition],
        ItemKind::Block(block) => {
            let entry = block.fields.iter().find(|entry| holds(entry.span));
            found.extend(entry.map(|entry| entry.span));
            entry.map(|entry| &entry.value).into_iter().collect()
        }
    };
    while let Some(value) = values.into_iter().find(|value| holds(value.span)) {
        found.push(value.span);
        values = parts(value);
    }
    found
}
