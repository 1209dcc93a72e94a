//! Text to syntax tree. [`parse()`] parses a whole file and reports all syntax errors; [`format()`]
//! writes the canonical layout. This is the only folder that knows the parser library. It knows no
//! block and no unit.

pub mod ast;
pub mod control;
pub mod foreign;
pub mod format;
pub mod limits;
pub mod parse;

mod expr;
mod grammar;
mod layout;
mod lexical;
mod lower;
mod messages;
mod rule_names;

#[cfg(test)]
mod tests;

/// The tokens of a text, for what reads a text that need not be valid.
pub mod tokens {
    pub use super::lexical::tokens::{JOINING_WORDS, Kind, Token, Tokens};
}

pub use format::{format, format_document};
pub use parse::parse;
