//! The operator's choice after the early end of a run.

/// The operator's choice for a run that has ended early.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Stay {
    /// No choice yet: the observation continues.
    Wait,
    /// The operator leaves.
    Leave,
    /// The run resumes, for this reason.
    Resume(String),
}
