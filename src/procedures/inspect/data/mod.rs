//! The data of `inspect` that earlier stages know: its block. They use no other file of this folder.

pub(crate) mod block;
