//! A disk that fails on demand: full after some bytes, with a reserve; or at the n-th sync. In: the bytes of a run log. Out: the bytes
//! that it accepted, and the number of calls. It does not know the entries.

use std::io;
use std::sync::{Arc, Mutex, MutexGuard};

use psd_rig::journal::Storage;

/// The faults of a disk.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sickness {
    /// Number of bytes until the disk is full; the append that exceeds it is written in part. None: unlimited.
    pub room: Option<usize>,
    /// Additional bytes after the reserve is released.
    pub reserve: usize,
    /// Number of the sync that fails, from 1. None: no sync fails. Later syncs report success, as on Linux.
    pub failed_sync: Option<usize>,
    /// Whether the file cannot be truncated.
    pub uncuttable: bool,
}

/// A disk in memory; its clones are the same disk.
#[derive(Clone, Debug)]
pub struct SickDisk(Arc<Mutex<Disk>>);

#[derive(Debug)]
struct Disk {
    sickness: Sickness,
    written: Vec<u8>,
    appends: usize,
    syncs: usize,
}

impl SickDisk {
    pub fn new(sickness: Sickness) -> Self {
        Self(Arc::new(Mutex::new(Disk {
            sickness,
            written: Vec::new(),
            appends: 0,
            syncs: 0,
        })))
    }

    pub fn written(&self) -> Vec<u8> {
        self.disk().written.clone()
    }

    /// Number of appends.
    pub fn appends(&self) -> usize {
        self.disk().appends
    }

    /// Number of syncs.
    pub fn syncs(&self) -> usize {
        self.disk().syncs
    }

    fn disk(&self) -> MutexGuard<'_, Disk> {
        self.0
            .lock()
            .expect("no test panics while it holds the disk")
    }
}

impl Storage for SickDisk {
    fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        let mut disk = self.disk();
        disk.appends += 1;
        let room = disk
            .sickness
            .room
            .map_or(bytes.len(), |room| room.saturating_sub(disk.written.len()));
        let written_now = room.min(bytes.len());
        disk.written.extend_from_slice(&bytes[..written_now]);
        if written_now < bytes.len() {
            Err(io::ErrorKind::StorageFull.into())
        } else {
            Ok(())
        }
    }

    fn sync(&mut self) -> io::Result<()> {
        let mut disk = self.disk();
        disk.syncs += 1;
        if disk.sickness.failed_sync == Some(disk.syncs) {
            Err(io::Error::other("Input/output error"))
        } else {
            Ok(())
        }
    }

    fn cut(&mut self, length: u64) -> io::Result<()> {
        let mut disk = self.disk();
        if disk.sickness.uncuttable {
            return Err(io::ErrorKind::ReadOnlyFilesystem.into());
        }
        disk.written
            .truncate(usize::try_from(length).expect("it fits into memory"));
        Ok(())
    }

    fn release_reserve(&mut self) {
        let mut disk = self.disk();
        let reserve = std::mem::take(&mut disk.sickness.reserve);
        disk.sickness.room = disk.sickness.room.map(|room| room + reserve);
    }
}
