//! The figures of a study. In: answers and the kept runs. Out: charts with captions, drawn as those of a run are. Areas, dashes and markers
//! differ, so that a grey print can be read.

mod fragility;

use std::borrow::Cow;

use crate::report::figures::chart::{
    Chart, DASHED, End, Marker, Quantity, Reference, SOLID, Series, Style, palette,
};
use crate::report::wording::study as wording;
use crate::study::answers::{Answers, Histogram, RANKED, ResultAnswer};
use crate::study::data_set::{Column, Limit, Metadata, Stopping, StudyKind};
use psd_physics::study::sensitivity::spearman;
use psd_text::units::Dimension;
use psd_text::units::display;

/// A limit farther from the results than this many times their range is not drawn: it would make the curve narrow.
const FARTHEST: f64 = 1.5;
/// Points of a scatter plot, at most.
const CLOUD: usize = 2000;
/// Inputs of a tornado, at most.
const MOST_INPUTS: usize = 12;
/// Letters of a name beside an axis.
const MOST_LETTERS: usize = 34;
/// Half of the height of a bar, and of the end of an interval.
const BAR: f64 = 0.3;
const END: f64 = 0.14;

/// A figure that is not drawn yet.
pub struct StudyFigure {
    /// `hit.max_displacement_histogram`, the name of its file.
    pub name: String,
    pub chart: Chart,
    pub caption: String,
    /// The result that it shows; None: a fragility.
    pub result: Option<usize>,
    pub kind: FigureKind,
}

/// What a figure shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FigureKind {
    Histogram,
    Cumulative,
    Tornado,
    Scatter,
    Fragility,
}

/// All figures, in the order of the report.
pub fn figures(metadata: &Metadata, answers: &Answers) -> Vec<StudyFigure> {
    let mut figures = Vec::new();
    if let Some(fragility) = &answers.fragility {
        figures.extend(fragility::curve(metadata, fragility));
        figures.extend(fragility::scatter(metadata, answers));
    }
    let results = || answers.results.iter().enumerate();
    let drawn = |(index, result)| histogram(index, metadata, result);
    figures.extend(results().filter_map(drawn));
    let drawn = |(index, result)| cumulative(index, metadata, result);
    figures.extend(results().filter_map(drawn));
    let drawn = |(index, result)| tornado(index, metadata, result);
    figures.extend(results().filter_map(drawn));
    let drawn = |(index, result)| scatter(index, strongest(result)?, metadata, answers);
    figures.extend(results().filter_map(drawn));
    figures.extend(of_levels(metadata, answers));
    figures
}

/// The runs of all levels of a subset simulation, which come nearer to the limit.
fn of_levels(metadata: &Metadata, answers: &Answers) -> Option<StudyFigure> {
    let StudyKind::Study(Stopping::Rare(rare)) = metadata.kind else {
        return None;
    };
    let limit = metadata.requirements.get(rare.requirement)?.limit?;
    let kept = &answers.kept;
    let strength = |input: &usize| {
        let pairs = kept.inputs[*input].iter().zip(&kept.results[limit.result]);
        let pairs = pairs.filter_map(|(x, y)| y.map(|y| (*x, y)));
        let (x, y): (Vec<f64>, Vec<f64>) = pairs.take(RANKED).unzip();
        spearman::correlation(&x, &y).abs()
    };
    let inputs = 0..metadata.inputs.len();
    let input = inputs.max_by(|a, b| strength(a).total_cmp(&strength(b)).then(b.cmp(a)))?;
    scatter(limit.result, input, metadata, answers)
}

/// The input that matters most for a result.
fn strongest(result: &ResultAnswer) -> Option<usize> {
    let strength = |at: &usize| {
        let it = &result.sensitivities[*at];
        it.rank_correlation.map_or(0.0, |index| index.value.abs())
            + it.first_order.map_or(0.0, |index| index.value)
    };
    let inputs = 0..result.sensitivities.len();
    inputs.max_by(|a, b| strength(a).total_cmp(&strength(b)).then(b.cmp(a)))
}

/// Limits of requirements on this result, with their labels.
fn limits(metadata: &Metadata, result: usize) -> Vec<(&str, f64)> {
    let with_limit = metadata.requirements.iter().filter_map(|decision| {
        let Limit { result: of, value } = decision.limit?;
        (of == result).then_some((decision.label.as_str(), value))
    });
    with_limit.collect()
}

fn axis(column: &Column, end: End) -> Quantity {
    Quantity {
        name: Cow::Owned(column.name.clone()),
        dimension: column.dimension,
        end,
        from_zero: false,
        names: Vec::new(),
    }
}

fn plain(name: &'static str, end: End) -> Quantity {
    Quantity {
        end,
        ..Quantity::of(name, Dimension::NUMBER)
    }
}

fn series(label: impl Into<String>, points: Vec<(f64, f64)>, style: Style) -> Series {
    Series {
        label: label.into(),
        points: points.into(),
        style,
    }
}

