//! The language: text to syntax tree (`syntax`), syntax tree to checked plan (`check`). Its
//! keywords and fields are in `schema`. It runs nothing.

pub mod check;
pub mod codes;
pub mod syntax;
