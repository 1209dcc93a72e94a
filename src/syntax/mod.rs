//! Text → syntax tree. The only folder that knows the grammar's tool: [`parse`] reads a file whole, faults and all,
//! and [`format`] writes the canonical text of a plan.

pub mod ast;
pub mod format;
pub mod parse;

pub use format::format;
pub use parse::parse;
