//! Strings that appear in the report, compared with the characters of its fonts. In: titles, administrative data, names of requirements, publications.
//! Out: one warning for all strings with a character that the fonts lack. It knows neither fonts nor pages.

use crate::check::checker::Checker;
use crate::check::messages::whole as message;
use crate::syntax::ast::{Expr, ExprKind};
use psd_plan::schema::Kind;
use psd_plan::{Format, Report};
use psd_text::glyphs;
use psd_text::source::Span;

/// Warns of characters that are printed as code points; called only if there is no error.
pub fn warn(checker: &mut Checker, report: &Report) {
    if !report.formats.contains(&Format::Pdf) {
        return;
    }
    let mut texts: Vec<(Span, &str)> = checker
        .scope
        .requirements
        .iter()
        .map(|requirement| (requirement.label.span, requirement.label.node.as_str()))
        .collect();
    for declared in checker.scope.blocks.iter().filter(|declared| {
        matches!(
            declared.kind.kind,
            Kind::Plan | Kind::Report | Kind::Reproduces
        )
    }) {
        texts.extend(
            declared
                .block
                .title
                .iter()
                .map(|title| (title.span, title.node.as_str())),
        );
        declared
            .block
            .fields
            .iter()
            .for_each(|entry| collect(&entry.value, &mut texts));
    }
    texts.retain(|(_, text)| !text.chars().all(glyphs::has));
    texts.sort_by_key(|(span, _)| span.start);
    if let Some((span, text)) = texts.first() {
        let letters: String = text.chars().filter(|c| !glyphs::has(*c)).take(4).collect();
        checker.diagnostics.push(message::not_printed(
            &letters,
            &glyphs::shown(&letters),
            texts.len() - 1,
            *span,
        ));
    }
}

/// The strings of a value: one, or those of a list.
fn collect<'a>(value: &'a Expr, into: &mut Vec<(Span, &'a str)>) {
    match &value.kind {
        ExprKind::Text(text) => into.push((value.span, text)),
        ExprKind::List { items, .. } => items.iter().for_each(|item| collect(item, into)),
        _ => {}
    }
}
