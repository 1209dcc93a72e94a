//! Physical quantities: dimensions, the unit table, numbers for display. Inside the program every number is SI. Units are converted only
//! in `language` (input) and in `report` (output).

pub mod dimension;
pub mod display;
mod quantity;
pub mod unit;

pub use dimension::{Dimension, Exponent};
pub use quantity::Quantity;
pub use unit::Unit;
