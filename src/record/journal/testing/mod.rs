//! Storages for tests: a disk that forgets what was not synced, and one that fails when it is told to; and a forger. In: the
//! bytes of a journal. Out: the bytes that are there afterwards. Not part of the program.

mod forger;
mod killed;
mod power_loss;
mod sick_disk;

pub(crate) use forger::forged;
pub(crate) use killed::Killed;
pub(crate) use power_loss::PowerLoss;
pub(crate) use sick_disk::{SickDisk, Sickness};
