//! The run log (journal): one append-only ASCII file, one entry per line, each with its own checksum
//! (CRC-32C) and chained to the line before (SHA-256). In: entries as JSON. Out: lines; and back, with
//! the part of a damaged file that can be trusted. It does not know what an entry means. The format is
//! in `docs/record.md`.

pub mod body;
pub mod chain;
mod damage;
mod fault;
mod file;
mod finite;
mod kind;
pub mod line;
mod plain;
mod recovery;
mod storage;
#[cfg(test)]
mod tests;
mod text;
mod writer;

pub use body::is_written_as;
pub use damage::{Damage, Wrong};
pub use fault::{Doing, JournalFault, Refusal};
pub use file::{FileFault, FileStorage, MOST_BYTES, is_part_of_a_reserve};
pub use kind::EntryKind;
pub use line::{LINE_BYTES, Line};
pub use plain::Plain;
pub use recovery::{Recovered, Unreadable, recover};
pub use storage::Storage;
pub use text::LogText;
pub use writer::{Durability, Journal};

/// The version of the format.
pub const FORMAT: u64 = 2;
