//! Text to syntax tree. [`parse()`] parses a whole file and reports all syntax errors; [`format()`]
//! writes the canonical layout. This is the only folder that knows the parser library. It knows no
//! block and no unit.

pub mod ast;
pub mod control;
pub mod format;
pub mod limits;
pub mod parse;

mod characters;
mod expr;
mod faults;
mod layout;
mod letters;
mod lower;
mod misspelt;
mod numbers;
mod rule_names;
mod tokens;

#[cfg(test)]
mod tests;

pub use format::format;
pub use parse::parse;
