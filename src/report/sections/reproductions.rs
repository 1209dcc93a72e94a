//! Numbers of the run beside published ones. In: a run. Out: a table; nothing without such a number.

use super::{Source, capitalised, with_spaces};
use crate::report::document::{Block, Column, Style, Table, Text};
use crate::report::number;
use crate::report::run::Run;
use crate::report::wording::{common, headline, reproductions as wording};
use crate::verdict::ReproductionOutcome;

/// Every comparison with value, expanded uncertainty, published number and difference.
pub(super) fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    let outcomes = &source.run.assessment.reproductions;
    if outcomes.is_empty() {
        return;
    }
    body.push(Block::section(wording::TITLE));
    let [name, value, published, difference, statement] = wording::COLUMNS;
    body.push(Block::Table(Table {
        columns: vec![
            Column::words(name, 1),
            Column::numbers(value),
            Column::numbers(published),
            Column::numbers(difference),
            Column::short(statement),
        ],
        rows: outcomes.iter().map(row).collect(),
    }));
    body.push(Block::note(wording::NOTE));
    body.push(Block::note(headline::EXPANDED));
}

fn row(outcome: &ReproductionOutcome) -> Vec<Text> {
    let mut name = Text::from(capitalised(&with_spaces(&outcome.name)))
        .line()
        .soft(outcome.source.as_str());
    if let Some(reason) = &outcome.compared.reason {
        name = name.line().soft(reason.replace('`', ""));
    }
    let tolerance = number::tolerance(&outcome.compared);
    let style = if outcome.reproduces() {
        Style::Strong
    } else {
        Style::Fail
    };
    vec![
        name,
        number::value(&outcome.compared)
            .map_or_else(|| Text::missing(common::NO_VALUE), Text::from),
        number::target(&outcome.compared).into(),
        Text::from(number::difference(outcome))
            .line()
            .soft(wording::tolerance(tolerance)),
        Text::new().with(style, outcome.statement()),
    ]
}

/// The names of the numbers that the run does not reproduce.
pub(super) fn not_reproduced(run: &Run<'_>) -> Vec<String> {
    let outcomes = run.assessment.reproductions.iter();
    outcomes
        .filter(|outcome| !outcome.reproduces())
        .map(|outcome| with_spaces(&outcome.name))
        .collect()
}
