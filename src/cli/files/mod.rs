//! Files of plans, runs and accepted results on disk. In: paths and bytes. Out: loaded texts and
//! written folders. It does not know what the bytes mean to the physics.

pub(crate) use crate::files::provenance;

pub(crate) mod accepted;
pub(crate) mod difference;
pub(crate) mod disk_space;
pub(crate) mod finish_run;
pub(crate) mod golden_run;
pub(crate) mod loader;
pub(crate) mod plan_file;
pub(crate) mod record_file;
pub(crate) mod run_folder;
pub(crate) mod writing;
