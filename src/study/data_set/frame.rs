//! Rows of a data set as a frame of Polars. In: a block, or a frame that was read. Out: the other one. The names of the columns are here.

use polars::prelude::{Column as FrameColumn, DataFrame, NamedFrom as _, PlSmallStr};
use polars::series::Series;

use super::block::{Block, Outcome};
use super::metadata::{Column, Metadata};

const RUN: &str = "run";
const REASON: &str = "reason";

/// Names of all columns, in their order.
pub fn names(metadata: &Metadata) -> Vec<String> {
    let with_unit = |column: &Column| format!("{} [{}]", column.name, column.unit);
    let requirements = metadata.requirements.iter().enumerate();
    let requirements =
        requirements.map(|(at, decision)| format!("requirement {}: {}", at + 1, decision.label));
    std::iter::once(RUN.to_owned())
        .chain(metadata.inputs.iter().map(with_unit))
        .chain(metadata.results.iter().map(with_unit))
        .chain(requirements)
        .chain(std::iter::once(REASON.to_owned()))
        .collect()
}

/// The block as a frame.
pub fn frame(block: &Block, metadata: &Metadata) -> Result<DataFrame, String> {
    let runs: Vec<u64> = (block.first..block.end()).collect();
    let words = |outcomes: &Vec<Outcome>| {
        let words: Vec<&str> = outcomes.iter().map(|outcome| outcome.word()).collect();
        Series::new(PlSmallStr::EMPTY, words)
    };
    let inputs = block.inputs.iter().map(|values| numbers(values));
    let results = block
        .results
        .iter()
        .map(|values| Series::new(PlSmallStr::EMPTY, values));
    let columns = std::iter::once(Series::new(PlSmallStr::EMPTY, runs))
        .chain(inputs)
        .chain(results)
        .chain(block.outcomes.iter().map(words))
        .chain(std::iter::once(Series::new(
            PlSmallStr::EMPTY,
            &block.reasons,
        )));
    let named = columns.zip(names(metadata)).map(|(mut column, name)| {
        column.rename(name.into());
        FrameColumn::from(column)
    });
    DataFrame::new(block.len(), named.collect()).map_err(|error| error.to_string())
}

fn numbers(values: &[f64]) -> Series {
    Series::new(PlSmallStr::EMPTY, values)
}

/// The frame of one row group as a block; `first` is the number of its first run.
pub fn block(frame: &DataFrame, first: u64, metadata: &Metadata) -> Result<Block, String> {
    let found = frame.get_column_names();
    let expected = names(metadata);
    if found.iter().map(|name| name.as_str()).ne(expected.iter()) {
        return Err(format!(
            "its columns are {found:?}, its metadata name {expected:?}"
        ));
    }
    let mut columns = frame
        .columns()
        .iter()
        .map(FrameColumn::as_materialized_series);
    let mut next = || {
        columns
            .next()
            .ok_or_else(|| "a column is missing".to_owned())
    };
    runs(next()?, first)?;
    let mut block = Block {
        first,
        ..Block::default()
    };
    for column in &metadata.inputs {
        let values = results(next()?)?.into_iter().collect::<Option<Vec<f64>>>();
        let values = values.ok_or_else(|| format!("input `{}` is missing", column.name))?;
        block.inputs.push(values);
    }
    for _ in &metadata.results {
        block.results.push(results(next()?)?);
    }
    for _ in &metadata.requirements {
        block.outcomes.push(outcomes(next()?)?);
    }
    block.reasons = strings(next()?, |reason| reason.map(str::to_owned))?;
    Ok(block)
}

/// The numbers of the runs must be consecutive.
fn runs(column: &Series, first: u64) -> Result<(), String> {
    let runs = column.u64().map_err(|error| error.to_string())?;
    let wrong = runs.iter().zip(first..).find(|(run, at)| *run != Some(*at));
    wrong.map_or(Ok(()), |(run, expected)| {
        let run = run.map_or_else(|| "no number".to_owned(), |run| format!("run {run}"));
        Err(format!("{run} follows where run {expected} is expected"))
    })
}

fn results(column: &Series) -> Result<Vec<Option<f64>>, String> {
    let values = column.f64().map_err(|error| error.to_string())?;
    if values.iter().flatten().any(|value| !value.is_finite()) {
        return Err(format!("`{}` has an invalid number", column.name()));
    }
    Ok(values.iter().collect())
}

fn outcomes(column: &Series) -> Result<Vec<Outcome>, String> {
    let read = strings(column, |word| word.and_then(Outcome::of_word))?;
    let outcomes: Option<Vec<Outcome>> = read.into_iter().collect();
    outcomes.ok_or_else(|| format!("`{}` has an unknown outcome", column.name()))
}

fn strings<T>(column: &Series, read: impl Fn(Option<&str>) -> T) -> Result<Vec<T>, String> {
    let texts = column.str().map_err(|error| error.to_string())?;
    Ok(texts.iter().map(read).collect())
}
