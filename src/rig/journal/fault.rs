//! The reason why the run log did not accept an entry. In: nothing. Out: a fault that can be kept and reported again. It
//! knows no file.

use std::io;

use super::EntryKind;

/// Largest depth of nested objects and lists, including the outermost: `serde_json` reads 127.
pub const DEEPEST: usize = 64;

/// An entry was not written, or not made durable.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum JournalFault {
    /// The disk failed. Final: every later call gives the same fault and does not use the disk again.
    #[error("the run log cannot be {doing}: {text}")]
    Storage {
        doing: Doing,
        kind: io::ErrorKind,
        text: String,
    },
    /// The entry is invalid; nothing was written, and the run log can be continued.
    #[error("the run log rejects an entry: {0}")]
    Refused(#[from] Refusal),
}

impl JournalFault {
    /// Whether another program changed the run log.
    #[must_use]
    pub const fn is_foreign(&self) -> bool {
        matches!(
            self,
            Self::Storage {
                doing: Doing::Compare,
                ..
            }
        )
    }

    pub(super) fn storage(doing: Doing, error: &io::Error) -> Self {
        Self::Storage {
            doing,
            kind: error.kind(),
            text: error.to_string(),
        }
    }
}

/// The operation of the disk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Doing {
    Append,
    Sync,
    /// Comparison with the file that was opened.
    Compare,
    /// Removal of an incomplete line.
    Cut,
}

impl std::fmt::Display for Doing {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Append => "written",
            Self::Sync => "made durable",
            Self::Compare => "trusted",
            Self::Cut => "truncated",
        })
    }
}

/// The reason why an entry is invalid.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    #[error("a number in it is not finite")]
    NotFinite,
    #[error("it is not a JSON object")]
    NotAnObject,
    #[error("a number in it has more than 64 bits")]
    TooWide,
    #[error("it has more than {} nested brackets", DEEPEST)]
    TooDeep,
    #[error("its line would have {bytes} bytes (limit {})", super::LINE_BYTES)]
    TooLong { bytes: usize },
    #[error("its field `{0}` is reserved for the run log itself")]
    Reserved(&'static str),
    /// HEADER is the first and the only one; END is written by `end`; nothing follows it.
    #[error("{} is not allowed here", .0.word())]
    OutOfSequence(EntryKind),
    #[error("it cannot be converted to JSON: {0}")]
    NotJson(String),
}
