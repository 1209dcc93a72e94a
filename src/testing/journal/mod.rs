//! Storages for tests: a disk that loses unsynced data, one that fails on demand, forged and
//! damaged run logs. In: the bytes of a run log. Out: the bytes that remain. The program does not
//! contain it.

mod forger;
mod killed;
mod power_loss;
mod sick_disk;
mod vandal;

pub use forger::{forged, records, written};
pub use killed::Killed;
pub use power_loss::PowerLoss;
pub use sick_disk::{SickDisk, Sickness};
pub use vandal::Vandal;

use serde_json::Value;

use psd_rig::journal::{Damage, Line, Recovered, Unreadable};

/// Reads a run log in memory.
///
/// # Errors
/// The reason, for a person.
pub fn recover(bytes: &[u8]) -> Result<Recovered, Damage> {
    psd_rig::journal::recover(&bytes.to_vec().into()).map_err(|fault| match fault {
        Unreadable::Damaged(damage) => damage,
        Unreadable::File(error) => panic!("memory is always read: {error}"),
    })
}

/// Another body of an entry.
pub trait AlterEntry {
    /// The same entry with a different body.
    fn alter(&mut self, alter: impl FnOnce(&mut Value));
}

impl AlterEntry for Line {
    fn alter(&mut self, alter: impl FnOnce(&mut Value)) {
        let mut body = self.body();
        alter(&mut body);
        *self = Self::new(self.seq, self.kind, &body);
    }
}
