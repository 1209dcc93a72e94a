//! The finding of one part of a verification.

/// The finding of one part of a verification.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    pub part: &'static str,
    pub sound: bool,
    pub told: String,
}

impl Finding {
    pub fn sound(part: &'static str, told: impl Into<String>) -> Self {
        Self {
            part,
            sound: true,
            told: told.into(),
        }
    }

    pub fn wrong(part: &'static str, fault: impl Into<String>) -> Self {
        Self {
            part,
            sound: false,
            told: fault.into(),
        }
    }
}
