//! The reserve of a run log: a file beside it that only occupies disk space, and is removed when the final entries need it.
//! In: the path of the run log. Out: whether the space is reserved. It knows no entry.

use std::io;
use std::path::{Path, PathBuf};

use super::{beside, new_file, write_whole};

/// Space for the final entries \[bytes\]: several hundred entries.
pub const RESERVE_BYTES: usize = 1 << 20;

/// Path of the reserve of a run log.
pub fn path(journal: &Path) -> PathBuf {
    beside(journal, ".reserve")
}

/// Creates the reserve, or finds an existing one. It is written in full, not only allocated, with bytes that no file system can compress.
pub fn lay(journal: &Path) -> io::Result<()> {
    let path = path(journal);
    if let Ok(there) = path.symlink_metadata() {
        if there.is_file() && there.len() == RESERVE_BYTES as u64 {
            return Ok(());
        }
        // Left by a run that was killed while creating it.
        std::fs::remove_file(&path)?;
    }
    let laid = new_file(&path).and_then(|mut file| {
        write_whole(&mut file, &incompressible())?;
        file.sync_all()
    });
    laid.inspect_err(|_| release(journal))
}

/// Frees the space. If this fails, it cannot be repeated.
pub fn release(journal: &Path) {
    let _ = std::fs::remove_file(path(journal));
}

/// Whether these bytes are a reserve, or a part of one that was being created.
pub fn is_part_of_one(bytes: &[u8]) -> bool {
    incompressible().starts_with(bytes)
}

/// Marsaglia's xorshift, 64 bits: random enough to prevent compression.
fn incompressible() -> Vec<u8> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let words = (0..RESERVE_BYTES / 8).flat_map(|_| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state.to_le_bytes()
    });
    words.collect()
}
