//! The bytes of a run log, in memory or in its file. In: a range. Out: the bytes there. Of a file, only the part that was read last is in
//! memory: the lines of a long run need several hundred megabytes.

use std::fs::File;
use std::io;
use std::ops::Range;
use std::os::unix::fs::FileExt as _;
use std::sync::{Arc, Mutex, PoisonError};

/// A run log is read from its file in blocks of this size \[bytes\].
const BLOCK_BYTES: u64 = 1 << 17;

/// The bytes of a run log. All copies share them. They must not change: the file is locked, or is no longer written.
#[derive(Clone, Debug)]
pub struct LogText(Arc<Source>);

#[derive(Debug)]
enum Source {
    Memory(Vec<u8>),
    File { length: u64, window: Mutex<Window> },
}

/// The part of a file that is in memory.
#[derive(Debug)]
struct Window {
    file: File,
    /// Offset of its first byte.
    start: u64,
    bytes: Vec<u8>,
}

impl From<Vec<u8>> for LogText {
    fn from(bytes: Vec<u8>) -> Self {
        Self(Arc::new(Source::Memory(bytes)))
    }
}

impl LogText {
    /// The bytes that the file has now.
    ///
    /// # Errors
    /// The file does not give its length.
    pub fn of_file(file: File) -> io::Result<Self> {
        let length = file.metadata()?.len();
        let window = Window {
            file,
            start: 0,
            bytes: Vec::new(),
        };
        Ok(Self(Arc::new(Source::File {
            length,
            window: Mutex::new(window),
        })))
    }

    /// Number of bytes.
    #[must_use]
    pub fn length(&self) -> u64 {
        match &*self.0 {
            Source::Memory(bytes) => bytes.len() as u64,
            Source::File { length, .. } => *length,
        }
    }

    /// What `with` makes of the bytes in this range; a range beyond the end is shortened.
    ///
    /// # Errors
    /// The file cannot be read, or has become shorter.
    pub fn read<R>(&self, range: Range<u64>, with: impl FnOnce(&[u8]) -> R) -> io::Result<R> {
        let end = range.end.min(self.length());
        let range = range.start.min(end)..end;
        match &*self.0 {
            Source::Memory(bytes) => Ok(with(&bytes[within(&range, 0)])),
            Source::File { length, window } => {
                let mut window = window.lock().unwrap_or_else(PoisonError::into_inner);
                window.hold(&range, *length)?;
                Ok(with(&window.bytes[within(&range, window.start)]))
            }
        }
    }

    /// Gives all the bytes to `take`, block by block.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn read_blocks(&self, mut take: impl FnMut(&[u8])) -> io::Result<()> {
        let block = usize::try_from(BLOCK_BYTES).unwrap_or(usize::MAX);
        (0..self.length())
            .step_by(block)
            .try_for_each(|start| self.read(start..start + BLOCK_BYTES, &mut take))
    }
}

impl Window {
    /// Reads the blocks of this range, unless they are in memory.
    fn hold(&mut self, range: &Range<u64>, length: u64) -> io::Result<()> {
        let held = self.start..self.start + self.bytes.len() as u64;
        if held.start <= range.start && range.end <= held.end {
            return Ok(());
        }
        let start = range.start / BLOCK_BYTES * BLOCK_BYTES;
        let end = (range.end.div_ceil(BLOCK_BYTES) * BLOCK_BYTES).min(length);
        self.start = start;
        self.bytes
            .resize(usize::try_from(end - start).unwrap_or(usize::MAX), 0);
        let read = self.fill();
        // Bytes of a failed read are never used.
        self.bytes.truncate(*read.as_ref().unwrap_or(&0));
        read?;
        if self.start + (self.bytes.len() as u64) < range.end {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        Ok(())
    }

    /// Reads all bytes from `start` on that the file has; returns their number. The torn end of a log is cut off while its entries are in
    /// use, so that the last block may be shorter than it was.
    fn fill(&mut self) -> io::Result<usize> {
        let mut done = 0;
        while done < self.bytes.len() {
            match self
                .file
                .read_at(&mut self.bytes[done..], self.start + done as u64)
            {
                Ok(0) => break,
                Ok(count) => done += count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(done)
    }
}

/// The range as indices of bytes that begin at `start`.
fn within(range: &Range<u64>, start: u64) -> Range<usize> {
    let index = |at: u64| usize::try_from(at - start).unwrap_or(usize::MAX);
    index(range.start)..index(range.end)
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::*;

    #[test]
    fn a_file_and_memory_give_the_same_bytes_in_any_order() {
        let bytes: Vec<u8> = (0..400_000_u32).map(|at| (at % 251) as u8).collect();
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(&bytes).unwrap();
        let (memory, file) = (
            LogText::from(bytes.clone()),
            LogText::of_file(file).unwrap(),
        );
        assert_eq!((memory.length(), file.length()), (400_000, 400_000));
        for range in [
            0..10,
            131_000..131_200,
            399_990..400_100,
            5..200_000,
            400_100..400_200,
            0..0,
            100..101,
        ] {
            let read = |text: &LogText| text.read(range.clone(), <[u8]>::to_vec).unwrap();
            let whole = |at: u64| usize::try_from(at.min(400_000)).unwrap();
            let expected = &bytes[whole(range.start)..whole(range.end)];
            assert_eq!(read(&memory), expected, "{range:?}");
            assert_eq!(read(&file), expected, "{range:?}");
        }
    }

    #[test]
    fn of_a_file_that_became_shorter_the_rest_is_read_and_no_other_byte() {
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(&vec![7; 300_000]).unwrap();
        let text = LogText::of_file(file.try_clone().unwrap()).unwrap();
        file.set_len(290_000).unwrap();
        let sum = |bytes: &[u8]| bytes.iter().map(|byte| u64::from(*byte)).sum::<u64>();
        assert_eq!(text.read(270_000..290_000, sum).unwrap(), 140_000);
        assert!(text.read(280_000..290_001, sum).is_err());
        assert!(text.read(299_000..300_000, sum).is_err());
        assert_eq!(text.read(0..10, sum).unwrap(), 70);
    }
}
