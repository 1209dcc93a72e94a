//! The outcome of a comparison as text, one form a file: for a terminal, as JSON, JUnit XML and TAP. In: findings and tested plans. Out:
//! text. It compares nothing.

pub mod console;
pub mod json;
pub(super) mod junit;
pub(super) mod tap;
pub(super) mod words;
