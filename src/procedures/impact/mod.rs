//! `impact`: a computed striker hits the specimen on the rig, one degree of freedom or one storey
//! of a frame. In: its block, a rig behind the guard. Out: parameters, history, results, figures,
//! report text.

pub(crate) mod arrival;
pub(crate) mod chart;
pub(crate) mod check;
pub(crate) mod contact_log;
pub(crate) mod facts;
pub(crate) mod figures;
pub(crate) mod judge;
pub(crate) mod left;
pub(crate) mod one_impact;
pub(crate) mod report;
pub(crate) mod run;
pub(crate) mod self_tested;
pub(crate) mod steps;
pub(crate) mod storey;
pub(crate) mod storey_check;
pub(crate) mod storey_figures;
pub(crate) mod storey_report;
pub(crate) mod storey_uncertainty;
pub(crate) mod summary;
pub(crate) mod tables;
pub(crate) mod uncertainty;
pub(crate) mod warnings;
