//! Damage of a run log that cannot be trusted. In: nothing. Out: the position and the reason, for the reader. It cannot be repaired.

use super::{FORMAT, LINE_BYTES};

/// The run log was altered, or is not one: it must not be continued.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the run log is damaged at line {line} (byte {offset}{}): {reason}", .step.map(|step| format!(", after step {step}")).unwrap_or_default())]
pub struct Damage {
    /// Offset of the first byte of the first bad line.
    pub offset: u64,
    /// From 1.
    pub line: u64,
    /// The last field `step` in the valid lines before it.
    pub step: Option<u64>,
    pub reason: Wrong,
}

/// The damage of a line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Wrong {
    #[error("this is not an entry")]
    Shape,
    #[error("the line has more than {LINE_BYTES} bytes")]
    TooLong,
    #[error("the checksum does not match the bytes")]
    Checksum,
    #[error("entry {found} is at the position of entry {expected}")]
    Sequence { expected: u64, found: u64 },
    #[error(
        "the hash chain from the entry before is broken: one of the two was altered, or is from another run"
    )]
    Chain,
    #[error("unknown entry type {0}")]
    UnknownKind(String),
    #[error("its body is not a JSON object")]
    NotAnObject,
    #[error("the run log does not begin with HEADER")]
    NoHeader,
    #[error("a second HEADER")]
    SecondHeader,
    #[error("its format is version {found}; this psd reads version {FORMAT}")]
    Format { found: String },
    #[error("END states {count} entries with head {head}, but the entries before it differ")]
    EndOfAnother { count: String, head: String },
    #[error("an entry follows END")]
    AfterEnd,
}
