//! The pre-test check on a report: what the plan requires, and what the run log states. In: the check of an axis; a run. Out:
//! strings.

use super::super::conditions::range;
use crate::report::number;
use crate::report::run::Run;
use crate::report::wording::equipment as wording;
use psd_plan::PretestCheck;
use psd_plan::record::EventKind;
use psd_text::units::Dimension;

/// The limits of the check.
pub(super) fn required(pretest_check: &PretestCheck) -> String {
    wording::pretest_check(
        number::stated(pretest_check.zero, Dimension::FORCE),
        range(pretest_check.stiffness, Dimension::STIFFNESS),
        number::stated(pretest_check.probe, Dimension::LENGTH),
    )
}

/// The measured values of a check that passed, or the reason of one that did not.
pub(super) fn outcome<'a>(run: &Run<'a>) -> Option<&'a str> {
    logged(run).find_map(|text| {
        text.strip_prefix("pre-test check passed: ")
            .or_else(|| refused(text))
    })
}

/// The measured values of one axis of several that passed.
pub(super) fn passed_by_axis<'a>(run: &Run<'a>, axis: usize) -> Option<&'a str> {
    let prefix = format!("pre-test check passed by axis {axis}: ");
    logged(run).find_map(|text| text.strip_prefix(prefix.as_str()))
}

/// The reason of a check that did not pass.
pub(super) fn refusal<'a>(run: &Run<'a>) -> Option<&'a str> {
    logged(run).find_map(refused)
}

/// Notes and faults that were logged outside every procedure.
fn logged<'a>(run: &Run<'a>) -> impl Iterator<Item = &'a str> {
    let events = run
        .record
        .events
        .iter()
        .filter(|event| matches!(event.kind, EventKind::Note | EventKind::Fault));
    events
        .filter(|event| event.procedure.is_none())
        .map(|event| event.text.as_str())
}

fn refused(text: &str) -> Option<&str> {
    text.strip_prefix("the rig did not pass the pre-test check: ")
}
