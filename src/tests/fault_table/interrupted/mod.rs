//! Runs that are cut off: at a write of the run log, at a command, after very many steps.

pub(super) mod cut_off;
mod long;
mod words;
