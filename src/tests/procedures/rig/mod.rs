//! The rig in a whole run: faults, remote control, settled dwells, storage.

pub(crate) mod faults;
pub(crate) mod remote_control;
pub(crate) mod settled_hold;
