//! Contact between striker and structure: the laws and the states of a step.

/// State of a step, as recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepState {
    Free,
    Contact,
    Limit,
}

impl StepState {
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Contact => "contact",
            Self::Limit => "limit",
        }
    }
}
