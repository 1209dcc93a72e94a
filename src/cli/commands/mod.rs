//! The commands, one file or folder each. In: parsed arguments and settings. Out: an exit code or a
//! failure. A command does not know another command.

pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod evidence;
pub(crate) mod explain;
pub(crate) mod explain_plan;
pub(crate) mod fmt;
pub(crate) mod limits;
pub(crate) mod prediction;
pub(crate) mod rig;
pub(crate) mod run;
pub(crate) mod study;
pub(crate) mod test;
