//! A file of the run folder, and the errors of making one. It knows no run.

use psd_plan::{Format, Plan};

/// Name of the summary.
pub const SUMMARY: &str = "summary.json";
/// The report as a page.
pub const PAGE: &str = "report.html";
/// The PDF report.
pub const PAPER: &str = "report.pdf";

/// A file of the run folder: path with `/`, relative to the folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputFile {
    pub path: String,
    pub bytes: Vec<u8>,
}

/// The reason why an output could not be made. The record of the run is complete in this case too.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    #[error("the table `{table}` could not be written: {reason}")]
    Table { table: String, reason: String },
    #[error("`{path}` could not be kept: {reason}")]
    Kept { path: String, reason: String },
    #[error("the figure `{figure}` of `{procedure}` could not be drawn: {reason}")]
    Figure {
        figure: &'static str,
        procedure: String,
        reason: String,
    },
    #[error("the report could not be set on paper: {0}")]
    Pdf(String),
}

/// Whether the plan's report requests a format; a report that names none requests all.
pub(in crate::report) fn wants(plan: &Plan, format: Format) -> bool {
    plan.report.formats.is_empty() || plan.report.formats.contains(&format)
}
