//! The particulars of the first page after ISO/IEC 17025, 7.8.2: laboratory, customer, item, method, plan. In: a run. Out: names
//! and values, and the names of the missing ones.

use crate::report::document::Text;
use crate::report::run::Run;
use crate::report::status::particulars::{FRONT, Wanted, missing_names, stated};
use crate::report::status::report_status;
use crate::report::wording::{particulars as wording, specimen as specimen_text};
use psd_plan::schema::plan_block::{DATE, REVISION};

/// Names and values that are stated; the plan with its digest last. A simulation is no test: its date is beside the title only.
pub(in super::super) fn rows(run: &Run<'_>) -> Vec<(Text, Text)> {
    let is_printed = |field| field != DATE.name || !run.record.rig.simulated;
    let front = FRONT
        .iter()
        .filter(|particular| is_printed(particular.field));
    let rows = front.filter_map(|particular| {
        Some((
            particular.name.into(),
            stated(run, particular.field)?.into(),
        ))
    });
    let specimens = run.plan.specimens.iter();
    let frames = || specimens.clone().filter_map(|it| it.frame.as_ref());
    let substructures = frames().filter_map(specimen_text::substructures);
    let numbers = frames().filter_map(|frame| specimen_text::numbers(run.plan, frame));
    rows.chain(substructures.map(|text| (wording::SUBSTRUCTURES.into(), text.into())))
        .chain(numbers.map(|text| (wording::NUMBERS.into(), text.into())))
        .chain([(wording::PLAN.into(), plan(run))])
        .collect()
}

/// Names of particulars that are not stated. Those that a notice below the verdict lists are omitted. A simulation lacks none.
pub(in super::super) fn missing(run: &Run<'_>) -> Vec<&'static str> {
    if run.record.rig.simulated {
        return Vec::new();
    }
    let in_notice = !report_status::missing_particulars(run).is_empty();
    let wanted: &[Wanted] = if in_notice {
        &[Wanted::WhereItMatters]
    } else {
        &[Wanted::Always, Wanted::WhereItMatters]
    };
    missing_names(run, wanted)
}

/// The plan as it was run: file, revision, and the first digits of its digest.
fn plan(run: &Run<'_>) -> Text {
    let file = run.plan.files.first().map_or("", |file| file.name.as_str());
    let revision = stated(run, REVISION.name).map_or_else(String::new, wording::revision);
    let digest = run
        .provenance
        .plan_sha256
        .get(..16)
        .unwrap_or(&run.provenance.plan_sha256);
    Text::from(format!("{file}{revision}, SHA-256 ")).id(format!("{digest}…"))
}
