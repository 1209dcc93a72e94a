//! Runs that are cut off: at a write of the run log, at a command, by a disk that fails, after very many steps.

pub(super) mod cut_off;
mod disk;
mod long;
mod words;
