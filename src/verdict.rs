//! Requirements against the record. In: a [`Plan`] and a [`Record`]. Out: an [`Assessment`], every requirement with
//! value, limit and margin. A missed requirement is a verdict, never an error.

use crate::plan::{Comparison, Plan};
use crate::quantity::Dimension;
use crate::record::Record;

/// Pass < Inconclusive < Fail < Aborted < Error; a parent takes its worst child.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    Pass,
    /// A result that the requirement reads does not exist in this run.
    Inconclusive,
    Fail,
    /// Stopped by a limit or by a person.
    Aborted,
    /// The rig failed.
    Error,
}

impl Verdict {
    /// As in `summary.json`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Inconclusive => "inconclusive",
            Self::Fail => "fail",
            Self::Aborted => "aborted",
            Self::Error => "error",
        }
    }
}

/// The verdict on a whole run.
#[derive(Clone, Debug)]
pub struct Assessment {
    pub verdict: Verdict,
    pub requirements: Vec<RequirementOutcome>,
}

/// One requirement: the worst of its conditions.
#[derive(Clone, Debug)]
pub struct RequirementOutcome {
    pub label: String,
    pub verdict: Verdict,
    pub conditions: Vec<ConditionOutcome>,
}

#[derive(Clone, Debug)]
pub struct ConditionOutcome {
    /// As the plan wrote it.
    pub text: String,
    pub verdict: Verdict,
    pub dimension: Dimension,
    /// SI; None where a result does not exist.
    pub value: Option<f64>,
    pub uncertainty: Option<f64>,
    pub bound: Option<Bound>,
    /// Distance inside the bound, SI; negative: missed by so much.
    pub margin: Option<f64>,
    /// Why it is inconclusive.
    pub reason: Option<String>,
}

/// What the value was held against, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    Compare {
        comparison: Comparison,
        limit: f64,
    },
    /// |value − target| ≤ tolerance
    Within {
        target: f64,
        tolerance: f64,
    },
}

/// Holds every requirement of the plan against the record.
#[must_use]
pub fn assess(_plan: &Plan, _record: &Record) -> Assessment {
    Assessment { verdict: Verdict::Pass, requirements: Vec::new() }
}
