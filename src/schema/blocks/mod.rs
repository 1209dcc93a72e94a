//! The blocks of the language with their fields, one file per subject. They are data, without a
//! reader.

pub(crate) mod behaviours;
pub(crate) mod curves;
pub(crate) mod devices;
pub(crate) mod evaluation;
pub(crate) mod frames;
pub(crate) mod ground;
pub(crate) mod limits;
pub(crate) mod methods;
pub(crate) mod plan_block;
pub(crate) mod procedures;
pub(crate) mod rig;
pub(crate) mod specimen;
pub(crate) mod striker;
