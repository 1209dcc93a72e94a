//! The storage of a run log: bytes that are appended, and a guarantee that they survive. In: bytes. Out: whether they are
//! durable. It knows no entry.

use std::io;

/// Append-only bytes. An error of any call is final for the run: no later result can be trusted.
pub trait Storage: Send {
    /// Appends all the bytes, and continues after partial writes or interrupted calls.
    ///
    /// # Errors
    /// They could not all be appended; some may have been.
    fn append(&mut self, bytes: &[u8]) -> io::Result<()>;

    /// Returns when all appended bytes would survive a loss of power.
    ///
    /// # Errors
    /// Durability cannot be guaranteed; it is never requested again.
    fn sync(&mut self) -> io::Result<()>;

    /// Whether it has exactly the bytes that were appended here, as far as their number and place show. Called after every `sync`.
    ///
    /// # Errors
    /// Another program changed it.
    fn is_unchanged(&self) -> io::Result<()> {
        Ok(())
    }

    /// Truncates to the first `length` bytes. A failed append may leave an incomplete line, which must not corrupt the final entries.
    ///
    /// # Errors
    /// The incomplete line remains.
    fn cut(&mut self, length: u64) -> io::Result<()>;

    /// Frees the reserve, so that the final entries have space on a full disk.
    fn release_reserve(&mut self) {}
}
