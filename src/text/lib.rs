//! Text in and out: source files and spans, diagnostics, suggestions, sanitising of foreign text, digests, physical quantities with
//! their units. In: text. Out: text and data about it. Knows neither language nor plan.

pub mod columns;
pub mod count;
pub mod diagnostic;
pub mod digest;
pub mod glyphs;
pub mod markdown;
pub mod sanitize;
pub mod source;
pub mod suggest;
pub mod units;
