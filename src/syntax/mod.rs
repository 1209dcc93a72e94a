//! Text → syntax tree. The only folder that knows the grammar's tool: [`parse()`] reads a file whole, faults and all,
//! and [`format()`] writes the canonical text of a plan.

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
