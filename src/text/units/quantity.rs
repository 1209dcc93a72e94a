//! A number with its dimension, as a parameter is given it without any text.

use super::dimension::Dimension;
use super::display::si_unit;

/// A value in SI units and its dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// In SI units of the dimension.
    pub value: f64,
    pub dimension: Dimension,
}

impl Quantity {
    #[must_use]
    pub const fn new(value: f64, dimension: Dimension) -> Self {
        Self { value, dimension }
    }

    /// The quantity as a plan writes it, with every digit that the value needs: `0.0015 m`, `1.5`.
    #[must_use]
    pub fn in_plan_syntax(self) -> String {
        let digits = self.value.to_string();
        // A number of a plan has at most 40 characters.
        let number = if digits.len() > 30 {
            format!("{:e}", self.value)
        } else {
            digits
        };
        match self.dimension {
            Dimension::NUMBER => number,
            dimension => format!("{number} {}", si_unit(dimension)),
        }
    }
}
