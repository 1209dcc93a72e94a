//! What a record is about. In: the second word of a line. Out: its kind, and back. It knows no body.

use serde::{Deserialize, Serialize};

/// What a record is about; the second word of its line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum EntryKind {
    /// Format version, names and digests of the plan's files, settings, operator, host: what a run starts from. Always the
    /// first.
    Header,
    /// A part of the text of one of those files.
    Plan,
    /// Who the rig said it is.
    Rig,
    /// A target about to be sent.
    Intent,
    /// A reading, with the bytes it was made of.
    Sample,
    /// The end of a stroke read on the way, with how many readings it gave.
    Stroke,
    /// The end of a step, as computed.
    Step,
    /// What a person answered, or asked for.
    Operator,
    Event,
    Fault,
    /// What became of the rig when it was told to hold for good, and where it stood then.
    Held,
    /// What was mended on the lines of the rig by the end of the run, where anything was.
    Tally,
    /// A torn tail was put aside.
    Recover,
    /// The plan or the program is no longer the one of the header; who says so, and why.
    Amend,
    /// The run goes on.
    Resume,
    /// The run came to an end; count of records and the chain before it.
    End,
}

impl EntryKind {
    pub const ALL: [Self; 16] = [
        Self::Header,
        Self::Plan,
        Self::Rig,
        Self::Intent,
        Self::Sample,
        Self::Stroke,
        Self::Step,
        Self::Operator,
        Self::Event,
        Self::Fault,
        Self::Held,
        Self::Tally,
        Self::Recover,
        Self::Amend,
        Self::Resume,
        Self::End,
    ];

    /// The word in the line.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Header => "HEADER",
            Self::Plan => "PLAN",
            Self::Rig => "RIG",
            Self::Intent => "INTENT",
            Self::Sample => "SAMPLE",
            Self::Stroke => "STROKE",
            Self::Step => "STEP",
            Self::Operator => "OPERATOR",
            Self::Event => "EVENT",
            Self::Fault => "FAULT",
            Self::Held => "HELD",
            Self::Tally => "TALLY",
            Self::Recover => "RECOVER",
            Self::Amend => "AMEND",
            Self::Resume => "RESUME",
            Self::End => "END",
        }
    }

    /// The kind of a word; None if no record of this format has it.
    #[must_use]
    pub fn of_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.word() == word)
    }
}

#[cfg(test)]
mod tests {
    use super::EntryKind;

    #[test]
    fn every_word_reads_back_and_is_the_one_of_the_json() {
        for kind in EntryKind::ALL {
            assert_eq!(EntryKind::of_word(kind.word()), Some(kind));
            assert_eq!(serde_json::to_value(kind).unwrap(), kind.word());
        }
        assert_eq!(EntryKind::of_word("header"), None);
        assert_eq!(EntryKind::of_word(""), None);
    }
}
