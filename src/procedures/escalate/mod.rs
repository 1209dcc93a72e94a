//! `escalate`: impacts of increasing energy on one specimen. In: its block, a rig behind the guard.
//! Out: parameters, the history of each impact, results, tables, figures, report text. The impact
//! itself is in `impact`.

pub(crate) mod check;
pub(crate) mod declared;
pub(crate) mod facts;
pub(crate) mod figures;
pub(crate) mod repeated_impact;
pub(crate) mod report;
pub(crate) mod results;
pub(crate) mod run;
pub(crate) mod tables;
