//! Writing: entries become lines on a storage. In: kinds and bodies, and when they must be durable. Out: the fault that ended the run
//! log. It does not know the meaning of an entry, nor where the bytes are stored.

use serde::Serialize;
use serde_json::json;

use super::chain::Chain;
use super::line::{self, LINE_BYTES};
use super::{Doing, EntryKind, FORMAT, JournalFault, Recovered, Refusal, Storage, body};
use psd_plan::record::failpoint::{Guarding, on};

/// When entries are passed to the storage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Durability {
    /// In large writes and with each digest of many steps, made durable at the end and by `sync`: for a virtual rig, whose run can be repeated.
    Buffered,
    /// Each entry immediately, made durable at every sync point: a real rig.
    EverySyncPoint,
}

/// Number of bytes that are buffered before they are written.
const WRITE_BYTES: usize = 64 * 1024;

/// A run log that is being written.
pub struct Journal {
    storage: Box<dyn Storage>,
    durability: Durability,
    /// Number of entries, including buffered ones.
    count: u64,
    chain: Chain,
    ended: bool,
    /// Lines that the storage has not accepted yet, or not completely.
    buffered: Vec<u8>,
    /// Number of bytes of the lines that it has accepted.
    written_length: u64,
    /// Whether a part of `buffered` may lie after them.
    half_line: bool,
    /// The fault of the storage that ended the run log.
    pub(super) fault: Option<JournalFault>,
}

impl Journal {
    /// A run log on empty storage.
    pub fn create(storage: Box<dyn Storage>, durability: Durability) -> Self {
        Self {
            storage,
            durability,
            count: 0,
            chain: Chain::START,
            ended: false,
            buffered: Vec::new(),
            written_length: 0,
            half_line: false,
            fault: None,
        }
    }

    /// Continues after the recovered entries; a torn tail was cut off before.
    pub fn reopen(
        storage: Box<dyn Storage>,
        durability: Durability,
        recovered: &Recovered,
    ) -> Self {
        let mut journal = Self::create(storage, durability);
        journal.count = recovered.lines.len() as u64;
        journal.chain = recovered.chain;
        journal.ended = recovered.ended;
        journal.written_length = recovered.whole;
        journal
    }

    /// Writes an entry.
    ///
    /// # Errors
    /// The body is not an object of finite numbers, is too large or is at a wrong position: nothing was written, and the run log can be
    /// continued. Or the storage failed, now or earlier.
    pub fn append(&mut self, kind: EntryKind, body: &impl Serialize) -> Result<(), JournalFault> {
        self.healthy()?;
        if kind == EntryKind::End {
            return Err(Refusal::OutOfSequence(kind).into());
        }
        self.buffer(kind, body)?;
        let enough = match self.durability {
            Durability::Buffered if kind != EntryKind::Digest => WRITE_BYTES,
            Durability::Buffered | Durability::EverySyncPoint => 1,
        };
        if self.buffered.len() >= enough {
            self.flush()
        } else {
            Ok(())
        }
    }

    /// All entries written so far are durable when this returns. While buffered, nothing is guaranteed.
    ///
    /// # Errors
    /// The storage failed, now or before: entries may be lost.
    pub fn sync_point(&mut self) -> Result<(), JournalFault> {
        match self.durability {
            Durability::Buffered => self.healthy(),
            Durability::EverySyncPoint => self.sync(),
        }
    }

    /// All entries written so far are durable when this returns.
    ///
    /// # Errors
    /// As `sync_point`.
    pub fn sync(&mut self) -> Result<(), JournalFault> {
        self.healthy()?;
        self.flush()?;
        let synced = self.storage.sync();
        self.record_fault(Doing::Sync, synced)?;
        let unchanged = self.storage.is_unchanged();
        self.record_fault(Doing::Compare, unchanged)
    }

    /// Writes the last entry, with the count of entries and the chain before it, and makes all of them durable.
    ///
    /// # Errors
    /// As `append` and `sync`.
    pub fn end(&mut self, body: &impl Serialize) -> Result<(), JournalFault> {
        self.healthy()?;
        let (start, chain) = (self.buffered.len(), self.chain);
        self.buffer(EntryKind::End, body)?;
        if let Err(fault) = self.flush() {
            // The run log has no END: final entries are still possible.
            self.buffered.truncate(start);
            self.chain = chain;
            self.count -= 1;
            self.ended = false;
            return Err(fault);
        }
        self.sync()?;
        self.storage.release_reserve();
        Ok(())
    }

