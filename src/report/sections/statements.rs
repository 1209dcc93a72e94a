//! Opinions of the issuer, statements on the use of the report, and the lines for signatures. In: a run. Out: blocks.

use super::Source;
use crate::report::document::{Block, Text};
use crate::report::status::particulars::stated;
use crate::report::wording::{opinions as opinions_wording, statements as wording};
use psd_plan::schema::plan_block::{OPINIONS, SAMPLING};

/// Opinions and interpretations of the issuer, marked as such (ISO/IEC 17025, 7.8.7). Returns nothing if none is stated.
pub(super) fn opinions(source: &Source<'_>, body: &mut Vec<Block>) {
    if let Some(text) = stated(source.run, OPINIONS.name) {
        body.push(Block::section(opinions_wording::TITLE));
        body.push(Block::note(opinions_wording::NOT_RESULTS));
        body.push(Block::paragraph(text));
    }
}

/// The statements; those on the items tested only if items were tested.
pub(super) fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    let run = source.run;
    body.push(Block::section(wording::TITLE));
    if run.record.rig.simulated {
        body.push(Block::paragraph(wording::SIMULATION));
        return;
    }
    let mut sentences = vec![wording::ITEMS];
    if stated(run, SAMPLING.name).is_none() {
        sentences.push(wording::AS_RECEIVED);
    }
    sentences.extend([
        wording::STATED_VALUES,
        wording::PSEUDO_DYNAMIC,
        wording::REPRODUCTION,
        wording::FORM,
    ]);
    body.push(Block::paragraph(sentences.join(" ")));
}

/// A line for each signatory that the plan names. A simulation is not signed as a test.
pub(super) fn signatures(source: &Source<'_>, body: &mut Vec<Block>) {
    let signatories = &source.run.plan.report.sign;
    if !signatories.is_empty() && !source.run.record.rig.simulated {
        let line = |name: &String| Text::from(wording::signature(name));
        body.push(Block::Signatures {
            names: signatories.iter().map(line).collect(),
        });
    }
}
