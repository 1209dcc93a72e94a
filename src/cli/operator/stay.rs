//! What the operator wants after the early end of a run.

/// What a person wants of a run that has ended early.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Stay {
    /// Nothing yet: the rig is watched on.
    Wait,
    /// Nothing more.
    Leave,
    /// That it goes on, for this reason.
    Resume(String),
}