/// Vertical lines at the limits that are near the results.
fn limit_lines(
    result: &ResultAnswer,
    column: &Column,
    limits: &[(&str, f64)],
    top: f64,
) -> Vec<Series> {
    let (Some(low), Some(high)) = (result.least, result.largest) else {
        return Vec::new();
    };
    let reach = FARTHEST * (high - low);
    let near = limits
        .iter()
        .filter(|(_, limit)| (low - reach..=high + reach).contains(limit));
    let line = |(label, limit): &(&str, f64)| {
        let text = wording::limit_of(label, display::stated(*limit, column.dimension));
        let style = Style::line(palette::VERMILION, 1.8, DASHED);
        series(text, vec![(*limit, 0.0), (*limit, top)], style)
    };
    near.map(line).collect()
}

#[expect(
    clippy::cast_precision_loss,
    reason = "counts of at most a quarter of a million kept runs"
)]
fn histogram(index: usize, metadata: &Metadata, result: &ResultAnswer) -> Option<StudyFigure> {
    let column = &metadata.results[index];
    let Histogram { low, width, counts } = result.histogram.as_ref()?;
    if counts.len() < 2 {
        return None;
    }
    let mut outline = vec![(*low, 0.0)];
    for (bar, count) in counts.iter().enumerate() {
        let [from, to] = [bar, bar + 1].map(|edge| low + edge as f64 * width);
        outline.extend([(from, *count as f64), (to, *count as f64)]);
    }
    let high = low + counts.len() as f64 * width;
    outline.push((high, 0.0));
    let top = counts.iter().max().copied().unwrap_or(0) as f64;
    let mut drawn = vec![
        series("", outline.clone(), Style::area(palette::FILL)),
        series("", outline, Style::line(palette::BLUE, 1.3, SOLID)),
    ];
    drawn.extend(limit_lines(result, column, &limits(metadata, index), top));
    Some(StudyFigure {
        name: format!("{}_histogram", column.name),
        chart: Chart {
            x: axis(column, End::Margin),
            y: plain(wording::RUNS_AXIS, End::Whole),
            bands: Vec::new(),
            series: drawn,
            references: Vec::new(),
        },
        caption: wording::histogram(&column.name, counts.iter().sum::<u64>()),
        result: Some(index),
        kind: FigureKind::Histogram,
    })
}

fn cumulative(index: usize, metadata: &Metadata, result: &ResultAnswer) -> Option<StudyFigure> {
    let column = &metadata.results[index];
    if result.cumulative.len() < 2 {
        return None;
    }
    let mut curve: Vec<(f64, f64)> = Vec::with_capacity(2 * result.cumulative.len());
    let mut below = 0.0;
    for [value, fraction] in &result.cumulative {
        curve.extend([(*value, below), (*value, *fraction)]);
        below = *fraction;
    }
    let mut drawn = vec![series("", curve, Style::line(palette::BLUE, 2.0, SOLID))];
    drawn.extend(quantile_bars(result));
    drawn.extend(limit_lines(result, column, &limits(metadata, index), 1.0));
    drawn.push(whole_range(result.least?));
    Some(StudyFigure {
        name: format!("{}_cumulative", column.name),
        chart: Chart {
            x: axis(column, End::Margin),
            y: plain(wording::FRACTION_AXIS, End::Data),
            bands: Vec::new(),
            series: drawn,
            references: Vec::new(),
        },
        caption: wording::cumulative(&column.name),
        result: Some(index),
        kind: FigureKind::Cumulative,
    })
}

/// The intervals of the quantiles, with the estimate as a ring.
fn quantile_bars(result: &ResultAnswer) -> Vec<Series> {
    let mut drawn = Vec::new();
    for quantile in &result.quantiles {
        let y = quantile.probability;
        let label = |text: &str| {
            if drawn.is_empty() {
                text.to_owned()
            } else {
                String::new()
            }
        };
        if let [Some(low), Some(high)] = quantile.interval {
            let style = Style::line(palette::BLACK, 1.4, SOLID);
            let text = label(wording::QUANTILES);
            drawn.push(series(text, across([low, high], y, 0.012), style));
        }
        if let Some(value) = quantile.estimates[0] {
            let style = Style::marker(palette::BLACK, Marker::Ring(3.6));
            drawn.push(series("", vec![(value, y)], style));
        }
    }
    drawn
}

/// A horizontal interval with its ends.
fn across([low, high]: [f64; 2], y: f64, end: f64) -> Vec<(f64, f64)> {
    let outline = [
        (low, y - end),
        (low, y + end),
        (low, y),
        (high, y),
        (high, y + end),
        (high, y - end),
    ];
    outline.to_vec()
}

/// Nothing visible, from 0 to 1 along y: an axis of fractions shows all of them.
fn whole_range(x: f64) -> Series {
    let style = Style {
        fill: false,
        ..Style::area(palette::FILL)
    };
    series("", vec![(x, 0.0), (x, 1.0)], style)
}

