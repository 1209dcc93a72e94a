//! The top of the first page: title, particulars, verdict, notices and watermarks. In: a run. Out: parts of the document.

mod particulars;
mod verdict;
mod watermarks;

pub(super) use particulars::{missing as missing_particulars, rows as particulars};
pub(super) use verdict::verdict;
pub(super) use watermarks::{notices, watermarks};

use crate::report::run::Run;
use crate::text::sanitize;

/// The title of the report, else that of the plan.
pub(super) fn title<'a>(run: &Run<'a>) -> &'a str {
    run.plan.report.title.as_deref().unwrap_or(&run.plan.title)
}

/// The day of the test.
pub(super) fn date(run: &Run<'_>) -> Option<String> {
    run.provenance.date.as_deref().map(sanitize::printed)
}
