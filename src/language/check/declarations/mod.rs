//! Checks of blocks that declare: specimen, striker, ground, limits, report, requirements. In: a
//! block of the syntax tree. Out: its part of the plan, in SI. They communicate with no rig.

pub(crate) mod curve;
pub(crate) mod golden;
pub(crate) mod ground;
pub(crate) mod limits;
pub(crate) mod plan_block;
pub(crate) mod print;
pub(crate) mod report;
pub(crate) mod reproduces;
pub(crate) mod require;
pub(crate) mod specimen;
pub(crate) mod striker;
pub(crate) mod study;
