//! What the stages before the run know of `move`: its block and its parameters.

pub(crate) mod block;
pub(crate) mod parameters;
