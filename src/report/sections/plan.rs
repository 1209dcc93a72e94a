//! The plan as it was run, and its files as attachments. In: a run. Out: blocks; files.

use super::Source;
use crate::report::document::{Attachment, Block, Text};
use crate::report::output::paths::plan_files;
use crate::report::run::Run;
use crate::report::wording::plan as wording;
use psd_plan::{PictureKind, PlanFile};
use psd_text::markdown::{Document, is_document};
use psd_text::sanitize;

/// Every file of the plan.
pub(super) fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    let plan = source.run.plan;
    let listed = plan.files.iter().zip(plan_files(plan));
    for (file, kept) in listed.filter(|(file, _)| PictureKind::of(&file.name).is_none()) {
        body.push(Block::part(file.name.as_str()));
        listing(file, &kept.path, body);
    }
}

/// A file of the language in full; of a Markdown document its plan; the first lines of a data file, which may have thousands.
fn listing(file: &PlanFile, kept: &str, body: &mut Vec<Block>) {
    const FIRST: usize = 8;
    if is_document(&file.name) {
        for block in Document::read(&file.text).blocks {
            let before = &file.text[..block.body.start];
            body.push(Block::Code {
                first: before.matches('\n').count() + 1,
                lines: printed(&file.text[block.body]),
            });
        }
        let note = Text::from(wording::OF_THE_DOCUMENT).code(kept);
        body.push(Block::note(note.and(wording::IN_THE_FOLDER)));
        return;
    }
    let lines = printed(&file.text);
    let left = lines.len().saturating_sub(FIRST);
    let is_plan = file
        .name
        .rsplit('.')
        .next()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("psd"));
    if is_plan || left <= FIRST {
        body.push(Block::Code { first: 1, lines });
        return;
    }
    body.push(Block::Code {
        first: 1,
        lines: lines.into_iter().take(FIRST).collect(),
    });
    body.push(Block::note(
        Text::from(wording::more_lines(left))
            .code(kept)
            .and(wording::IN_THE_FOLDER),
    ));
}

/// The lines of a text as they are printed; a tab is four spaces.
fn printed(text: &str) -> Vec<String> {
    text.lines()
        .map(|line| sanitize::printed(&line.replace('\t', "    ")))
        .collect()
}

/// The plan and every file it used, under their names in the run folder.
pub(super) fn attachments(run: &Run<'_>) -> Vec<Attachment> {
    let named = plan_files(run.plan).into_iter().zip(&run.plan.files);
    named
        .filter(|(_, file)| PictureKind::of(&file.name).is_none())
        .map(|(named, file)| Attachment {
            name: named.path,
            text: file.text.to_string(),
        })
        .collect()
}
