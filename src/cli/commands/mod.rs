//! The commands, one file or folder each. In: parsed arguments and settings. Out: an exit code or a
//! failure. A command does not know another command.

pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod explain;
pub(crate) mod explain_plan;
pub(crate) mod fmt;
pub(crate) mod issue;
pub(crate) mod limits;
pub(crate) mod on_rig;
pub(crate) mod prediction;
pub(crate) mod rehearse;
pub(crate) mod replayed;
pub(crate) mod report;
pub(crate) mod resume;
pub(crate) mod rig;
pub(crate) mod run;
pub(crate) mod sign;
pub(crate) mod test;
pub(crate) mod verify;
