//! `damping sweep`: constant-velocity strokes that give the damping. In: its block, a rig behind
//! the guard. Out: parameters, history, the damping with its standard uncertainty.

pub(crate) mod check;
pub(crate) mod facts;
pub(crate) mod figures;
mod findings;
mod pairing;
pub(crate) mod rate_separated_stiffness;
pub(crate) mod report;
pub(crate) mod run;
mod sweep;
pub(crate) mod tables;
pub(crate) mod uncertainty;

pub use run::MOST_SAMPLES;
