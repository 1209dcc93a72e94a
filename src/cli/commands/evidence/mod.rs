//! The commands on the folder of a run that is over, one file each: verify, sign, report, issue. In: parsed arguments and settings. Out: an
//! exit code or a failure. No rig moves.

pub(crate) mod issue;
pub(crate) mod replayed;
pub(crate) mod report;
pub(crate) mod sign;
pub(crate) mod verify;
