//! The journal: one append-only ASCII file, one record a line, each checkable alone (CRC-32C) and in its order (a chain
//! of SHA-256). In: records as JSON. Out: lines; and back, with what of a damaged file can be trusted.

mod storage;

pub use storage::Storage;

use serde::{Deserialize, Serialize};

/// What a record is about; the second word of its line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum EntryKind {
    /// Format version, plan with every file, settings, operator, host: all a run starts from. Always the first.
    Header,
    /// Who the rig said it is.
    Rig,
    /// A target about to be sent.
    Intent,
    /// A reading, with the bytes it was made of.
    Sample,
    /// The end of a step, as computed.
    Step,
    /// What a person answered, or asked for.
    Operator,
    Event,
    Fault,
    /// A torn tail was put aside.
    Recover,
    /// The plan or the program is no longer the one of the header; who says so, and why.
    Amend,
    /// The run goes on.
    Resume,
    /// The run came to an end; count of records and the chain before it.
    End,
}
