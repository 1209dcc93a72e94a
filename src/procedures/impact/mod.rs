//! `impact`: a calculated striker hits the specimen on the rig, on one degree of freedom or one storey of a frame. In: its block, a rig
//! behind the guard. Out: parameters, history, results, figures, report text.

pub(crate) mod batched;
pub(crate) mod check;
pub(crate) mod contact;
pub(crate) mod facts;
pub(crate) mod figures;
pub(crate) mod predicted;
pub(crate) mod report;
pub(crate) mod results;
pub(crate) mod run;
pub(crate) mod setting;
mod summary;
pub(crate) mod tables;
pub(crate) mod uncertainty;
