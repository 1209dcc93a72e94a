//! `move`: one motion to an absolute displacement. In: its block, a rig behind the guard. Out: the
//! readings.

pub(crate) mod check;
pub(crate) mod run;
pub(crate) mod tables;
