//! `preload`: constant axial load on a tested storey. In: its block, a rig behind the guard. Out: the readings of its axial axis, which
//! holds the force until `unload`.

pub(crate) mod check;
pub(crate) mod run;
pub(crate) mod tables;
