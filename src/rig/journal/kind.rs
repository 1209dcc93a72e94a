//! The kind of an entry. In: the second word of a line. Out: its kind, and back. It knows no body.

use serde::{Deserialize, Serialize};

/// The kind of an entry; the second word of its line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum EntryKind {
    /// Format version, names and digests of the plan's files, settings, operator, host: the start of a run. Always the
    /// first entry.
    Header,
    /// A part of the text of one of those files.
    Plan,
    /// The identity that the rig reported.
    Rig,
    /// A target that is about to be sent.
    Intent,
    /// A reading, with the bytes from which it was decoded.
    Sample,
    /// The end of a stroke with readings during the motion, and their number.
    Stroke,
    /// The end of a step, as computed.
    Step,
    /// The digest of the targets, readings and steps since the entry before, in the compact run log of a simulation.
    Digest,
    /// An answer or a request of the operator.
    Operator,
    Event,
    Fault,
    /// The result of the final hold, and the position of the rig.
    Held,
    /// The communication errors recovered, if there were any.
    #[serde(rename = "TALLY")]
    LineStatistics,
    /// A torn tail was put aside.
    Recover,
    /// The plan or the program differs from that of the header: by whom it was changed, and why.
    Amend,
    /// The run is continued.
    Resume,
    /// The run was completed; count of entries and the chain before it.
    End,
}

impl EntryKind {
    pub const ALL: [Self; 17] = [
        Self::Header,
        Self::Plan,
        Self::Rig,
        Self::Intent,
        Self::Sample,
        Self::Stroke,
        Self::Step,
        Self::Digest,
        Self::Operator,
        Self::Event,
        Self::Fault,
        Self::Held,
        Self::LineStatistics,
        Self::Recover,
        Self::Amend,
        Self::Resume,
        Self::End,
    ];

    /// Its word in the line.
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
            Self::Digest => "DIGEST",
            Self::Operator => "OPERATOR",
            Self::Event => "EVENT",
            Self::Fault => "FAULT",
            Self::Held => "HELD",
            Self::LineStatistics => "TALLY",
            Self::Recover => "RECOVER",
            Self::Amend => "AMEND",
            Self::Resume => "RESUME",
            Self::End => "END",
        }
    }

    /// The kind of a word. None if this format has no such entry.
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
