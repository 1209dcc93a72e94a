//! `unload`: moves the specimen to zero restoring force. In: its block, a rig behind the guard.
//! Out: the readings and the residual displacement or drift.

pub(crate) mod check;
pub(crate) mod facts;
pub(crate) mod figures;
pub(crate) mod report;
pub(crate) mod run;
pub(crate) mod tables;
pub(crate) mod uncertainty;
