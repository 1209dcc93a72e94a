//! How near a rerun must come to the blessed results, as the plan says it.

use crate::plan::formula::ProcedureId;
use crate::units::Dimension;

/// The `golden` block; without one its defaults.
#[derive(Clone, Debug, PartialEq)]
pub struct Golden {
    /// Of every number, relative to its size.
    pub tolerance: f64,
    pub results: Vec<NearResult>,
    pub columns: Vec<NearColumn>,
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

/// How far a number may be off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// SI.
    Absolute(f64),
    /// Of the number's size.
    Relative(f64),
}

/// A result with a tolerance of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearResult {
    pub procedure: ProcedureId,
    pub name: &'static str,
    pub dimension: Dimension,
    pub tolerance: Tolerance,
}

/// A column with a tolerance of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearColumn {
    /// None: of every table that has it.
    pub procedure: Option<ProcedureId>,
    pub name: &'static str,
    pub dimension: Dimension,
    pub tolerance: Tolerance,
}
