//! `shake`: a frame under ground motion. In: its block, the ground-motion record, a rig behind the
//! guard. Out: parameters, history, results, tables, figures, report text.

pub(crate) mod check;
pub(crate) mod facts;
pub(crate) mod figures;
pub(crate) mod left;
pub(crate) mod predicted;
pub(crate) mod report;
pub(crate) mod results;
pub(crate) mod run;
pub(crate) mod setting;
pub(crate) mod steps;
pub(crate) mod tables;
pub(crate) mod uncertainty;
