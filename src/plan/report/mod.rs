//! The report and the accepted results that a checked plan requests. It is data: nothing is drawn or
//! compared here.

pub(crate) mod annex;
pub(crate) mod figure;
pub(crate) mod golden;
pub(crate) mod picture;
pub(crate) mod undeclared;
