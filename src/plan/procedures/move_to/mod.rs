//! What the stages before the run know of `move`: its block, its parameters and its history.

pub mod block;
pub mod history;
pub mod parameters;
