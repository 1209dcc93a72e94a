//! Marks that say what a report must not be taken for: boxed words under the verdict, and words across every page. In: a
//! run. Out: the words, each ground for itself.

use super::super::Run;
use super::super::document::Mark;
use crate::report::report_status;
use crate::report::report_status::Standing;

/// The boxed words, each ground on a line of its own.
pub(super) fn boxed(run: &Run<'_>) -> Vec<Mark> {
    let of = |ground| {
        match ground {
        Standing::Certifiable => None,
        Standing::Rehearsal if run.record.rig.simulated => {
            Some((vec!["REHEARSAL", "NOT CERTIFIABLE"], "Simulated rig: rehearsal, not a test of a specimen.".to_owned()))
        }
        Standing::Rehearsal => Some((
            vec!["REHEARSAL", "NOT CERTIFIABLE"],
            "Only the gate and the leading stiffness ramps ran on the rig: not the test of the plan.".to_owned(),
        )),
        Standing::Incomplete => Some((vec!["INCOMPLETE"], "The run did not come to its end.".to_owned())),
        Standing::NotCertifiable { missing } => {
            Some((vec!["NOT CERTIFIABLE"], format!("This report lacks {}.", missing.join("; "))))
        }
        Standing::ParticularsMissing { missing } => Some((
            vec!["PARTICULARS MISSING"],
            format!("ISO/IEC 17025, 7.8.2.1, wants of a report and this one lacks: {}.", missing.join("; ")),
        )),
    }
    };
    report_status::grounds(run)
        .into_iter()
        .filter_map(of)
        .map(|(words, text)| Mark {
            words,
            text: text.into(),
        })
        .collect()
}

/// The words across every page: of a paper that is passed on, any page may be the only one.
pub(super) fn across(run: &Run<'_>) -> Vec<&'static str> {
    let real_line = run.plan.rig.link.as_real().is_some();
    let words = report_status::grounds(run)
        .into_iter()
        .filter_map(|ground| match ground {
            Standing::Rehearsal if real_line && run.record.rig.simulated => {
                Some("REHEARSAL ON A SIMULATED RIG")
            }
            Standing::Rehearsal => Some("REHEARSAL"),
            Standing::Incomplete => Some("INCOMPLETE"),
            Standing::NotCertifiable { .. } => Some("NOT CERTIFIABLE"),
            Standing::ParticularsMissing { .. } => Some("PARTICULARS MISSING"),
            Standing::Certifiable => None,
        });
    words.collect()
}
