//! Statements on the use of the report, and the lines for signatures. In: a run. Out: blocks.

use super::Source;
use crate::report::document::{Block, Text};
use crate::report::wording::statements as wording;

/// The statements. They precede the long listings, so that they do not occupy a separate page.
pub(super) fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    body.push(Block::section(wording::TITLE));
    let items = if source.run.record.rig.simulated {
        wording::VIRTUAL_SPECIMEN
    } else {
        ""
    };
    body.push(Block::paragraph(wording::use_of_the_report(items)));
}

/// A line for each signatory that the plan names.
pub(super) fn signatures(source: &Source<'_>, body: &mut Vec<Block>) {
    let signatories = &source.run.plan.report.sign;
    if !signatories.is_empty() {
        let line = |name: &String| Text::from(wording::signature(name));
        body.push(Block::Signatures {
            names: signatories.iter().map(line).collect(),
        });
    }
}
