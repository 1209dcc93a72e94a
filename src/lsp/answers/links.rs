//! Links to the files that a plan names. In: a document. Out: the strings in it that name files beside the plan.

use gen_lsp_types as lsp;
use psd_language::check::imports;
use psd_language::syntax::ast::{Expr, ExprKind, ItemKind};
use psd_text::source::Span;

use super::View;
use crate::documents::beside;
use crate::occurrences::{parts, used_path};

pub fn links(view: &View<'_>, _: &lsp::DocumentLinkParams) -> Vec<lsp::DocumentLink> {
    let mut texts: Vec<Span> = Vec::new();
    let items = view
        .analysis
        .tree(view.file)
        .map_or(&[][..], |tree| &tree.items);
    for item in items {
        match &item.kind {
            ItemKind::Use { path } => texts.push(path.span),
            ItemKind::Block(block) => {
                for entry in &block.fields {
                    strings(&entry.value, &mut texts);
                }
            }
            ItemKind::Let { .. } | ItemKind::Param { .. } | ItemKind::Require { .. } => {}
        }
    }
    let link = |span: Span| {
        let range = span.range();
        Some(lsp::DocumentLink {
            target: Some(target(view, span)?),
            range: view.range(range.start + 1..range.end - 1),
            tooltip: None,
            data: None,
        })
    };
    texts.into_iter().filter_map(link).collect()
}

fn strings(expr: &Expr, into: &mut Vec<Span>) {
    if let ExprKind::Text(text) = &expr.kind
        && text.contains('.')
        && !text.contains(' ')
    {
        into.push(expr.span);
    }
    for part in parts(expr) {
        strings(part, into);
    }
}

/// The document that a string names, with its quotes; None if there is no such file.
pub fn target(view: &View<'_>, span: Span) -> Option<lsp::Uri> {
    let written = view.analysis.sources.text(span).trim_matches('"');
    let from = imports::own_path(&view.analysis.sources, span.file);
    let path = used_path(&from, written)?;
    view.load(&path).ok()?;
    Some(view.documents.now.uri(&beside(&view.plan, &path)))
}
