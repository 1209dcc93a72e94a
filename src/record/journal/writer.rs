//! Writing: records become lines on a storage. In: kinds and bodies, and when they must be safe. Out: the fault that ends
//! it all. It does not know what a record means, nor where the bytes lie.

use serde::Serialize;
use serde_json::json;

use super::chain::Chain;
use super::line::{self, LINE_BYTES};
use super::{Doing, EntryKind, FORMAT, JournalFault, Recovered, Refusal, Storage, body};
use crate::record::failpoint::{Guarding, on};

/// When records are given to the storage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Durability {
    /// In large writes, made safe at the end and by `sync`: a virtual rig, whose run can be made again.
    Buffered,
    /// Each at once, made safe at every promise: a real rig.
    EveryPromise,
}

/// Bytes kept back before they are written, when buffered.
const WRITE_BYTES: usize = 64 * 1024;

/// A journal being written.
pub struct Journal {
    storage: Box<dyn Storage>,
    durability: Durability,
    /// Records, those kept back included.
    count: u64,
    chain: Chain,
    ended: bool,
    /// Lines the storage has not taken yet, or not wholly.
    kept_back: Vec<u8>,
    /// Bytes of the lines it has taken.
    taken: u64,
    /// Whether a part of `kept_back` may lie after them.
    half_line: bool,
    fault: Option<JournalFault>,
}

impl Journal {
    /// A journal on empty storage.
    pub fn create(storage: Box<dyn Storage>, durability: Durability) -> Self {
        Self {
            storage,
            durability,
            count: 0,
            chain: Chain::START,
            ended: false,
            kept_back: Vec::new(),
            taken: 0,
            half_line: false,
            fault: None,
        }
    }

    /// Goes on behind what was recovered; a torn tail was cut off before.
    pub fn go_on(storage: Box<dyn Storage>, durability: Durability, recovered: &Recovered) -> Self {
        let mut journal = Self::create(storage, durability);
        journal.count = recovered.lines.len() as u64;
        journal.chain = recovered.chain;
        journal.ended = recovered.ended;
        journal.taken = recovered.whole;
        journal
    }

    /// Writes a record.
    ///
    /// # Errors
    /// The body is no object of finite numbers, is too large or has no place here: nothing was written, and the journal
    /// can go on. Or the storage failed, now or before.
    pub fn append(&mut self, kind: EntryKind, body: &impl Serialize) -> Result<(), JournalFault> {
        self.healthy()?;
        if kind == EntryKind::End {
            return Err(Refusal::OutOfPlace(kind).into());
        }
        self.keep_back(kind, body)?;
        let enough = match self.durability {
            Durability::Buffered => WRITE_BYTES,
            Durability::EveryPromise => 1,
        };
        if self.kept_back.len() >= enough {
            self.give()
        } else {
            Ok(())
        }
    }

    /// Everything written so far is safe when this comes back; nothing is promised while buffered.
    ///
    /// # Errors
    /// The storage failed, now or before: what was written may be lost.
    pub fn promise(&mut self) -> Result<(), JournalFault> {
        match self.durability {
            Durability::Buffered => self.healthy(),
            Durability::EveryPromise => self.sync(),
        }
    }

    /// Everything written so far is safe when this comes back.
    ///
    /// # Errors
    /// As `promise`.
    pub fn sync(&mut self) -> Result<(), JournalFault> {
        self.healthy()?;
        self.give()?;
        let synced = self.storage.sync();
        self.noted(Doing::Sync, synced)
    }

    /// Writes the last record, with the count of records and the chain before it, and makes all of it safe.
    ///
    /// # Errors
    /// As `append` and `sync`.
    pub fn end(&mut self, body: &impl Serialize) -> Result<(), JournalFault> {
        self.healthy()?;
        let (start, chain) = (self.kept_back.len(), self.chain);
        self.keep_back(EntryKind::End, body)?;
        if let Err(fault) = self.give() {
            // It did not end: there is room for last words.
            self.kept_back.truncate(start);
            self.chain = chain;
            self.count -= 1;
            self.ended = false;
            return Err(fault);
        }
        self.sync()?;
        self.storage.release_reserve();
        Ok(())
    }

