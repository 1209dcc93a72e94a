//! What the stages before the run know of `escalate`: its block, its parameters and its history.

pub(crate) mod block;
pub(crate) mod history;
pub(crate) mod parameters;
