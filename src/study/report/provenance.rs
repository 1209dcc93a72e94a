//! The last sections: looks of the stopping rule, inputs, and where the numbers come from. In: metadata and answers. Out: blocks.

use super::figures::percent;
use super::numbers::percents;
use super::source::Source;
use crate::report::document::{Block, Column, Table, Text};
use crate::report::wording::study as wording;
use crate::study::data_set::StudyKind;
use psd_plan::study::Sampling;
use psd_text::units::display;

/// Every look with its intervals.
pub fn looks(source: &Source<'_>, body: &mut Vec<Block>) {
    let answers = source.answers;
    if answers.looks.is_empty() {
        return;
    }
    body.push(Block::section(wording::LOOKS));
    let mut columns: Vec<Column> = wording::LOOK_COLUMNS.map(Column::numbers).into();
    let mut labels: Vec<&str> = answers.studied.iter().map(|it| it.label.as_str()).collect();
    if labels.is_empty() {
        labels.extend(answers.requirements.iter().map(|it| it.label.as_str()));
    }
    columns.extend(labels.into_iter().map(Column::numbers));
    let rows = answers.looks.iter().map(|look| {
        let fixed = [
            look.number.to_string(),
            look.runs.to_string(),
            percent(look.confidence),
        ];
        let intervals = look.intervals.iter().map(|interval| percents(*interval));
        fixed.into_iter().chain(intervals).map(Text::from).collect()
    });
    body.push(Block::Table(Table {
        columns,
        rows: rows.collect(),
    }));
    body.push(Block::note(wording::SPENT));
}

/// What varies, and how.
pub fn inputs(source: &Source<'_>, body: &mut Vec<Block>) {
    let metadata = source.metadata;
    body.push(Block::section(wording::INPUTS));
    let [name, text, nominal] = wording::INPUT_COLUMNS;
    let stepped = match &metadata.kind {
        StudyKind::Fragility(stripes) => Some(stripes.intensity),
        StudyKind::Study(_) => None,
    };
    let rows = metadata.inputs.iter().enumerate().map(|(index, column)| {
        let distribution = if stepped == Some(index) {
            Text::from(wording::STEPPED)
        } else {
            Text::new().code(&column.text)
        };
        let nominal = column.nominal;
        let nominal = nominal.map(|value| display::stated(value, column.dimension));
        let nominal = nominal.unwrap_or_else(|| "–".to_owned());
        vec![column.name.as_str().into(), distribution, nominal.into()]
    });
    body.push(Block::Table(Table {
        columns: vec![
            Column::words(name, 2),
            Column::words(text, 3),
            Column::numbers(nominal),
        ],
        rows: rows.collect(),
    }));
    if !metadata.correlations.is_empty() {
        let texts = metadata.correlations.join("; ");
        body.push(Block::note(Text::from(wording::CORRELATIONS).code(texts)));
    } else if metadata.is_correlated {
        body.push(Block::note(wording::TABLE_ROWS));
    }
}

/// Program, plan, seed and data set.
pub fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    let metadata = source.metadata;
    let settings = metadata.settings.iter();
    let settings: Vec<String> = settings
        .map(|setting| format!("{} = {}", setting.name, setting.text))
        .collect();
    let settings = if settings.is_empty() {
        wording::NO_SETTINGS.to_owned()
    } else {
        settings.join("; ")
    };
    body.push(Block::section(wording::PROVENANCE));
    body.push(Block::Pairs {
        rows: vec![
            (wording::PLAN.into(), metadata.plan.as_str().into()),
            (wording::VERSION.into(), metadata.version.as_str().into()),
            (wording::DIGEST.into(), Text::new().id(&metadata.digest)),
            (wording::SETTINGS.into(), settings.into()),
            (wording::SEED.into(), metadata.seed.to_string().into()),
            (wording::SAMPLING.into(), metadata.sampling.name().into()),
            (
                wording::DATA_SET.into(),
                wording::data_set(source.answers.runs).into(),
            ),
            (wording::REPORT.into(), Text::new().id(source.id)),
        ],
    });
    let follows = metadata.sampling == Sampling::Subset;
    body.push(Block::note(if follows {
        wording::SAME_LEVELS
    } else {
        wording::SAME
    }));
}
