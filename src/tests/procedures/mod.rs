//! Whole runs of each procedure.

pub(crate) mod balance;
pub(crate) mod contacts;
pub(crate) mod continuous;
pub(crate) mod cycle;
pub(crate) mod frame_sequence;
pub(crate) mod impact;
pub(crate) mod impact_series;
pub(crate) mod operator_stability;
pub(crate) mod remote_control;
pub(crate) mod rig_faults;
pub(crate) mod sequence;
pub(crate) mod settled_hold;
pub(crate) mod sweep_lag;
pub(crate) mod tracking;
pub(crate) mod unload;
