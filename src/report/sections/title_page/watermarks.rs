//! Notices against an incorrect use of the report: boxes below the verdict, and watermarks on every page. In: a run. Out: their text, one
//! for each reason why the report is not issuable as a test report.

use crate::report::document::Notice;
use crate::report::run::Run;
use crate::report::status::{ReportStatus, report_status};
use crate::report::wording::status as wording;

/// The boxes, one for each reason that the heading does not state.
pub(in super::super) fn notices(run: &Run<'_>) -> Vec<Notice> {
    let notice = |reason| match reason {
        ReportStatus::Issued | ReportStatus::Simulation | ReportStatus::CheckRun => None,
        ReportStatus::NotIssuable { missing } => Some((
            vec![wording::NOT_ISSUABLE],
            wording::lacks(missing.join("; ")),
        )),
        ReportStatus::Draft { missing } => Some((
            vec![wording::DRAFT],
            wording::lacks_particulars(missing.join("; ")),
        )),
    };
    reasons(run)
        .into_iter()
        .filter_map(notice)
        .map(|(words, text)| Notice {
            words,
            text: text.into(),
        })
        .collect()
}

/// The watermarks, on every page: any page may be passed on alone. A test that was stopped is marked, too.
pub(in super::super) fn watermarks(run: &Run<'_>) -> Vec<&'static str> {
    let words = reasons(run).into_iter().filter_map(|reason| match reason {
        ReportStatus::Simulation => Some(wording::SIMULATION),
        ReportStatus::CheckRun => Some(wording::CHECK_RUN),
        ReportStatus::NotIssuable { .. } => Some(wording::NOT_ISSUABLE),
        ReportStatus::Draft { .. } => Some(wording::DRAFT),
        ReportStatus::Issued => None,
    });
    let stopped = report_status::is_incomplete(run).then_some(wording::INCOMPLETE);
    words.chain(stopped).collect()
}

/// A simulation has neither operator nor calibration: none is missing.
fn reasons(run: &Run<'_>) -> Vec<ReportStatus> {
    let mut reasons = ReportStatus::reasons(run);
    if run.record.rig.simulated {
        reasons
            .retain(|reason| matches!(reason, ReportStatus::Simulation | ReportStatus::CheckRun));
    }
    reasons
}
