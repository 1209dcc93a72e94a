//! Storages for tests: a disk that forgets what was not synced, and one that fails when it is told to. In: the bytes of
//! a journal. Out: the bytes that are there afterwards. Not part of the program.

mod killed;
mod power_loss;
mod sick_disk;

pub(crate) use killed::Killed;
pub(crate) use power_loss::PowerLoss;
pub(crate) use sick_disk::{SickDisk, Sickness};
