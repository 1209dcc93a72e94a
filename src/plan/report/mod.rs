//! The report and the accepted results that a checked plan requests. It is data: nothing is drawn or
//! compared here.

pub mod annex;
pub mod figure;
pub mod golden;
pub mod picture;
pub mod undeclared;
