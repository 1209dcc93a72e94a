//! The data of `move` that earlier stages know: its block and its parameters. They use no other file of this folder.

pub(crate) mod block;
pub(crate) mod parameters;
