//! The history of a procedure, one file a procedure: its steps, as they were read and computed. In: numbers of a run, SI. Out: data. It
//! computes no motion.

pub(super) mod base_excitation;
pub(super) mod cycle;
pub(super) mod floors;
pub(super) mod impact;
pub(super) mod impact_series;
pub(super) mod ramp;
pub(super) mod sweep;
pub(super) mod unload;
