//! The figures of a report, numbered from 1. In: drawn figures with their captions. Out: blocks.

use super::Source;
use crate::report::document::{Block, Figure};
use crate::report::wording::figures as wording;

/// Returns nothing if no figure was drawn.
pub(super) fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    if source.figures.is_empty() {
        return;
    }
    body.push(Block::section(wording::TITLE));
    let drawn = source.figures.iter().enumerate();
    body.extend(drawn.map(|(index, figure)| {
        Block::Figure(Figure {
            number: index + 1,
            caption: figure.caption.as_str().into(),
            svg: figure.svg.clone(),
        })
    }));
}
