//! Deviations from the plan, and observations on the numbers. In: a run. Out: blocks.

use super::{Source, capitalised};
use crate::record::EventKind;
use crate::report::document::{Block, Text};
use crate::report::run::Run;
use crate::report::status::deviations;
use crate::report::wording::deviations as wording;

/// The section, if it precedes the requirements.
pub(super) fn before_requirements(source: &Source<'_>, body: &mut Vec<Block>) {
    if come_first(source.run) {
        section(source.run, body);
    }
}

/// The section, if it follows the requirements.
pub(super) fn after_requirements(source: &Source<'_>, body: &mut Vec<Block>) {
    if !come_first(source.run) {
        section(source.run, body);
    }
}

/// Whether deviations precede the requirements: on a real rig, and if long requirements would move them off the first page.
fn come_first(run: &Run<'_>) -> bool {
    const ON_ONE_PAGE: usize = 8;
    let conditions: usize = run
        .assessment
        .requirements
        .iter()
        .map(|requirement| requirement.conditions.len())
        .sum();
    run.plan.rig.link.as_real().is_some() || conditions > ON_ONE_PAGE
}

fn section(run: &Run<'_>, body: &mut Vec<Block>) {
    body.push(Block::section(wording::TITLE));
    let found = deviations::of_run(run);
    if found.is_empty() {
        body.push(Block::paragraph(wording::NO_DEVIATION));
    }
    let observations = run.record.events.iter().filter(|event| match event.kind {
        EventKind::Remark | EventKind::Inspection => true,
        EventKind::Note => !deviations::is_of_the_line(&event.text),
        _ => false,
    });
    let observations = observations.map(|event| {
        let position = deviations::position(event.procedure.as_deref(), event.step);
        format!(
            "{}{position}: {}",
            capitalised(event.kind.word()),
            event.text
        )
    });
    let items: Vec<Text> = found
        .into_iter()
        .chain(observations)
        .map(Text::from)
        .collect();
    if !items.is_empty() {
        body.push(Block::List { items });
    }
}
