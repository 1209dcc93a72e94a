//! The sections on results: their distributions, and the inputs that matter for each. In: answers. Out: blocks.

use super::figures::{FigureKind, percent};
use super::numbers::{decimals, index, with_interval};
use super::source::{DrawnFigure, Source};
use crate::report::document::{Block, Column, Table, Text};
use crate::report::wording::study as wording;
use crate::study::answers::{IndexAnswer, KEPT, RANKED, ResultAnswer, Sensitivity};
use crate::study::data_set::Column as DataColumn;
use psd_plan::schema::readable_result;
use psd_plan::study::Sampling;

/// Mean, scatter and quantiles, with their figures.
pub fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    let answers = source.answers;
    if answers.results.is_empty() {
        return;
    }
    body.push(Block::section(wording::RESULTS));
    let mut titles = wording::RESULT_COLUMNS.into_iter();
    let mut columns = vec![Column::words(titles.next().unwrap_or_default(), 1)];
    columns.extend(titles.map(Column::numbers));
    let results = answers.results.iter().zip(&source.metadata.results);
    body.push(Block::Table(Table {
        columns,
        rows: results
            .map(|(answer, column)| row(answer, column))
            .collect(),
    }));
    let confidence = percent(answers.confidence);
    body.push(Block::note(match source.metadata.sampling {
        // A subset simulation has no results here.
        Sampling::Random | Sampling::Subset => wording::by_ranks(confidence),
        Sampling::Sobol => wording::by_replicates(confidence),
        Sampling::LatinHypercube => wording::NO_INTERVAL.to_owned(),
    }));
    if answers.runs > KEPT as u64 {
        body.push(Block::note(wording::kept(KEPT)));
    }
    // The first histogram is on the first page.
    let histograms = source.figures_of(|figure| figure.kind == FigureKind::Histogram);
    body.extend(histograms.skip(1));
    body.extend(source.figures_of(|figure| figure.kind == FigureKind::Cumulative));
}

fn row(answer: &ResultAnswer, column: &DataColumn) -> Vec<Text> {
    let dimension = column.dimension;
    let mut name = Text::from(answer.name.as_str());
    if answer.no_result > 0 {
        name = name.line().soft(wording::lost(answer.no_result));
    }
    let mean = answer
        .mean_interval
        .map_or([None; 2], |ends| ends.map(Some));
    let sd = answer.standard_deviation;
    let sd = sd.map_or_else(
        || "–".to_owned(),
        |sd| readable_result(&column.name, sd, dimension),
    );
    let mean = with_interval(&column.name, answer.mean, mean, dimension);
    let mut cells = vec![name, mean, sd.into()];
    cells.extend(answer.quantiles.iter().map(|quantile| {
        with_interval(
            &column.name,
            quantile.estimates[0],
            quantile.interval,
            dimension,
        )
    }));
    cells
}

/// The influence of every input on every result.
pub fn sensitivities(source: &Source<'_>, body: &mut Vec<Block>) {
    let answers = source.answers;
    let known = |it: &Sensitivity| it.first_order.is_some() || it.rank_correlation.is_some();
    if !answers
        .results
        .iter()
        .any(|result| result.sensitivities.iter().any(known))
    {
        return;
    }
    body.push(Block::section(wording::SENSITIVITIES));
    let correlated = source.metadata.is_correlated;
    body.push(Block::note(if correlated {
        wording::CORRELATED
    } else {
        wording::EXPLAINED
    }));
    if answers.runs > RANKED as u64 {
        body.push(Block::note(wording::ranked(RANKED)));
    }
    let mut marked = false;
    for (at, result) in answers.results.iter().enumerate() {
        let [input, first, first_range, rank, rank_range] = wording::SENSITIVITY_COLUMNS;
        let mut cell = |found: Option<IndexAnswer>| {
            let Some(found) = found else {
                return ["–".into(), "–".into()];
            };
            marked |= found.may_be_zero;
            let mark = if found.may_be_zero { " *" } else { "" };
            let value = Text::from(decimals(found.value)).and(mark);
            [value, index(found.interval).into()]
        };
        let rows = result.sensitivities.iter().map(|it| {
            let [first, first_range] = cell(it.first_order);
            let [rank, rank_range] = cell(it.rank_correlation);
            let mut cells = vec![it.input.as_str().into()];
            if !correlated {
                cells.extend([first, first_range]);
            }
            cells.extend([rank, rank_range]);
            cells
        });
        let rows: Vec<Vec<Text>> = rows.collect();
        let mut columns = vec![Column::words(input, 1)];
        if !correlated {
            columns.extend([Column::numbers(first), Column::numbers(first_range)]);
        }
        columns.extend([Column::numbers(rank), Column::numbers(rank_range)]);
        body.push(Block::part(wording::of_result(&result.name)));
        body.push(Block::Table(Table { columns, rows }));
        let own =
            |figure: &DrawnFigure| figure.kind == FigureKind::Tornado && figure.result == Some(at);
        body.extend(source.figures_of(own));
    }
    if marked {
        body.push(Block::note(wording::MAY_BE_ZERO));
    }
}
