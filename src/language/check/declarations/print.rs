//! Strings that appear in the report, compared with the characters of its fonts. In: titles, administrative data, names of requirements, publications.
//! Out: one warning for all strings with a character that the fonts lack. It knows neither fonts nor pages.

use crate::check::checker::Checker;
use crate::codes::W717;
use crate::syntax::ast::{Expr, ExprKind};
use psd_plan::schema::Kind;
use psd_plan::{Format, Report};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::glyphs;
use psd_text::source::Span;

/// `letters` are the first that no font of the page has, `printed` is their replacement.
struct NotPrinted<'a> {
    letters: &'a str,
    printed: &'a str,
    others: usize,
    span: Span,
}

impl Violation for NotPrinted<'_> {
    const CODE: Code = W717;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            letters,
            printed,
            others,
            span,
        } = self;
        let also = match others {
            0 => String::new(),
            1 => ", here and in one other string".to_owned(),
            more => format!(", here and in {more} other strings"),
        };
        Diagnostic::new(
        Self::CODE,
        format!("the PDF report shows `{letters}` as `{printed}`{also}"),
    )
    .at(span, "characters without a glyph")
    .help(
        "add a Latin, Greek or Cyrillic spelling for the PDF; the HTML report shows all characters",
    )
    }
}

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
        checker.report(NotPrinted {
            letters: &letters,
            printed: &glyphs::shown(&letters),
            others: texts.len() - 1,
            span: *span,
        });
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
