//! Diagnostics as data. Every stage makes [`Diagnostic`]s; only [`render`] prints them for readers
//! and [`json`] for editors. A check makes them from a [`Violation`], a struct beside it.

pub mod code;
pub mod excerpt;
pub mod json;
pub mod page;
pub mod render;

pub use code::Code;
pub use psd_violation::Violation;

use crate::source::Span;

/// Severity of a diagnostic. No plan runs while there is an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    Error,
    Warning,
}

/// A span and the note on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    pub span: Span,
    pub text: String,
}

/// One error or warning: a stable code, one sentence, the spans, and a suggestion.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    pub code: Code,
    pub severity: Severity,
    /// The message, one sentence without a full stop.
    pub message: String,
    /// The first is where the error is. Empty for errors of the command line.
    pub labels: Vec<Label>,
    /// A suggestion how to correct it.
    pub help: Option<String>,
}

impl Diagnostic {
    /// A diagnostic of `code` with the code's own severity.
    #[must_use]
    pub fn new(code: Code, message: impl Into<String>) -> Self {
        Self {
            code,
            severity: code.severity(),
            message: message.into(),
            labels: Vec::new(),
            help: None,
        }
    }

    /// Adds a span; the first one that is added is where the error is.
    #[must_use]
    pub fn at(mut self, span: Span, text: impl Into<String>) -> Self {
        self.labels.push(Label {
            span,
            text: text.into(),
        });
        self
    }

    #[must_use]
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.help = Some(text.into());
        self
    }

    /// Where the error is.
    #[must_use]
    pub fn span(&self) -> Option<Span> {
        self.labels.first().map(|label| label.span)
    }

    #[must_use]
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// What a check finds: a struct with the values of the message. The derive macro of this name writes the implementation where no text
/// needs a computation of several lines.
pub trait Violation: Sized {
    const CODE: Code;

    /// The violation in words.
    fn diagnostic(self) -> Diagnostic;
}

impl<V: Violation> From<V> for Diagnostic {
    fn from(violation: V) -> Self {
        violation.diagnostic()
    }
}
