//! The reserve of a journal: a file beside it that only takes room, removed when the last words need it. In: the
//! journal's path. Out: whether the room is held. It knows no record.

use std::io;
use std::path::{Path, PathBuf};

use super::{beside, new_file, write_whole};

/// What the last words may take, bytes: some hundreds of records.
pub const RESERVE_BYTES: usize = 1 << 20;

/// Where the reserve of a journal lies.
pub fn path(journal: &Path) -> PathBuf {
    beside(journal, ".reserve")
}

/// Lays the reserve, or finds it laid. It is written, not only sized, with bytes that no file system makes smaller.
pub fn lay(journal: &Path) -> io::Result<()> {
    let path = path(journal);
    if let Ok(there) = path.symlink_metadata() {
        if there.is_file() && there.len() == RESERVE_BYTES as u64 {
            return Ok(());
        }
        // Of a run that was killed while laying it.
        std::fs::remove_file(&path)?;
    }
    let laid = new_file(&path).and_then(|mut file| {
        write_whole(&mut file, &incompressible())?;
        file.sync_all()
    });
    laid.inspect_err(|_| release(journal))
}

/// Gives the room back; there is no other chance if it cannot be.
pub fn release(journal: &Path) {
    let _ = std::fs::remove_file(path(journal));
}

/// Whether these bytes are a reserve, or what is laid of one that was being laid.
pub fn is_part_of_one(bytes: &[u8]) -> bool {
    incompressible().starts_with(bytes)
}

/// Marsaglia's xorshift, 64 bits: noise enough that compression finds nothing.
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
