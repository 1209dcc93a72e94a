//! What the tests of several crates share. It is a dependency of tests only. Its files name the crates that they help by name, so that
//! the tests of such a crate itself compile the same file as a module of their own.

pub mod emulator;
pub mod journal;
pub mod plans;
pub mod rig;
