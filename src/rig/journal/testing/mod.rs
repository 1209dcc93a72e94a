//! Storages for tests: a disk that loses unsynced data, one that fails on demand, forged and
//! damaged run logs. In: the bytes of a run log. Out: the bytes that remain. The program does not
//! contain it.

mod forger;
mod killed;
mod power_loss;
mod sick_disk;
mod vandal;

pub(crate) use forger::{forged, records, written};
pub(crate) use killed::Killed;
pub(crate) use power_loss::PowerLoss;
pub(crate) use sick_disk::{SickDisk, Sickness};
pub(crate) use vandal::Vandal;

use serde_json::Value;

use super::{Damage, EntryKind, Line, LogText, Recovered, Unreadable};

/// Reads a run log in memory.
pub(crate) fn recover(bytes: &[u8]) -> Result<Recovered, Damage> {
    super::recover(&bytes.to_vec().into()).map_err(|fault| match fault {
        Unreadable::Damaged(damage) => damage,
        Unreadable::File(error) => panic!("memory is always read: {error}"),
    })
}

impl Line {
    /// An entry with `body`, an object, outside a run log.
    pub(crate) fn new(seq: u64, kind: EntryKind, body: &Value) -> Self {
        let json = LogText::from(body.to_string().into_bytes());
        Self::written(seq, kind, body, 0..json.length(), json)
    }

    /// The same entry with a different body.
    pub(crate) fn alter(&mut self, alter: impl FnOnce(&mut Value)) {
        let mut body = self.body();
        alter(&mut body);
        *self = Self::new(self.seq, self.kind, &body);
    }
}
