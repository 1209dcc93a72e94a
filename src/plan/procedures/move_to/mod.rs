//! What the stages before the run know of `move`: its block and its parameters.

pub mod block;
pub mod parameters;
