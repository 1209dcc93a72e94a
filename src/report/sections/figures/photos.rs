//! Photographs of the specimen. In: a run. Out: blocks.

use super::Source;
use crate::report::document::{Block, Photo};
use crate::report::wording::photos as wording;
use psd_plan::Picture;

/// Returns nothing if the plan names no photograph.
pub(in super::super) fn photographs(source: &Source<'_>, body: &mut Vec<Block>) {
    let photos = &source.run.plan.report.photos;
    if photos.is_empty() {
        return;
    }
    body.push(Block::part(wording::TITLE));
    let photo = |(index, picture): (usize, &Picture)| Photo {
        name: format!("photo-{}.{}", index + 1, picture.kind.ending()),
        caption: wording::caption(index + 1, &picture.file).into(),
        picture: picture.clone(),
    };
    body.push(Block::Photos {
        photos: photos.iter().enumerate().map(photo).collect(),
    });
}
