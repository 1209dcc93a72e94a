//! The journal: one append-only ASCII file, one record a line, each checkable alone (CRC-32C) and in its order (a chain
//! of SHA-256). In: records as JSON. Out: lines; and back, with what of a damaged file can be trusted. It does not know
//! what a record means.
//!
//! # The format, version 2
//!
//! A journal is lines of printable ASCII (bytes 0x20 to 0x7e), each ended by one LF and at most 64 KiB long with it:
//!
//! ```text
//! SEQ TYPE JSON CHAIN CRC
//! ```
//!
//! - `SEQ`: the number of the line, decimal, from 1, without gaps: record 17 is line 17.
//! - `TYPE`: one of the words of [`EntryKind`]. The first record and no other is `HEADER`; nothing follows `END`.
//! - `JSON`: one object, without blanks between its parts. Everything outside 0x20 to 0x7e is a `\u` escape, also DEL.
//!   Numbers are the shortest decimals that read back as the same 64-bit float. `HEADER` begins with `"format":2`, `END`
//!   with `"count"` (records before it) and `"head"` (`CHAIN` of the record before it).
//! - `CHAIN`: 64 lower-case hexadecimal digits, the SHA-256 of these bytes, one after the other: the 64 digits of the
//!   line before (64 times `0` at line 1), then `SEQ TYPE JSON` as written in this line, with the two blanks between.
//! - `CRC`: 8 lower-case hexadecimal digits, the CRC-32C (Castagnoli, reflected 0x82f63b78, start and final inversion)
//!   of every byte of the line before them, the blank included.
//!
//! JSON holds blanks; `CHAIN` and `CRC` are found from the end of the line. So line 7 is checked by hand, without psd:
//!
//! ```sh
//! cut_off() { sed 's/ [0-9a-f]\{64\} [0-9a-f]\{8\}$//'; }
//! before=$(sed -n 6p journal | awk '{print $(NF-1)}')
//! { printf %s "$before"; sed -n 7p journal | cut_off | tr -d '\n'; } | sha256sum
//! sed -n 7p journal | awk '{print $(NF-1)}'   # must be the same
//! ```

mod body;
mod chain;
mod damage;
mod fault;
mod file;
mod finite;
mod kind;
mod line;
mod recovery;
mod storage;
#[cfg(test)]
pub(crate) mod testing;
#[cfg(test)]
mod tests;
mod writer;

pub use damage::{Damage, Wrong};
pub use fault::{Doing, JournalFault, Refusal};
pub use file::{FileFault, FileStorage, MOST_BYTES, is_part_of_a_reserve};
pub use kind::EntryKind;
pub use line::{LINE_BYTES, Line};
pub use recovery::{Recovered, recover};
pub use storage::Storage;
pub use writer::{Durability, Journal};

/// The version of the format that is written. Version 1, which is read too, does not say in its first line what was measured
/// with.
pub const FORMAT: u64 = 2;

/// The oldest version that is read.
pub const OLDEST_FORMAT: u64 = 1;
