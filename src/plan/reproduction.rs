//! `reproduces NAME { … }`: a number of the run beside a published one. It is no requirement: a run that differs says nothing about a
//! specimen.

use super::Condition;

/// A published number, and the number of the run that is compared with it.
#[derive(Clone, Debug)]
pub struct Reproduction {
    pub name: String,
    /// The publication, as the plan writes it.
    pub source: String,
    /// The number of the run within the tolerance of the published one; its text is that of the number.
    pub condition: Condition,
}
