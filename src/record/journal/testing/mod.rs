//! Storages for tests: a disk that forgets what was not synced, one that fails when it is told to; a forger and a vandal. In: the
//! bytes of a journal. Out: the bytes that are there afterwards. Not part of the program.

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
