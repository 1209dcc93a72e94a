//! The section on the fragility curve: stripes, fit, band. In: answers. Out: blocks.

use super::figures::FigureKind;
use super::numbers::{decimals, index, percents, short_percent};
use super::source::Source;
use crate::report::document::{Block, Column, Table, Text};
use crate::report::wording::study as wording;
use crate::study::answers::{Answers, FitAnswer, StripeAnswer};
use crate::study::data_set::{Metadata, StudyKind};
use psd_text::units::{Dimension, display};

/// Below this the fitted curve is doubtful.
const LEAST_GOODNESS: f64 = 0.05;

/// The section; nothing for a study.
pub fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    let Some(fragility) = &source.answers.fragility else {
        return;
    };
    let Some(dimension) = dimension(source.metadata) else {
        return;
    };
    body.push(Block::section(wording::FRAGILITY));
    let fitted = |fit: &&FitAnswer| fit.no_fit.is_none();
    let any = fragility.fits.iter().any(|fit| fitted(&fit));
    if any {
        let mut titles = wording::FIT_COLUMNS.into_iter();
        let mut columns = vec![Column::words(titles.next().unwrap_or_default(), 1)];
        columns.extend(titles.map(Column::numbers));
        let rows = fragility.fits.iter().filter(fitted);
        body.push(Block::Table(Table {
            columns,
            rows: rows.map(|fit| fit_row(fit, dimension)).collect(),
        }));
        body.push(Block::note(wording::FITTED));
        body.push(Block::note(wording::GOODNESS));
    }
    for fit in &fragility.fits {
        if let Some(reason) = &fit.no_fit {
            body.push(Block::paragraph(wording::no_fit(reason)));
        } else if !fit.has_middle {
            body.push(Block::note(wording::NO_MIDDLE));
        }
    }
    let fitted = fragility.fits.iter().find(fitted);
    if let Some(split) = fitted.and_then(|fit| fit.split) {
        body.push(Block::Table(Table {
            columns: wording::SPLIT_COLUMNS.map(Column::numbers).into(),
            rows: vec![vec![
                split.records.to_string().into(),
                decimals(split.record_to_record).into(),
                decimals(split.modelling).into(),
                short_percent(split.share).into(),
                percents(split.share_interval).into(),
            ]],
        }));
        body.push(Block::note(wording::SPLIT));
    }
    let records = matches!(&source.metadata.kind, StudyKind::Fragility(it) if it.record.is_some());
    match (records, source.metadata.inputs.len()) {
        _ if !any => {}
        (true, 2) => body.push(Block::note(wording::RECORDS_ALONE)),
        (true, _) => body.push(Block::note(wording::OF_THESE_RECORDS)),
        (false, 1) => {}
        (false, _) => body.push(Block::note(wording::MODELLING_ALONE)),
    }
    let mut titles = wording::STRIPE_COLUMNS.into_iter();
    let mut columns = vec![Column::words(titles.next().unwrap_or_default(), 1)];
    columns.extend(titles.map(Column::numbers));
    let rows = fragility.stripes.iter();
    body.push(Block::Table(Table {
        columns,
        rows: rows.map(|stripe| stripe_row(stripe, dimension)).collect(),
    }));
    if fragility.stripes.iter().any(|stripe| stripe.no_result > 0) {
        body.push(Block::note(wording::NO_RESULT_BOUNDS));
    }
    body.extend(source.figures_of(|figure| figure.kind == FigureKind::Scatter));
}

/// The curve in one sentence, for the first page; None of a study. If runs have no result, that of the two whose median is smaller.
pub fn statement(metadata: &Metadata, answers: &Answers) -> Option<String> {
    let fits = &answers.fragility.as_ref()?.fits;
    let dimension = dimension(metadata)?;
    let fitted = fits.iter().rev().find(|fit| fit.no_fit.is_none());
    let Some(FitAnswer {
        median: Some(median),
        dispersion: Some(dispersion),
        ..
    }) = fitted
    else {
        let reason = fits.iter().rev().find_map(|fit| fit.no_fit.as_ref());
        return reason.map(wording::no_fit);
    };
    let median = display::readable(*median, dimension);
    Some(wording::curve(median, decimals(*dispersion)))
}

fn dimension(metadata: &Metadata) -> Option<Dimension> {
    let StudyKind::Fragility(stripes) = &metadata.kind else {
        return None;
    };
    Some(metadata.inputs.get(stripes.intensity)?.dimension)
}

fn fit_row(fit: &FitAnswer, dimension: Dimension) -> Vec<Text> {
    let none = || Text::from("–");
    let median = fit
        .median
        .map_or_else(none, |it| display::readable(it, dimension).into());
    let interval = |[low, high]: [f64; 2]| {
        let [low, high] = [low, high].map(|end| display::readable(end, dimension));
        wording::between(low, high).into()
    };
    let goodness = fit.goodness.map_or_else(none, |it| {
        let mark = if it < LEAST_GOODNESS { " !" } else { "" };
        Text::from(short_percent(it)).and(mark)
    });
    vec![
        wording::curve_label(fit.no_result_as).into(),
        median,
        fit.median_interval.map_or_else(none, interval),
        fit.dispersion.map_or_else(none, |it| decimals(it).into()),
        fit.dispersion_interval
            .map_or_else(none, |it| index(it).into()),
        goodness,
    ]
}

fn stripe_row(stripe: &StripeAnswer, dimension: Dimension) -> Vec<Text> {
    let runs = stripe.exceeded + stripe.not_exceeded + stripe.no_result;
    let [low, high] = stripe.bounds;
    let fraction = if low == high {
        short_percent(low)
    } else {
        percents(stripe.bounds)
    };
    vec![
        display::stated(stripe.intensity, dimension).into(),
        runs.to_string().into(),
        stripe.exceeded.to_string().into(),
        stripe.no_result.to_string().into(),
        fraction.into(),
        percents(stripe.interval).into(),
    ]
}
