//! Whole runs of each procedure.

pub(crate) mod balance;
pub(crate) mod cycle;
pub(crate) mod frame;
pub(crate) mod impact;
pub(crate) mod motion;
pub(crate) mod rig;
pub(crate) mod sequence;
pub(crate) mod unload;