    /// The last words before a run is given up: frees the reserve, then writes what is left and this record and makes it
    /// safe, as well as it goes, also when the storage has failed before; after a failed sync it is only written. The
    /// earlier fault stands for all other calls.
    ///
    /// # Errors
    /// The record is none or stands after END, or the storage failed now. Nothing more can be done.
    pub fn last_words(
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
        let said = self.say_last(kind, body, unsynced && on(Guarding::FailedSync));
        if earlier.is_some() {
            self.fault = earlier;
        }
        said
    }

    fn say_last(
        &mut self,
        kind: EntryKind,
        body: &impl Serialize,
        unsynced: bool,
    ) -> Result<(), JournalFault> {
        if self.half_line {
            // Behind half a line, any words would make the file one that no one can tell from a forged one: rather none.
            let cut = self.storage.cut(self.taken);
            self.noted(Doing::Cut, cut)?;
            self.half_line = false;
        }
        let kept = if kind == EntryKind::End {
            Err(Refusal::OutOfPlace(kind))
        } else {
            self.keep_back(kind, body)
        };
        // Also without the record: what was kept back belongs into the file. After a failed sync none is tried again: it
        // would succeed, and promise what is lost.
        if unsynced {
            self.give()?;
        } else {
            self.sync()?;
        }
        Ok(kept?)
    }

    /// Records written, those kept back included: the number of the last one.
    pub const fn len(&self) -> u64 {
        self.count
    }

    pub const fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The chain after the last record: 64 hexadecimal digits.
    pub fn head(&self) -> &str {
        self.chain.as_str()
    }

    /// The fault of the storage that ended the journal.
    pub const fn fault(&self) -> Option<&JournalFault> {
        self.fault.as_ref()
    }

    /// A storage that failed is not asked again: after a failed sync the kernel forgets what it could not write, and the
    /// next sync would promise what is lost.
    fn healthy(&self) -> Result<(), JournalFault> {
        match &self.fault {
            Some(JournalFault::Storage {
                doing: Doing::Sync, ..
            }) if !on(Guarding::FailedSync) => Ok(()),
            Some(fault) => Err(fault.clone()),
            None => Ok(()),
        }
    }

    /// Makes the line of a record; a refused one leaves no trace.
    fn keep_back(&mut self, kind: EntryKind, body: &impl Serialize) -> Result<(), Refusal> {
        let start = self.kept_back.len();
        let made = self.make_line(start, kind, body);
        match made {
            Ok(chain) => {
                self.chain = chain;
                self.count += 1;
                self.ended = kind == EntryKind::End;
                Ok(())
            }
            Err(refusal) => {
                self.kept_back.truncate(start);
                self.kept_back.shrink_to(2 * WRITE_BYTES);
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
            return Err(Refusal::OutOfPlace(kind));
        }
        let out = &mut self.kept_back;
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

    /// Gives the storage what was kept back.
    fn give(&mut self) -> Result<(), JournalFault> {
        if self.kept_back.is_empty() {
            return Ok(());
        }
        let appended = self.storage.append(&self.kept_back);
        self.half_line = appended.is_err();
        self.noted(Doing::Append, appended)?;
        self.taken += self.kept_back.len() as u64;
        self.kept_back.clear();
        Ok(())
    }

    fn noted(&mut self, doing: Doing, done: std::io::Result<()>) -> Result<(), JournalFault> {
        done.map_err(|error| {
            let fault = JournalFault::storage(doing, &error);
            self.fault = Some(fault.clone());
            fault
        })
    }
}

/// What was kept back reaches the file also when the run is left early; nothing is promised of it.
impl Drop for Journal {
    fn drop(&mut self) {
        if self.fault.is_none() {
            let _ = self.give();
        }
    }
}
