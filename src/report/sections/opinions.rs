//! Opinions and interpretations of the issuer, marked as such (ISO/IEC 17025, 7.8.7). In: a run. Out: blocks.

use super::Source;
use crate::report::document::Block;
use crate::report::status::particulars::stated;
use crate::report::wording::opinions as wording;
use crate::schema::plan_block::OPINIONS;

/// Returns nothing if none is stated.
pub(super) fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    if let Some(text) = stated(source.run, OPINIONS.name) {
        body.push(Block::section(wording::TITLE));
        body.push(Block::note(wording::NOT_RESULTS));
        body.push(Block::paragraph(text));
    }
}
