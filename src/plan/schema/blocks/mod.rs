//! The blocks of the language with their fields, one file per subject. They are data, without a
//! reader.

pub mod behaviours;
pub mod curves;
pub mod devices;
pub mod evaluation;
pub mod frames;
pub mod ground;
pub mod limits;
pub mod methods;
pub mod plan_block;
pub mod procedures;
pub mod rig;
pub mod specimen;
pub mod striker;
