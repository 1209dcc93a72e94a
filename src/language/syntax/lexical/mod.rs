//! Lexical analysis: from characters to tokens. In: the text of a file. Out: [`tokens::Tokens`], and the errors that need no grammar.

pub mod characters;
pub mod confusable;
pub mod confusables;
pub mod letters;
pub mod long_lines;
pub mod numbers;
pub mod symbols;
pub mod tokens;
pub mod unit_tokens;
