//! The parameters of a `move`, in SI.

use crate::formula::Formula;

/// The actuator moves to a displacement.
#[derive(Clone, Debug)]
pub struct Move {
    /// \[m\], absolute.
    pub to: Formula,
    /// \[m/s\]
    pub speed: Option<Formula>,
}
