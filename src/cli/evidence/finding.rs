//! The finding of one part of a verification.

/// The finding of one part of a verification.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    pub part: &'static str,
    pub sound: bool,
    pub statement: String,
}

impl Finding {
    pub fn sound(part: &'static str, statement: impl Into<String>) -> Self {
        Self {
            part,
            sound: true,
            statement: statement.into(),
        }
    }

    pub fn wrong(part: &'static str, fault: impl Into<String>) -> Self {
        Self {
            part,
            sound: false,
            statement: fault.into(),
        }
    }
}