    /// The final entry before a run is abandoned. It frees the reserve, then writes the buffered lines and this entry. It makes them
    /// durable as far as possible, also if the storage has failed before; after a failed sync they are only written. The earlier fault
    /// remains for all other calls.
    ///
    /// # Errors
    /// The entry is invalid or comes after END, or the storage failed now. Nothing more can be done.
    pub fn final_entry(
        &mut self,
        kind: EntryKind,
        body: &impl Serialize,
    ) -> Result<(), JournalFault> {
        self.storage.release_reserve();
        let earlier = self.fault.take();
        let unsynced = matches!(
            earlier,
            Some(JournalFault::Storage {
                doing: Doing::Sync,
                ..
            })
        );
        let ended = self.write_final_entry(kind, body, unsynced && on(Guarding::FailedSync));
        if earlier.is_some() {
            self.fault = earlier;
        }
        ended
    }

    fn write_final_entry(
        &mut self,
        kind: EntryKind,
        body: &impl Serialize,
        unsynced: bool,
    ) -> Result<(), JournalFault> {
        if self.half_line {
            // After an incomplete line, another line would make the file look like a forged one, so nothing is written.
            let cut = self.storage.cut(self.written_length);
            self.record_fault(Doing::Cut, cut)?;
            self.half_line = false;
        }
        let kept = if kind == EntryKind::End {
            Err(Refusal::OutOfSequence(kind))
        } else {
            self.buffer(kind, body)
        };
        // The buffered lines are written to the file, also without the entry. After a failed sync no other sync is attempted: it would
        // succeed although data are lost.
        if unsynced {
            self.flush()?;
        } else {
            self.sync()?;
        }
        Ok(kept?)
    }

    /// Number of entries written, including buffered ones: the number of the last one.
    pub const fn count(&self) -> u64 {
        self.count
    }

    /// The chain after the last entry: 64 hexadecimal digits.
    pub fn head(&self) -> &str {
        self.chain.as_str()
    }

    /// A storage that failed is not used again. After a failed sync the kernel discards the data that it could not write, and the next
    /// sync would succeed although they are lost.
    fn healthy(&self) -> Result<(), JournalFault> {
        match &self.fault {
            Some(JournalFault::Storage {
                doing: Doing::Sync, ..
            }) if !on(Guarding::FailedSync) => Ok(()),
            Some(fault) => Err(fault.clone()),
            None => Ok(()),
        }
    }

    /// Formats the line of an entry; a refused entry has no effect.
    fn buffer(&mut self, kind: EntryKind, body: &impl Serialize) -> Result<(), Refusal> {
        let start = self.buffered.len();
        let made = self.make_line(start, kind, body);
        match made {
            Ok(chain) => {
                self.chain = chain;
                self.count += 1;
                self.ended = kind == EntryKind::End;
                Ok(())
            }
            Err(refusal) => {
                self.buffered.truncate(start);
                self.buffered.shrink_to(2 * WRITE_BYTES);
                Err(refusal)
            }
        }
    }

    fn make_line(
        &mut self,
        start: usize,
        kind: EntryKind,
        body: &impl Serialize,
    ) -> Result<Chain, Refusal> {
        if self.ended || (kind == EntryKind::Header) != (self.count == 0) {
            return Err(Refusal::OutOfSequence(kind));
        }
        let out = &mut self.buffered;
        line::open(out, self.count + 1, kind);
        match kind {
            EntryKind::Header => body::write_with(out, &[("format", json!(FORMAT))], body)?,
            EntryKind::End => {
                let own = [
                    ("count", json!(self.count)),
                    ("head", json!(self.chain.as_str())),
                ];
                body::write_with(out, &own, body)?;
            }
            _ => body::write(out, body)?,
        }
        let bytes = out.len() - start + line::CHECK_BYTES + 1;
        if bytes > LINE_BYTES {
            return Err(Refusal::TooLong { bytes });
        }
        Ok(line::close(out, start, &self.chain))
    }

    /// Writes the buffered lines to the storage.
    fn flush(&mut self) -> Result<(), JournalFault> {
        if self.buffered.is_empty() {
            return Ok(());
        }
        let appended = self.storage.append(&self.buffered);
        self.half_line = appended.is_err();
        self.record_fault(Doing::Append, appended)?;
        self.written_length += self.buffered.len() as u64;
        self.buffered.clear();
        Ok(())
    }

    fn record_fault(
        &mut self,
        doing: Doing,
        done: std::io::Result<()>,
    ) -> Result<(), JournalFault> {
        done.map_err(|error| {
            let fault = JournalFault::storage(doing, &error);
            self.fault = Some(fault.clone());
            fault
        })
    }
}

/// The buffered lines are written to the file also if the run is left early; this is not guaranteed.
impl Drop for Journal {
    fn drop(&mut self) {
        if self.fault.is_none() {
            let _ = self.flush();
        }
    }
}
