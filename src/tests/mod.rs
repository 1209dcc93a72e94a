//! Tests of whole runs: they read plans, run them on virtual and emulated rigs, and check the
//! record.

pub(crate) mod fault_table;
#[path = "../physics/statistics/testing.rs"]
pub(crate) mod noise;
pub(crate) mod procedures;
mod swarm;
pub(crate) mod testing;
pub(crate) mod uncertainty;
pub(crate) mod whole_runs;
