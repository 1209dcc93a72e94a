//! The data set of a study: one Parquet file with one row per run. In: metadata and rows. Out: the file, and its rows again, a row group at a
//! time. It knows neither the plan nor the engine that made the rows.
//!
//! | column | type | contents |
//! |---|---|---|
//! | `run` | u64 | number of the run, from 0 |
//! | `NAME [UNIT]` | f64 | an input, SI |
//! | `NAME [UNIT]` | f64, may be missing | a result, SI |
//! | `requirement N: LABEL` | string | `met`, `not_met` or `no_result` |
//! | `reason` | string, may be missing | why a result does not exist |
//!
//! The metadata are JSON in the footer, with the SHA-256 of every row group; that of the footer lies before it. Row groups end where the
//! run number is a multiple of [`GROUP_RUNS`], and no encoding depends on chance: equal rows and metadata give equal bytes, whoever
//! computed them. Neither writer nor reader holds more than one row group, beside some 200 bytes a column and row group for the footer.

mod block;
mod fault;
mod footer;
mod frame;
mod group;
mod metadata;
mod reader;
#[cfg(test)]
pub(crate) mod testing;
#[cfg(test)]
mod tests;
mod writer;

pub use block::{Block, Outcome, StudyRow};
pub use fault::DataSetFault;
pub use metadata::{
    Column, Decision, Event, Limit, Metadata, Setting, Stopping, Stripes, StudiedRequirement,
    StudyKind,
};
pub use reader::Reader;
pub use writer::Writer;

/// Runs of a row group.
pub const GROUP_RUNS: u64 = 1 << 17;
