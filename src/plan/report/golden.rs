//! Required agreement of a rerun with the accepted results, as the plan specifies it.

use crate::formula::ProcedureId;
use psd_text::units::Dimension;

/// The `golden` block; its default values if the plan has none.
#[derive(Clone, Debug, PartialEq)]
pub struct Golden {
    /// For every number, relative to its absolute value.
    pub tolerance: f64,
    pub results: Vec<ResultTolerance>,
    pub columns: Vec<ColumnTolerance>,
}

impl Golden {
    /// Relative tolerance where the plan gives none.
    pub const TOLERANCE: f64 = 1e-9;
}

impl Default for Golden {
    fn default() -> Self {
        Self {
            tolerance: Self::TOLERANCE,
            results: Vec::new(),
            columns: Vec::new(),
        }
    }
}

/// The largest difference of a number from the accepted one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// Absolute, in SI units.
    Absolute(f64),
    /// Relative to the accepted number.
    Relative(f64),
}

/// A result with a separate tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResultTolerance {
    pub procedure: ProcedureId,
    pub name: &'static str,
    pub dimension: Dimension,
    pub tolerance: Tolerance,
}

/// A column with a separate tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColumnTolerance {
    /// The procedure whose table has the column. None: every table that has it.
    pub procedure: Option<ProcedureId>,
    pub name: &'static str,
    pub dimension: Dimension,
    pub tolerance: Tolerance,
}
