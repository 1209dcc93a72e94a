//! The legend above the frame: one entry per named series and band. In: a chart. Out: shapes on a canvas.

use plotters::style::text_anchor::{HPos, VPos};

use super::super::canvas::{Canvas, Point};
use super::super::chart::{Chart, Colour, Series, palette};
use super::{LEFT, RIGHT, draw_marker, lettering};

/// Length of the sample of a line, reference pixels.
const SAMPLE: f64 = 30.0;
/// Space before the next entry.
const GAP: f64 = 18.0;
/// Space between a sample and its text.
const NEAR: f64 = 7.0;

/// A series or a band with its name.
pub(super) enum Entry<'a> {
    Series(&'a Series),
    Band(&'static str, Colour),
}

impl Entry<'_> {
    fn sample(&self) -> f64 {
        match self {
            Self::Series(series) if series.style.fill => 18.0,
            Self::Series(series) if series.style.line.is_some() => SAMPLE,
            Self::Series(_) => 10.0,
            Self::Band(..) => 18.0,
        }
    }

    fn label(&self) -> &str {
        match self {
            Self::Series(series) => &series.label,
            Self::Band(label, _) => label,
        }
    }
}

/// The entries in the order of the chart.
pub(super) fn entries(chart: &Chart) -> Vec<Entry<'_>> {
    let series = chart
        .series
        .iter()
        .filter(|series| !series.label.is_empty() && is_drawn(series))
        .map(Entry::Series);
    let bands = chart
        .bands
        .iter()
        .filter(|band| !band.intervals.is_empty())
        .map(|band| Entry::Band(band.label, band.colour));
    series.chain(bands).collect()
}

/// Whether a series has more than a line without a length, such as that of a computed storey while the rig unloads the others.
fn is_drawn(series: &Series) -> bool {
    let mut points = series.points.iter();
    let first = points.next();
    series.style.fill || series.style.marker.is_some() || points.any(|point| Some(point) != first)
}

/// The entries in lines that fit the frame, each with its left end.
pub(super) fn rows<'a, 'b>(entries: &'b [Entry<'a>]) -> Vec<Vec<(&'b Entry<'a>, f64)>> {
    let mut rows: Vec<Vec<(&Entry<'_>, f64)>> = vec![Vec::new()];
    let mut left = LEFT;
    for entry in entries {
        let width =
            entry.sample() + NEAR + lettering(13.0, HPos::Left, VPos::Center).width(entry.label());
        if left + width > RIGHT && left > LEFT {
            rows.push(Vec::new());
            left = LEFT;
        }
        if let Some(row) = rows.last_mut() {
            row.push((entry, left));
        }
        left += width + GAP;
    }
    rows
}

/// Draws one entry from its left end, about the middle of its line.
pub(super) fn draw(canvas: &Canvas, entry: &Entry<'_>, (left, middle): Point) {
    let sample = entry.sample();
    match entry {
        Entry::Series(series) if series.style.fill => {
            draw_area(canvas, (left, middle), sample, series.style.colour);
        }
        Entry::Series(series) => {
            if let Some(line) = series.style.line {
                canvas.polyline(
                    &[(left, middle), (left + sample, middle)],
                    line,
                    series.style.colour,
                );
            }
            if let Some(marker) = series.style.marker {
                draw_marker(
                    canvas,
                    marker,
                    (left + 0.5 * sample, middle),
                    series.style.colour,
                );
            }
        }
        Entry::Band(_, colour) => draw_area(canvas, (left, middle), sample, *colour),
    }
    canvas.text(
        entry.label(),
        (left + sample + NEAR, middle),
        &lettering(13.0, HPos::Left, VPos::Center),
    );
}

/// A sample of an area with a thin outline.
fn draw_area(canvas: &Canvas, (left, middle): Point, width: f64, colour: Colour) {
    canvas.rectangle(
        (left, middle - 6.0),
        (left + width, middle + 6.0),
        palette::CLOUD,
    );
    canvas.rectangle(
        (left + 0.8, middle - 5.2),
        (left + width - 0.8, middle + 5.2),
        colour,
    );
}
