//! Warnings: plans that can run but give poor results. In: the checked plan. Out: diagnostics with
//! the numbers. They change nothing in the plan.

pub mod decided;
pub mod guarded;
pub mod left;
