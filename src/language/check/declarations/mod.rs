//! Checks of blocks that declare: specimen, striker, ground, limits, report, requirements. In: a
//! block of the syntax tree. Out: its part of the plan, in SI. They communicate with no rig.

pub mod curve;
pub mod ground;
pub mod limits;
pub mod plan_block;
pub mod print;
pub mod reproduces;
pub mod require;
pub mod specimen;
pub mod striker;
pub mod study;
pub mod tolerance;
