//! What the stages before the run know of `inspect`: its block.

pub mod block;
