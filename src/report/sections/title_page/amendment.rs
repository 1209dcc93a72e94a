//! The section of an amended report: every amendment with its reason and its changes. In: a run. Out: blocks.

use super::super::Source;
use crate::report::document::{Block, Text};
use crate::report::run::Run;
use crate::report::status::{IssueKind, issue};
use crate::report::wording::amendment as wording;

/// Returns nothing if the report was not amended.
pub(in super::super) fn amendments(source: &Source<'_>, body: &mut Vec<Block>) {
    let amendments = issue::amendments(source.run.provenance.issues.as_ref());
    if amendments.is_empty() {
        return;
    }
    body.push(Block::section(wording::TITLE));
    body.push(Block::List {
        items: amendments.into_iter().map(Text::from).collect(),
    });
    body.push(Block::note(wording::SAME_RECORD));
}

/// The id of the report that this one amends.
pub(in super::super) fn replaced_report(run: &Run<'_>) -> Option<String> {
    let last = run.provenance.issues.as_ref()?.all.last()?;
    (last.kind == IssueKind::Amendment).then(|| last.replaces.clone())
}
