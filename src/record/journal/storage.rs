//! Where a journal lies: bytes that are appended, and the promise that they survive. In: bytes. Out: whether they are
//! safe. It knows no record.

use std::io;

/// Append-only bytes. An error of any call is final for the run: nothing after it may be believed.
pub trait Storage: Send {
    /// Appends all the bytes, whatever short writes or interrupted calls it takes.
    ///
    /// # Errors
    /// They could not all be appended; some may have been.
    fn append(&mut self, bytes: &[u8]) -> io::Result<()>;

    /// Gives back once everything appended would survive a loss of power.
    ///
    /// # Errors
    /// The promise cannot be made; it is never asked for again.
    fn sync(&mut self) -> io::Result<()>;

    /// Cuts back to the first `length` bytes: half a line, left by an append that failed, must not spoil the last words.
    ///
    /// # Errors
    /// The half line is still there.
    fn cut(&mut self, length: u64) -> io::Result<()>;

    /// Frees what was kept in reserve, so that the last words find room on a full disk.
    fn release_reserve(&mut self) {}
}
