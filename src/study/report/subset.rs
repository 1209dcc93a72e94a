//! The section on the levels of a subset simulation. In: answers. Out: blocks.

use super::numbers::short_percent;
use super::source::Source;
use crate::report::document::{Block, Column, Table, Text};
use crate::report::wording::study as wording;
use crate::study::answers::LevelAnswer;
use crate::study::data_set::{Stopping, StudyKind};
use psd_text::units::display;

/// The section; nothing for another study.
pub fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    let metadata = source.metadata;
    let (Some(subset), StudyKind::Study(Stopping::Rare(rare))) =
        (&source.answers.subset, &metadata.kind)
    else {
        return;
    };
    let requirement = metadata.requirements.get(rare.requirement);
    let Some(limit) = requirement.and_then(|requirement| requirement.limit) else {
        return;
    };
    let dimension = metadata.results[limit.result].dimension;
    let sign = if rare.falls { -1.0 } else { 1.0 };
    let value = |distance: f64| display::readable(limit.value + sign * distance, dimension);
    body.push(Block::section(wording::LEVELS));
    let mut columns = wording::LEVEL_COLUMNS.map(Column::numbers).to_vec();
    columns[1] = Column::words(wording::LEVEL_COLUMNS[1], 1);
    body.push(Block::Table(Table {
        columns,
        rows: subset
            .levels
            .iter()
            .map(|level| row(level, &value))
            .collect(),
    }));
    body.push(Block::note(wording::LEVELS_EXPLAINED));
    if let Some(variation) = subset.variation {
        body.push(Block::note(wording::variation(short_percent(variation))));
    }
    if subset.no_result > 0 {
        body.push(Block::note(wording::levels_without_result(
            subset.no_result,
        )));
    }
}

fn row(level: &LevelAnswer, value: &impl Fn(f64) -> String) -> Vec<Text> {
    let [low, high] = level.thresholds;
    let thresholds = if low == high {
        value(low)
    } else {
        wording::between(value(low), value(high))
    };
    vec![
        level.level.to_string().into(),
        thresholds.into(),
        level.replicates.to_string().into(),
        short_percent(level.fraction).into(),
        short_percent(level.accepted).into(),
    ]
}
