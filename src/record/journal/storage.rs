//! The storage of a run log: bytes that are appended, and a guarantee that they survive. In: bytes. Out: whether they are
//! durable. It knows no entry.

use std::io;

/// Append-only bytes. An error of any call is final for the run: nothing after it may be believed.
pub trait Storage: Send {
    /// Appends all the bytes, whatever short writes or interrupted calls it takes.
    ///
    /// # Errors
    /// They could not all be appended; some may have been.
    fn append(&mut self, bytes: &[u8]) -> io::Result<()>;

    /// Returns when all appended bytes would survive a loss of power.
    ///
    /// # Errors
    /// The promise cannot be made; it is never asked for again.
    fn sync(&mut self) -> io::Result<()>;

    /// Cuts back to the first `length` bytes: half a line, left by a failed append, must not spoil the final entries.
    ///
    /// # Errors
    /// The half line is still there.
    fn cut(&mut self, length: u64) -> io::Result<()>;

    /// Frees the reserve, so that the final entries have space on a full disk.
    fn release_reserve(&mut self) {}
}
