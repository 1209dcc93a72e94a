//! Checks of blocks that declare: specimen, striker, ground, limits, report, requirements. In: a
//! block of the syntax tree. Out: its part of the plan, in SI. They know no rig that answers.

pub(crate) mod behaviour;
pub(crate) mod curve;
pub(crate) mod frame;
pub(crate) mod golden;
pub(crate) mod ground;
pub(crate) mod ground_record;
pub(crate) mod limits;
pub(crate) mod matrix;
pub(crate) mod plan_block;
pub(crate) mod portal;
pub(crate) mod print;
pub(crate) mod report;
pub(crate) mod require;
pub(crate) mod specimen;
pub(crate) mod striker;
pub(crate) mod table_file;
