//! Lines that are too long, which are found before everything else: the work on one line may grow with the square of its length, and is
//! bounded only because its length is. In: the text of a file. Out: one error for each such line.

use crate::syntax::{limits, messages};
use psd_text::diagnostic::Diagnostic;
use psd_text::source::{FileId, Span};

/// Spaces at the end of a line do not count, nor does the text around the blocks of a document.
#[must_use]
pub fn errors(text: &str, file: FileId) -> Vec<Diagnostic> {
    let mut errors = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        if line.trim_end().len() > limits::LINE_BYTES {
            let span = Span::new(file, start, text.ceil_char_boundary(start + 40));
            let bytes = limits::LINE_BYTES;
            errors.push(messages::too_large(span, "this line", bytes, "bytes"));
        }
        start += line.len();
    }
    errors
}
