//! A disk that knows its durable bytes. In: the bytes of a run log, with its syncs. Out: the bytes after a loss of power: all synced
//! bytes, and any part of the rest. It does not know the entries.

use std::io;
use std::sync::{Arc, Mutex, MutexGuard};

use psd_rig::journal::Storage;

/// Number of bytes that a disk writes together.
const SECTOR_BYTES: usize = 512;

/// A disk in memory. Its clones are the same disk: a test keeps one and gives the other to the run log.
#[derive(Clone, Debug, Default)]
pub struct PowerLoss(Arc<Mutex<Disk>>);

#[derive(Debug, Default)]
struct Disk {
    written: Vec<u8>,
    /// Number of bytes that are durable.
    synced: usize,
    syncs: usize,
}

impl PowerLoss {
    pub fn new() -> Self {
        Self::default()
    }

    /// A disk that contains durable bytes.
    pub fn holding(bytes: &[u8]) -> Self {
        let disk = Disk {
            written: bytes.to_vec(),
            synced: bytes.len(),
            syncs: 0,
        };
        Self(Arc::new(Mutex::new(disk)))
    }

    /// All the bytes that can be read while the power is on.
    pub fn written(&self) -> Vec<u8> {
        self.disk().written.clone()
    }

    /// The durable bytes.
    pub fn synced(&self) -> Vec<u8> {
        let disk = self.disk();
        disk.written[..disk.synced].to_vec()
    }

    /// Number of requests to make the bytes durable.
    pub fn syncs(&self) -> usize {
        self.disk().syncs
    }

    /// The bytes after a loss of power: the durable bytes and at most `length` of the others. In sectors that are not `kept`, the other
    /// bytes are zero, as on a disk that writes the file length before the blocks.
    pub fn after_loss(&self, length: usize, mut kept: impl FnMut(usize) -> bool) -> Vec<u8> {
        let disk = self.disk();
        let end = disk.written.len().min(disk.synced.saturating_add(length));
        let mut left = disk.written[..end].to_vec();
        for sector in disk.synced / SECTOR_BYTES..end.div_ceil(SECTOR_BYTES) {
            if !kept(sector) {
                let from = disk.synced.max(sector * SECTOR_BYTES);
                left[from..end.min((sector + 1) * SECTOR_BYTES)].fill(0);
            }
        }
        left
    }

    fn disk(&self) -> MutexGuard<'_, Disk> {
        self.0
            .lock()
            .expect("no test panics while it holds the disk")
    }
}

impl Storage for PowerLoss {
    fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.disk().written.extend_from_slice(bytes);
        Ok(())
    }

    fn sync(&mut self) -> io::Result<()> {
        let mut disk = self.disk();
        disk.synced = disk.written.len();
        disk.syncs += 1;
        Ok(())
    }

    fn cut(&mut self, length: u64) -> io::Result<()> {
        let length = usize::try_from(length).expect("it fits into memory");
        let mut disk = self.disk();
        disk.written.truncate(length);
        disk.synced = disk.synced.min(length);
        Ok(())
    }
}
