//! Diagnostics as an editor gets them. In: the findings of a check. Out: for each document its diagnostics; the message is a plain text.

use std::collections::BTreeMap;

use gen_lsp_types as lsp;
use psd_language::check::imports;
use psd_text::diagnostic::{Diagnostic, Severity};
use psd_text::source::{FileId, Sources, Span};

use crate::documents::{Snapshot, beside};
use crate::text::{Encoding, Text};

/// Name of the source of a diagnostic.
pub const SOURCE: &str = "psd";

/// The diagnostics of a plan, by the keys of their documents. Every document of the plan has an entry.
pub fn by_document(
    plan: &str,
    diagnostics: &[Diagnostic],
    sources: &Sources,
    documents: &Snapshot,
    encoding: Encoding,
) -> BTreeMap<String, Vec<lsp::Diagnostic>> {
    let keys: Vec<String> = sources
        .iter()
        .map(|(file, _)| key_of(plan, sources, file))
        .collect();
    let texts: Vec<Text> = sources
        .iter()
        .map(|(_, file)| Text::new(file.text.as_str(), encoding))
        .collect();
    let location = |span: Span| {
        let at = span.file.0 as usize;
        lsp::Location {
            uri: documents.uri(&keys[at]),
            range: texts[at].range(span.range()),
        }
    };
    let mut found: BTreeMap<String, Vec<lsp::Diagnostic>> =
        keys.iter().map(|key| (key.clone(), Vec::new())).collect();
    for diagnostic in diagnostics {
        let file = diagnostic.span().map_or(FileId(0), |span| span.file);
        let related = diagnostic.labels.iter().skip(1);
        let related: Vec<_> = related
            .map(|label| lsp::DiagnosticRelatedInformation {
                location: location(label.span),
                message: label.text.clone(),
            })
            .collect();
        let help = diagnostic.help.as_ref();
        let help = help.map_or_else(String::new, |help| format!("\n{help}"));
        let one = lsp::Diagnostic {
            range: diagnostic
                .span()
                .map_or_else(lsp::Range::default, |span| location(span).range),
            severity: Some(match diagnostic.severity {
                Severity::Error => lsp::DiagnosticSeverity::Error,
                Severity::Warning => lsp::DiagnosticSeverity::Warning,
            }),
            code: Some(diagnostic.code.id().to_owned().into()),
            source: Some(SOURCE.to_owned()),
            message: format!("{}{help}", diagnostic.message).into(),
            related_information: (!related.is_empty()).then_some(related),
            ..lsp::Diagnostic::default()
        };
        if let Some(list) = found.get_mut(&keys[file.0 as usize]) {
            list.push(one);
        }
    }
    found
}

/// The key of a file of a plan.
fn key_of(plan: &str, sources: &Sources, file: FileId) -> String {
    if file == FileId(0) {
        plan.to_owned()
    } else {
        beside(plan, &imports::own_path(sources, file))
    }
}
