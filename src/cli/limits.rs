//! `psd limits`: how large a plan may be.

use std::fmt::Write as _;

use super::exit::{Exit, Failure};
use super::output::give;
use crate::syntax::limits as syntax;

/// Gives every bound of the language.
pub fn limits() -> Result<Exit, Failure> {
    let bounds = [
        (syntax::FILE_BYTES, "bytes of one file"),
        (syntax::LINE_BYTES, "bytes of one line"),
        (syntax::NAME_CHARS, "characters of one name"),
        (syntax::TEXT_BYTES, "bytes of one text"),
        (syntax::NUMBER_CHARS, "characters of one number"),
        (syntax::NESTING, "brackets inside brackets"),
        (syntax::OPERATORS, "operators from the root of an expression to a leaf"),
        (syntax::TOKENS, "words, numbers, texts and signs of one file"),
        (syntax::FAULTS, "faults reported for one file"),
    ];
    give(&bounds.iter().fold(String::new(), |mut text, (bound, what)| {
        let _ = writeln!(text, "{bound:>9}  {what}");
        text
    }))?;
    Ok(Exit::Met)
}
