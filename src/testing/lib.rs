//! What the tests of several crates share. It is a dependency of tests only. Its files name the crates that they help by name, so that
//! the tests of `psd-plan` (`plans.rs`) and of `psd-rig` (all) compile the same files as a module of their own.

pub mod emulator;
pub mod journal;
pub mod plans;
pub mod rig;
pub mod vocabulary;
