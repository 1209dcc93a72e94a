//! The files of a run folder as data: the recorded run, its provenance, its results, and the failures of reading them. In: paths and
//! bytes. Out: plans, run logs and files. It asks no operator and prints nothing.

pub(crate) mod circumstances;
pub(crate) mod failure;
pub(crate) mod provenance;
pub(crate) mod recorded_run;
pub(crate) mod results;
pub(crate) mod wall_clock;
