//! Parameters of the procedures, in SI, one file per procedure. They are data: they check nothing
//! and run nothing.

pub(crate) mod cycle;
pub(crate) mod damping_sweep;
pub(crate) mod identification;
pub(crate) mod impact;
pub(crate) mod impact_series;
pub(crate) mod known_steps;
pub(crate) mod mode;
pub(crate) mod move_to;
pub(crate) mod stepping;
pub(crate) mod structure;
pub(crate) mod unload;
