//! Physical quantities: dimensions, the unit table, and numbers for people. Inside the program every number is SI;
//! units are turned in exactly two places, `check` on the way in and `output` on the way out.

pub mod dimension;
pub mod display;
pub mod unit;

pub use dimension::{Dimension, Exponent};
pub use unit::Unit;
