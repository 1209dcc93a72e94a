//! What a checked plan asks of its report and of accepted results. It is data: nothing is drawn or
//! compared here.

pub(crate) mod figure;
pub(crate) mod golden;
pub(crate) mod undeclared;
