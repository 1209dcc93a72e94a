//! Notices against an incorrect use of the report: boxes below the verdict, and watermarks on every page. In: a run. Out: their text, one
//! for each reason why the report is not issuable as a test report.

use crate::report::document::Notice;
use crate::report::run::Run;
use crate::report::status::ReportStatus;
use crate::report::wording::status as wording;

/// The boxes, one for each reason.
pub(in super::super) fn notices(run: &Run<'_>) -> Vec<Notice> {
    let simulated = run.record.rig.simulated;
    let notice = |reason| match reason {
        ReportStatus::Certifiable => None,
        ReportStatus::Rehearsal => Some((
            vec![wording::REHEARSAL, wording::NOT_CERTIFIABLE],
            if simulated {
                wording::ON_A_SIMULATED_RIG.to_owned()
            } else {
                wording::ONLY_THE_GATE.to_owned()
            },
        )),
        ReportStatus::Incomplete => Some((
            vec![wording::INCOMPLETE],
            wording::NOT_TO_ITS_END.to_owned(),
        )),
        ReportStatus::NotCertifiable { missing } => Some((
            vec![wording::NOT_CERTIFIABLE],
            wording::lacks(missing.join("; ")),
        )),
        ReportStatus::ParticularsMissing { missing } => Some((
            vec![wording::PARTICULARS_MISSING],
            wording::lacks_particulars(missing.join("; ")),
        )),
    };
    ReportStatus::reasons(run)
        .into_iter()
        .filter_map(notice)
        .map(|(words, text)| Notice {
            words,
            text: text.into(),
        })
        .collect()
}

/// The watermarks, on every page: any page may be passed on alone.
pub(in super::super) fn watermarks(run: &Run<'_>) -> Vec<&'static str> {
    let real_line = run.plan.rig.link.as_real().is_some();
    let words = ReportStatus::reasons(run)
        .into_iter()
        .filter_map(|reason| match reason {
            ReportStatus::Rehearsal if real_line && run.record.rig.simulated => {
                Some(wording::REHEARSAL_ON_A_SIMULATED_RIG)
            }
            ReportStatus::Rehearsal => Some(wording::REHEARSAL),
            ReportStatus::Incomplete => Some(wording::INCOMPLETE),
            ReportStatus::NotCertifiable { .. } => Some(wording::NOT_CERTIFIABLE),
            ReportStatus::ParticularsMissing { .. } => Some(wording::PARTICULARS_MISSING),
            ReportStatus::Certifiable => None,
        });
    words.collect()
}
