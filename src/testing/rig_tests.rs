//! What the tests of `psd-rig` itself share with those of other crates: the same files, compiled into it.

pub mod emulator;
pub mod journal;
pub mod plans;
pub mod rig;
