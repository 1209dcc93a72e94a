//! Row groups of a data set and their digests. In: the bytes on their way into the file. Out: length and SHA-256 of each row group, which
//! the reader compares before it decodes anything.

use std::io::{self, Write};
use std::sync::{Arc, Mutex, PoisonError};

use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

use psd_text::digest::hex;

/// A row group as the footer describes it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Group {
    pub rows: u64,
    /// Its bytes in the file; the first row group begins with the first byte of the file.
    pub bytes: u64,
    pub sha256: String,
}

/// What was written since the last row group ended.
#[derive(Default)]
pub struct Meter {
    bytes: u64,
    digest: Sha256,
    /// The end of the file, which is not written yet.
    held: Option<Vec<u8>>,
}

/// The meter, shared by the writer of the file and the one who ends its row groups.
#[derive(Clone, Default)]
pub struct SharedMeter(Arc<Mutex<Meter>>);

impl SharedMeter {
    /// The bytes so far are a row group.
    pub fn end_group(&self, rows: u64) -> Group {
        let mut meter = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let Meter { bytes, digest, .. } = std::mem::take(&mut *meter);
        Group {
            rows,
            bytes,
            sha256: hex(&digest.finalize()),
        }
    }

    /// Holds the bytes that follow.
    pub fn hold(&self) {
        let mut meter = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        meter.held = Some(Vec::new());
    }

    /// The bytes since [`SharedMeter::hold`].
    pub fn held(&self) -> Vec<u8> {
        let mut meter = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        meter.held.take().unwrap_or_default()
    }

    /// Whether the bytes are held.
    fn holds(&self, bytes: &[u8]) -> bool {
        let mut meter = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let held = meter.held.as_mut().map(|held| held.extend(bytes));
        held.is_some()
    }

    fn count(&self, bytes: &[u8]) {
        let mut meter = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        meter.bytes += bytes.len() as u64;
        meter.digest.update(bytes);
    }
}

/// Forwards bytes and counts them.
pub struct Metered<W> {
    pub out: W,
    pub meter: SharedMeter,
}

impl<W: Write> Write for Metered<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.meter.holds(bytes) {
            return Ok(bytes.len());
        }
        let written = self.out.write(bytes)?;
        self.meter.count(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}
