//! Text in and out: source files and spans, diagnostics, suggestions, sanitising of foreign text,
//! digests. In: text. Out: text and data about it. It knows no language and no plan.

pub mod diagnostic;
pub mod digest;
pub mod glyphs;
pub mod sanitize;
pub mod source;
pub mod suggest;
