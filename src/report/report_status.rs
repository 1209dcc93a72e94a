//! What a run's report may be taken for. In: a run. Out: its [`Standing`], and every ground against a certificate, the
//! gravest first. Days are judged against the run's own from its record: no clock is read.

use std::collections::BTreeSet;

use super::days::last_day;
use super::{Run, particulars};
use crate::physics::self_test;
use crate::record::Outcome;
use crate::run::rehearsal;

/// Whether a report may be signed as one of a test.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Standing {
    /// A real rig, a run to its end, nothing missing.
    Certifiable,
    /// Nothing real moved, or only the beginning of the plan ran, to predict the rest.
    Rehearsal,
    /// The run did not come to its end, or its record has none.
    Incomplete,
    /// A test of a specimen that lacks what nobody can add after it.
    NotCertifiable { missing: Vec<String> },
    /// A test of a specimen whose report does not state what ISO/IEC 17025, 7.8.2.1, wants: its issue may add it.
    ParticularsMissing { missing: Vec<String> },
}

impl Standing {
    /// As in `summary.json`.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Certifiable => "certifiable",
            Self::Rehearsal => "rehearsal",
            Self::Incomplete => "incomplete",
            Self::NotCertifiable { .. } => "not certifiable",
            Self::ParticularsMissing { .. } => "particulars missing",
        }
    }
}

/// The standing of a run: its gravest ground.
#[must_use]
pub fn of(run: &Run<'_>) -> Standing {
    grounds(run)
        .into_iter()
        .next()
        .unwrap_or(Standing::Certifiable)
}

/// Every ground against a certificate, the gravest first; none where it is certifiable.
#[must_use]
pub fn grounds(run: &Run<'_>) -> Vec<Standing> {
    let missing = missing(run);
    let mut grounds = Vec::new();
    if is_rehearsal(run) {
        grounds.push(Standing::Rehearsal);
    }
    if run.record.outcome != Outcome::Completed {
        grounds.push(Standing::Incomplete);
    }
    if !missing.is_empty() {
        grounds.push(Standing::NotCertifiable { missing });
    }
    let missing = particulars_missing(run);
    if !missing.is_empty() {
        grounds.push(Standing::ParticularsMissing { missing });
    }
    grounds
}

/// What the report of a test does not state and should. A rehearsal is none, and is issued by nobody.
#[must_use]
pub fn particulars_missing(run: &Run<'_>) -> Vec<String> {
    if run.plan.rig.link.as_real().is_none() || is_rehearsal(run) {
        Vec::new()
    } else {
        particulars::missing(run)
    }
}

fn is_rehearsal(run: &Run<'_>) -> bool {
    run.record.rig.simulated || rehearsal::told(run.plan).is_some()
}

/// What the certificate of a real rig must state and cannot. A virtual rig has neither operator nor calibration.
#[must_use]
pub fn missing(run: &Run<'_>) -> Vec<String> {
    if run.plan.rig.link.as_real().is_none() {
        return Vec::new();
    }
    let mut missing = Vec::new();
    let told = |text: Option<&str>| text.is_some_and(|text| !text.trim().is_empty());
    if !told(run.provenance.operator()) {
        missing.push("the operator's name".to_owned());
    }
    let channels = &run.equipment().channels;
    if !channels
        .iter()
        .all(|channel| told(channel.certificate.as_deref()))
    {
        missing.push("the calibration's reference".to_owned());
    }
    for channel in channels
        .iter()
        .filter(|channel| channel.calibrated.is_none())
    {
        missing.push(format!(
            "the range over which the {} is calibrated",
            channel.measures.name()
        ));
    }
    // Where force and displacement hold until the same day, one calibration is spoken of.
    let days: BTreeSet<Option<&str>> = channels
        .iter()
        .map(|channel| channel.due.as_deref())
        .collect();
    for channel in channels {
        let what = if days.len() > 1 {
            format!("calibration of the {}", channel.measures.name())
        } else {
            "calibration".to_owned()
        };
        match (channel.due.as_deref(), last_day(run.provenance)) {
            (None, _) => missing.push(format!("the day until which the {what} holds")),
            (Some(_), None) => missing.push("the day of the test".to_owned()),
            (Some(due), Some(day)) if due < day => {
                missing.push(format!(
                    "a valid {what} (it held until {due}, the test ended on {day})"
                ));
            }
            (Some(_), Some(_)) => {}
        }
    }
    if !self_test::passed() {
        missing.push("a program that passes its own test".to_owned());
    }
    // What two axes lack is said once.
    let mut said = BTreeSet::new();
    missing.retain(|lack| said.insert(lack.clone()));
    missing
}
