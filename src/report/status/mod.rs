//! Statements about a report as a whole: its status, its particulars and days, deviations of the run, issues after the test.
//! In: a run. Out: data and sentences. They know no document.

pub mod days;
pub(super) mod deviations;
pub(super) mod issue;
pub(super) mod particulars;
pub mod report_status;

pub use issue::{Change, Issue, IssueKind, Issues};
pub use report_status::ReportStatus;
