//! `stiffness ramp`: prescribed displacements with a dwell at each, from which the stiffness
//! follows. In: its block, a rig behind the guard. Out: parameters, history, fitted results with
//! standard uncertainties, figures, report text.

pub(crate) mod check;
pub(crate) mod curve;
pub(crate) mod facts;
pub(crate) mod figures;
pub(crate) mod fits;
pub(crate) mod hold;
pub(crate) mod points;
pub(crate) mod read_results;
pub(crate) mod report;
pub(crate) mod run;
pub(crate) mod tables;
pub(crate) mod uncertainty;

pub use check::MOST_READINGS;
