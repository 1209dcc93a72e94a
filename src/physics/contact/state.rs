//! The states of striker and structure in a step: apart, in contact, in contact at the limit force. In: nothing. Out: their names.

/// State of a step, as recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepState {
    Free,
    Contact,
    Limit,
}

impl StepState {
    /// Its name in tables and figures.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Contact => "contact",
            Self::Limit => "limit",
        }
    }
}
