//! Files of plans, runs and accepted results on disk, the provenance of a run, and the failures of reading them. In: paths and bytes.
//! Out: loaded texts, run logs and written folders. It does not know what the bytes mean to the physics.

pub(crate) mod accepted;
pub(crate) mod circumstances;
pub(crate) mod difference;
pub(crate) mod disk_space;
pub(crate) mod failure;
pub(crate) mod finish_run;
pub(crate) mod golden_run;
pub(crate) mod loader;
pub(crate) mod plan_file;
pub(crate) mod plans;
pub(crate) mod provenance;
pub(crate) mod record_file;
pub(crate) mod recorded_run;
pub(crate) mod results;
pub(crate) mod run_folder;
pub(crate) mod wall_clock;
pub(crate) mod writing;
