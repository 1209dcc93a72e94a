//! The data of `damping sweep` that earlier stages know: its block, its parameters and its history. They use no other file of this folder.

pub(crate) mod block;
pub(crate) mod history;
pub(crate) mod parameters;
