//! The footer of a data set with a digest before it. In: the end of the file as Parquet has it, or a file. Out: the same with the digest, or
//! whether the footer is intact. No byte of a footer is parsed before it is verified: a parser may fail badly on a changed one.
//!
//! A Parquet file ends with its footer, the length of that, and `PAR1`. Readers begin there, so that bytes before the footer are free.

use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom};

use sha2::{Digest as _, Sha256};

const MAGIC: &[u8] = b"PAR1";
/// Bytes of the length and of `PAR1`.
const TAIL: u64 = 8;
const MARK: &[u8] = b"psd-foot";
/// Bytes of the mark and of the digest.
const SEAL: u64 = 8 + 32;

/// What the end of a file says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Footer {
    /// It does not end as a Parquet file does.
    Incomplete,
    /// A Parquet file without a digest before its footer.
    Foreign,
    /// The digest is not that of the footer.
    Damaged,
    Intact,
}

/// The end of a file with the digest of its footer before it.
pub fn with_digest(end: &[u8]) -> Vec<u8> {
    let length = footer_length(&end[end.len().saturating_sub(8)..]).unwrap_or(0);
    let from = (end.len() as u64).saturating_sub(TAIL + length);
    let (before, footer) = end.split_at(usize::try_from(from).unwrap_or(0));
    [before, MARK, &Sha256::digest(footer), footer].concat()
}

/// The length of the footer in the last bytes of a file; None if they are not those of a Parquet file.
fn footer_length(tail: &[u8]) -> Option<u64> {
    let (length, magic) = tail.split_first_chunk::<4>()?;
    (magic == MAGIC).then(|| u64::from(u32::from_le_bytes(*length)))
}

/// Verifies the footer of a file.
///
/// # Errors
/// The file cannot be read.
pub fn verify(file: &mut File) -> io::Result<Footer> {
    let bytes = file.metadata()?.len();
    let mut read = |from: u64, length: u64| -> io::Result<Vec<u8>> {
        file.seek(SeekFrom::Start(from))?;
        let mut part = Vec::new();
        (&mut *file).take(length).read_to_end(&mut part)?;
        Ok(part)
    };
    let Some(tail) = bytes.checked_sub(TAIL) else {
        return Ok(Footer::Incomplete);
    };
    let Some(length) = footer_length(&read(tail, TAIL)?) else {
        return Ok(Footer::Incomplete);
    };
    let Some(footer) = tail.checked_sub(length) else {
        return Ok(Footer::Damaged);
    };
    let Some(from) = footer.checked_sub(SEAL) else {
        return Ok(Footer::Foreign);
    };
    let seal = read(from, SEAL)?;
    let Some(digest) = seal.strip_prefix(MARK) else {
        return Ok(Footer::Foreign);
    };
    let found = Sha256::digest(read(footer, length + TAIL)?);
    Ok(if found.as_slice() == digest {
        Footer::Intact
    } else {
        Footer::Damaged
    })
}
