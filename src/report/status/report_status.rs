//! The status of a run's report: issued as a test report, or the reasons against it. In: a run. Out: its [`ReportStatus`], and every
//! reason, the most serious first. Due dates are compared with the days of the run log: no clock is read.

use std::collections::BTreeSet;

use super::days::last_day;
use super::particulars;
use crate::report::run::Run;
use crate::report::wording::status as wording;
use psd_physics::self_test;
use psd_plan::Plan;
use psd_plan::record::Outcome;
use psd_plan::record::equipment::{Channel, Equipment};

/// Whether a report is the report of a test. A test that was stopped is one, and its report says so.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ReportStatus {
    /// The test of a specimen. No field is missing, the issuer and the day of issue included.
    Issued,
    /// Only the pre-test check and the leading ramps were run, to predict the rest.
    CheckRun,
    /// No real rig moved.
    Simulation,
    /// A test of a specimen. Fields are missing that cannot be added after the test.
    NotIssuable { missing: Vec<String> },
    /// A test of a specimen, not issued yet. Particulars of ISO/IEC 17025, 7.8.2.1, are missing; an issue of the report adds them.
    Draft { missing: Vec<String> },
}

impl ReportStatus {
    /// The status of a run: the most serious reason against a test report.
    #[must_use]
    pub fn of(run: &Run<'_>) -> Self {
        Self::reasons(run)
            .into_iter()
            .next()
            .unwrap_or(Self::Issued)
    }

    /// Every reason against a test report, the most serious first; none if the report is issued.
    #[must_use]
    pub fn reasons(run: &Run<'_>) -> Vec<Self> {
        let mut reasons = Vec::new();
        if is_check_run(run) {
            reasons.push(Self::CheckRun);
        }
        if run.record.rig.simulated {
            reasons.push(Self::Simulation);
        }
        let missing = missing_fields(run);
        if !missing.is_empty() {
            reasons.push(Self::NotIssuable { missing });
        }
        let missing = missing_particulars(run);
        if !missing.is_empty() {
            reasons.push(Self::Draft { missing });
        }
        reasons
    }

    /// The name in `summary.json`.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Issued => "issued",
            Self::CheckRun => "check run",
            Self::Simulation => "simulation",
            Self::NotIssuable { .. } => "not issuable",
            Self::Draft { .. } => "draft",
        }
    }
}

/// Whether the run was stopped before its end, or its run log has no end.
#[must_use]
pub fn is_incomplete(run: &Run<'_>) -> bool {
    run.record.outcome != Outcome::Completed
}

/// The missing particulars that the report of a test must state. A check run is not a test: none is missing there.
#[must_use]
pub fn missing_particulars(run: &Run<'_>) -> Vec<String> {
    if is_no_test(run) {
        Vec::new()
    } else {
        particulars::missing(run)
    }
}

/// The fields of these particulars in the `plan` block.
#[must_use]
pub fn missing_particular_fields(run: &Run<'_>) -> Vec<&'static str> {
    if is_no_test(run) {
        Vec::new()
    } else {
        particulars::missing_fields(run)
    }
}

fn is_no_test(run: &Run<'_>) -> bool {
    run.plan.rig.link.as_real().is_none() || run.record.rig.simulated || is_check_run(run)
}

fn is_check_run(run: &Run<'_>) -> bool {
    run.plan.performed_part().is_some()
}

/// The missing fields of operator, calibration and program that the report on a real rig must state. A simulated rig has neither operator
/// nor calibration.
#[must_use]
pub fn missing_fields(run: &Run<'_>) -> Vec<String> {
    if run.plan.rig.link.as_real().is_none() {
        return Vec::new();
    }
    let mut missing = Vec::new();
    if matches!(run.record.outcome, Outcome::NotReleased { .. }) {
        missing.push(wording::RELEASED_MOTION.to_owned());
    }
    let is_given = |text: Option<&str>| text.is_some_and(|text| !text.trim().is_empty());
    if !is_given(run.provenance.operator()) {
        missing.push(wording::OPERATOR.to_owned());
    }
    let channels = &run.equipment().channels;
    if !channels
        .iter()
        .all(|channel| is_given(channel.certificate.as_deref()))
    {
        missing.push(wording::CERTIFICATE.to_owned());
    }
    for channel in channels
        .iter()
        .filter(|channel| channel.calibrated.is_none())
    {
        missing.push(wording::calibrated_range(channel.measures.name()));
    }
    for (calibration, due) in calibrations(channels) {
        match (due, last_day(run.provenance)) {
            (None, _) => missing.push(wording::due_date(calibration)),
            (Some(_), None) => missing.push(wording::DAY_OF_THE_TEST.to_owned()),
            (Some(due), Some(day)) if due < day => {
                missing.push(wording::overdue(calibration, due, day));
            }
            (Some(_), Some(_)) => {}
        }
    }
    if !self_test::passed() {
        missing.push(wording::PASSING_PROGRAM.to_owned());
    }
    // A field that is missing for two axes is listed once.
    let mut listed = BTreeSet::new();
    missing.retain(|field| listed.insert(field.clone()));
    missing
}

/// The calibration of each channel, and its due date. Force and displacement with the same due date are one calibration.
fn calibrations(channels: &[Channel]) -> Vec<(String, Option<&str>)> {
    let days: BTreeSet<Option<&str>> = channels
        .iter()
        .map(|channel| channel.due.as_deref())
        .collect();
    let named = |channel: &Channel| {
        if days.len() <= 1 {
            wording::CALIBRATION.to_owned()
        } else {
            wording::calibration_of(channel.measures.name())
        }
    };
    channels
        .iter()
        .map(|channel| (named(channel), channel.due.as_deref()))
        .collect()
}

/// The calibrations of a real rig that are overdue on a day, each once: the report of a test on that day cannot be issued.
#[must_use]
pub fn overdue(plan: &Plan, day: &str) -> Vec<String> {
    if plan.rig.link.as_real().is_none() {
        return Vec::new();
    }
    let channels = Equipment::channels_of(plan);
    let mut listed = BTreeSet::new();
    calibrations(&channels)
        .into_iter()
        .filter_map(|(calibration, due)| {
            let due = due.filter(|due| *due < day)?;
            Some(wording::overdue_before(calibration, due))
        })
        .filter(|text| listed.insert(text.clone()))
        .collect()
}
