//! placeholder
pub mod curve;
pub mod dialogue;
pub mod draw;
pub mod keys;
pub mod model;
