//! Folding. In: a document. Out: the ranges of lines that an editor can fold: items, brackets and comments of several lines.

use gen_lsp_types as lsp;
use psd_language::syntax::tokens::{Kind, Tokens};
use psd_text::source::FileId;

use super::View;
use crate::cursor::plan_text;
use crate::text::narrow;

pub fn folding(view: &View<'_>, _: &lsp::FoldingRangeParams) -> Vec<lsp::FoldingRange> {
    let plan = plan_text(view.name(), view.text().as_str());
    let tokens = Tokens::read(&plan, FileId(0));
    let line = |offset: usize| view.text().line_of(offset);
    let mut found: Vec<lsp::FoldingRange> = Vec::new();
    let mut add = |first: usize, last: usize, kind: Option<lsp::FoldingRangeKind>| {
        if first < last {
            found.push(lsp::FoldingRange {
                start_line: narrow(first),
                end_line: narrow(last),
                kind,
                ..lsp::FoldingRange::default()
            });
        }
    };
    let mut open: Vec<usize> = Vec::new();
    let mut comment: Option<(usize, usize)> = None;
    for token in &tokens.list {
        let at = line(token.start);
        let is_own_line = token.kind == Kind::Comment
            && plan[view.text().line(at).start..token.start]
                .trim()
                .is_empty();
        match comment {
            Some((first, last)) if is_own_line && at == last + 1 => comment = Some((first, at)),
            _ if is_own_line => {
                if let Some((first, last)) = comment.replace((at, at)) {
                    add(first, last, Some(lsp::FoldingRangeKind::Comment));
                }
            }
            _ => {}
        }
        match &plan[token.start..token.end] {
            "{" | "(" | "[" if token.kind == Kind::Sign => open.push(at),
            "}" | ")" | "]" if token.kind == Kind::Sign => {
                if let Some(first) = open.pop() {
                    // The last line stays visible, as in other languages.
                    add(first, at.saturating_sub(1), None);
                }
            }
            _ => {}
        }
    }
    if let Some((first, last)) = comment {
        add(first, last, Some(lsp::FoldingRangeKind::Comment));
    }
    found
}
