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

use super::{Damage, Recovered, Unreadable};

/// Reads a run log in memory.
pub(crate) fn recover(bytes: &[u8]) -> Result<Recovered, Damage> {
    super::recover(&bytes.to_vec().into()).map_err(|fault| match fault {
        Unreadable::Damaged(damage) => damage,
        Unreadable::File(error) => panic!("memory is always read: {error}"),
    })
}
