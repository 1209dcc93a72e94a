//! The specimens of a checked plan: restoring-force models, frames, ground motions and strikers. SI. It is data, with
//! the properties that follow from it.

pub mod frame;
