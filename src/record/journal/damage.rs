//! Damage of a run log that cannot be trusted. In: nothing. Out: the position and the reason, for the reader. It cannot be repaired.

use super::{FORMAT, LINE_BYTES, OLDEST_FORMAT};

/// The run log was altered, or is not one: it must not be continued.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the journal is damaged at line {line} (byte {offset}{}): {reason}", .step.map(|step| format!(", after step {step}")).unwrap_or_default())]
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
    #[error("this is no record")]
    Shape,
    #[error("the line has more than {LINE_BYTES} bytes")]
    TooLong,
    #[error("the checksum is of other bytes than these")]
    Checksum,
    #[error("record {found} stands where record {expected} belongs")]
    Sequence { expected: u64, found: u64 },
    #[error(
        "the chain does not lead here from the record before: one of the two was altered, or comes from another run"
    )]
    Chain,
    #[error("no record is called {0}")]
    UnknownKind(String),
    #[error("what it says is no JSON object")]
    NotAnObject,
    #[error("the journal does not begin with HEADER")]
    NoHeader,
    #[error("a second HEADER")]
    SecondHeader,
    #[error("its format is version {found}; this psd reads versions {OLDEST_FORMAT} to {FORMAT}")]
    Format { found: String },
    #[error("END counts {count} records with head {head}, and others stand before it")]
    EndOfAnother { count: String, head: String },
    #[error("a record stands after END")]
    AfterEnd,
}
