//! The finding of one part of a verification.

/// The finding of one part of a verification.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    pub part: &'static str,
    pub judgement: Judgement,
    pub statement: String,
}

/// Whether a part is as it must be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Judgement {
    Sound,
    Wrong,
    /// A simulation by another build of psd, which this build does not repeat.
    NotVerifiable,
}

impl Finding {
    pub fn sound(part: &'static str, statement: impl Into<String>) -> Self {
        Self::of(Judgement::Sound, part, statement)
    }

    pub fn wrong(part: &'static str, fault: impl Into<String>) -> Self {
        Self::of(Judgement::Wrong, part, fault)
    }

    pub fn not_verifiable(part: &'static str, reason: impl Into<String>) -> Self {
        Self::of(Judgement::NotVerifiable, part, reason)
    }

    fn of(judgement: Judgement, part: &'static str, statement: impl Into<String>) -> Self {
        Self {
            part,
            judgement,
            statement: statement.into(),
        }
    }

    /// Whether this part is verified.
    pub fn is_sound(&self) -> bool {
        self.judgement == Judgement::Sound
    }
}