/// Bars of the first-order index, or of the rank correlation where that has no meaning; the largest at the top.
#[expect(
    clippy::cast_precision_loss,
    reason = "a study has far fewer inputs than 2^53"
)]
fn tornado(index: usize, metadata: &Metadata, result: &ResultAnswer) -> Option<StudyFigure> {
    let has_first = result
        .sensitivities
        .iter()
        .any(|it| it.first_order.is_some());
    let mut bars: Vec<(&str, f64, [f64; 2])> = result
        .sensitivities
        .iter()
        .filter_map(|it| {
            let index = if has_first {
                it.first_order
            } else {
                it.rank_correlation
            }?;
            Some((it.input.as_str(), index.value, index.interval))
        })
        .collect();
    if bars.is_empty() {
        return None;
    }
    bars.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    bars.truncate(MOST_INPUTS);
    bars.reverse();
    let mut areas = Vec::new();
    let mut intervals = Vec::new();
    for (row, (_, value, [low, high])) in bars.iter().enumerate() {
        let y = (row + 1) as f64;
        let corners = vec![
            (0.0, y - BAR),
            (*value, y - BAR),
            (*value, y + BAR),
            (0.0, y + BAR),
        ];
        let outline = corners.iter().copied().chain([corners[0]]).collect();
        areas.push(series("", corners, Style::area(palette::FILL)));
        areas.push(series("", outline, Style::line(palette::BLUE, 1.2, SOLID)));
        let label = if row == 0 {
            wording::interval(percent(metadata.confidence))
        } else {
            String::new()
        };
        let style = Style::line(palette::BLACK, 1.4, SOLID);
        intervals.push(series(label, across([*low, *high], y, END), style));
    }
    areas.extend(intervals);
    let column = &metadata.results[index];
    let (title, caption) = if has_first {
        (wording::FIRST_ORDER_AXIS, wording::tornado(&column.name))
    } else {
        (wording::RANK_AXIS, wording::rank_tornado(&column.name))
    };
    Some(StudyFigure {
        name: format!("{}_sensitivities", column.name),
        chart: Chart {
            x: Quantity::along(title, Dimension::NUMBER),
            y: Quantity {
                names: bars.iter().map(|bar| shortened(bar.0)).collect(),
                ..plain("", End::Data)
            },
            bands: Vec::new(),
            series: areas,
            references: Vec::new(),
        },
        caption,
        result: Some(index),
        kind: FigureKind::Tornado,
    })
}

/// A long name without its middle.
fn shortened(name: &str) -> String {
    let letters: Vec<char> = name.chars().collect();
    if letters.len() <= MOST_LETTERS {
        return name.to_owned();
    }
    let half = MOST_LETTERS / 2;
    let [start, end] = [&letters[..half], &letters[letters.len() - half + 1..]];
    start.iter().chain(&['…']).chain(end).collect()
}

pub fn percent(fraction: f64) -> String {
    format!(
        "{} %",
        display::trimmed(&display::significant(100.0 * fraction, 4))
    )
}

/// The result against an input, with the worst runs of its first requirement.
fn scatter(
    index: usize,
    input: usize,
    metadata: &Metadata,
    answers: &Answers,
) -> Option<StudyFigure> {
    let (x, y) = (&metadata.inputs[input], &metadata.results[index]);
    let mut drawn = vec![cloud(answers, input, index)];
    if drawn[0].points.len() < 2 {
        return None;
    }
    let limited = metadata
        .requirements
        .iter()
        .position(|decision| decision.limit.is_some_and(|limit| limit.result == index));
    let worst = limited.map(|requirement| &answers.requirements[requirement].worst);
    let marked: Vec<(f64, f64)> = worst
        .into_iter()
        .flatten()
        .filter_map(|run| Some((run.inputs[input], run.value?)))
        .collect();
    if !marked.is_empty() {
        let style = Style::marker(palette::VERMILION, Marker::Ring(5.0));
        drawn.push(series(wording::WORST_RUNS, marked, style));
    }
    Some(StudyFigure {
        name: format!("{}_against_{}", y.name, x.name),
        chart: Chart {
            x: axis(x, End::Margin),
            y: axis(y, End::Margin),
            bands: Vec::new(),
            series: drawn,
            references: references(metadata, index),
        },
        caption: wording::scatter(&y.name, &x.name),
        result: Some(index),
        kind: FigureKind::Scatter,
    })
}

/// Runs as dots: every so manieth of the kept ones.
fn cloud(answers: &Answers, input: usize, result: usize) -> Series {
    let kept = &answers.kept;
    let pairs = kept.inputs[input].iter().zip(&kept.results[result]);
    let step = kept.runs().div_ceil(CLOUD).max(1);
    let points: Vec<(f64, f64)> = pairs
        .filter_map(|(x, y)| y.map(|y| (*x, y)))
        .step_by(step)
        .collect();
    let label = wording::runs_drawn(points.len());
    series(
        label,
        points,
        Style::marker(palette::BLUE, Marker::Disc(1.6)),
    )
}

/// Horizontal lines at the limits of a result.
fn references(metadata: &Metadata, result: usize) -> Vec<Reference> {
    let column = &metadata.results[result];
    limits(metadata, result)
        .into_iter()
        .map(|(label, limit)| Reference {
            label: wording::limit_of(label, display::stated(limit, column.dimension)),
            y: limit,
        })
        .collect()
}
