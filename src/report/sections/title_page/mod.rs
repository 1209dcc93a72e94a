//! The top of the first page: title, particulars, verdict, notices and watermarks. In: a run. Out: parts of the document.

mod amendment;
mod particulars;
mod verdict;
mod watermarks;

pub(super) use amendment::{amendments, replaced_report};
pub(super) use particulars::{missing as missing_particulars, rows as particulars};
pub(super) use verdict::verdict;
pub(super) use watermarks::{notices, watermarks};

use crate::report::document::Photo;
use crate::report::run::Run;
use crate::report::status::particulars::stated;
use crate::report::wording::{photos, title_page as wording};
use psd_plan::schema::plan_block::LABORATORY;
use psd_text::sanitize;

/// The title of the report, else that of the plan.
pub(super) fn title<'a>(run: &Run<'a>) -> &'a str {
    run.plan.report.title.as_deref().unwrap_or(&run.plan.title)
}

/// The logo of the laboratory.
pub(super) fn logo(run: &Run<'_>) -> Option<Photo> {
    let picture = run.plan.report.logo.clone()?;
    Some(Photo {
        name: format!("logo.{}", picture.kind.ending()),
        caption: stated(run, LABORATORY.name)
            .map_or_else(|| photos::LOGO.to_owned(), photos::logo_of)
            .into(),
        picture,
    })
}

/// The kind of report, above the title.
pub(super) fn kind(run: &Run<'_>) -> &'static str {
    if run.record.rig.simulated {
        wording::KIND_SIMULATION
    } else {
        wording::KIND
    }
}

/// The day of the test in words, or that it is missing; a simulation without a day has none.
pub(super) fn dated(run: &Run<'_>) -> Option<String> {
    match (date(run), run.record.rig.simulated) {
        (Some(date), false) => Some(wording::tested(date)),
        (Some(date), true) => Some(wording::simulated(date)),
        (None, false) => Some(wording::NO_DATE.to_owned()),
        (None, true) => None,
    }
}

/// The day of the test.
pub(super) fn date(run: &Run<'_>) -> Option<String> {
    run.provenance.date.as_deref().map(sanitize::printed)
}
