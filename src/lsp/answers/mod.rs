//! The answers to requests, one file each. In: a [`View`] of a document and the parameters of the request. Out: types of the protocol.

pub mod actions;
pub mod completion;
pub mod describe;
pub mod folding;
pub mod format;
pub mod hints;
pub mod hover;
pub mod lens;
pub mod links;
pub mod navigation;
pub mod rename;
pub mod selection;
pub mod semantic;
pub mod signature;
pub mod symbols;

use std::ops::Range;
use std::rc::Rc;

use gen_lsp_types as lsp;
use psd_language::check::LoadError;
use psd_text::source::{FileId, Span};

use crate::Simulation;
use crate::analysis::Analysis;
use crate::documents::Documents;
use crate::fixes::Fix;
use crate::text::Text;

/// An open document as a file of its plan.
pub struct View<'s> {
    pub documents: &'s Documents,
    /// The key of the plan.
    pub plan: String,
    pub analysis: Rc<Analysis>,
    pub file: FileId,
    pub simulation: Option<&'s Simulation>,
    pub fixes: &'s [Fix],
    /// Whether the editor fills in placeholders.
    pub snippets: bool,
}

impl View<'_> {
    pub fn text(&self) -> &Text {
        self.analysis.text(self.file)
    }

    /// The name of the file.
    pub fn name(&self) -> &str {
        &self.analysis.sources.file(self.file).name
    }

    pub fn key(&self) -> &str {
        &self.analysis.documents[self.file.0 as usize]
    }

    pub fn range(&self, bytes: Range<usize>) -> lsp::Range {
        self.text().range(bytes)
    }

    pub fn location(&self, span: Span) -> lsp::Location {
        location(self.documents, &self.analysis, span)
    }

    /// Loads a file of the plan.
    pub fn load(&self, file: &str) -> Result<String, LoadError> {
        self.documents.now.load(&self.plan, file)
    }
}

/// The place of a span in the editor.
pub fn location(documents: &Documents, analysis: &Analysis, span: Span) -> lsp::Location {
    lsp::Location {
        uri: documents.now.uri(&analysis.documents[span.file.0 as usize]),
        range: analysis.text(span.file).range(span.range()),
    }
}

/// A text in Markdown.
fn markdown(text: String) -> lsp::MarkupContent {
    lsp::MarkupContent {
        kind: lsp::MarkupKind::Markdown,
        value: text,
    }
}
