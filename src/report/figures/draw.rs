//! Lays a [`Chart`] out on a sheet: legend above, axes left and below, nothing inside the frame but data. In: a chart
//! in SI. Out: PNG bytes, or the same in vectors.

use plotters::style::text_anchor::{HPos, VPos};

use super::axis::Axis;
use super::canvas::{Anchor, Canvas, Lettering, Point};
use super::chart::{Chart, Colour, Line, Marker, Series, palette};
use super::{raster, vector};

const WIDTH: u32 = 720;
const HEIGHT: u32 = 430;
/// The frame, reference pixels; its top moves down where the legend takes two lines.
const LEFT: f64 = 78.0;
const RIGHT: f64 = 700.0;
const BOTTOM: f64 = 372.0;
const LEGEND_TOP: f64 = 20.0;
const LEGEND_LINE: f64 = 21.0;
const INK: Colour = (40, 40, 40);
const GRID: Colour = (232, 232, 232);
const LIMIT_INK: Colour = (150, 20, 20);
/// Marks closer than this are thinned, reference pixels: half a pixel of the picture is not seen.
const THINNEST: f64 = 0.5;

/// The chart as a PNG.
pub(super) fn png(chart: &Chart) -> Result<Vec<u8>, String> {
    raster::png(WIDTH, HEIGHT, |canvas| paint(chart, canvas))
}

/// The chart as an SVG.
pub(super) fn svg(chart: &Chart) -> Result<String, String> {
    vector::svg(WIDTH, HEIGHT, |canvas| paint(chart, canvas))
}

fn paint(chart: &Chart, canvas: &dyn Canvas) -> Result<(), String> {
    let xs = chart
        .series
        .iter()
        .flat_map(|series| series.points.iter().map(|point| point.0));
    let ys = chart
        .series
        .iter()
        .flat_map(|series| series.points.iter().map(|point| point.1));
    let references = near(chart);
    let x = Axis::over(&chart.x, xs, 8);
    let y = Axis::over(&chart.y, ys.chain(references), 6);
    let entries = legend_entries(chart);
    let rows = legend_rows(&entries)?;
    #[expect(clippy::cast_precision_loss, reason = "a legend has a few lines")]
    let top = LEGEND_TOP + LEGEND_LINE * rows.len().max(1) as f64 - 2.0;
    let sheet = Sheet {
        canvas,
        x: &x,
        y: &y,
        top,
    };
    sheet.bands(chart)?;
    sheet.grid()?;
    for series in &chart.series {
        sheet.series(series)?;
    }
    sheet.references(chart)?;
    sheet.axes()?;
    for (index, row) in rows.iter().enumerate() {
        #[expect(clippy::cast_precision_loss, reason = "a legend has a few lines")]
        let at = LEGEND_TOP + LEGEND_LINE * index as f64 - 4.0;
        for (entry, left) in row {
            legend_entry(canvas, entry, (*left, at))?;
        }
    }
    Ok(())
}

/// Reference lines that the axis is stretched to. One far from the data would press the curves flat: its words alone
/// are printed, at the edge it lies beyond.
fn near(chart: &Chart) -> impl Iterator<Item = f64> {
    const FARTHEST: f64 = 2.5;
    let largest = chart
        .series
        .iter()
        .flat_map(|series| &series.points)
        .map(|point| point.1.abs())
        .fold(0.0, f64::max);
    chart
        .references
        .iter()
        .map(|reference| reference.y)
        .filter(move |y| largest == 0.0 || y.abs() <= FARTHEST * largest)
}

struct Sheet<'a> {
    canvas: &'a dyn Canvas,
    x: &'a Axis,
    y: &'a Axis,
    top: f64,
}

impl Sheet<'_> {
    fn point(&self, (x, y): (f64, f64)) -> Point {
        (
            LEFT + self.x.place(x) * (RIGHT - LEFT),
            BOTTOM - self.y.place(y) * (BOTTOM - self.top),
        )
    }

    fn bands(&self, chart: &Chart) -> Result<(), String> {
        for band in &chart.bands {
            for (from, to) in &band.intervals {
                let left = self.point((*from, 0.0)).0.clamp(LEFT, RIGHT);
                // A blow of one step stays visible.
                let right = self.point((*to, 0.0)).0.max(left + 0.75).clamp(LEFT, RIGHT);
                self.canvas
                    .rectangle((left, self.top), (right, BOTTOM), band.colour)?;
            }
        }
        Ok(())
    }

    /// Levels at the ticks, and the lines of zero where it lies inside.
    fn grid(&self) -> Result<(), String> {
        const ZERO: (Colour, f64) = ((150, 150, 150), 0.9);
        if self.x.low < 0.0 && self.x.high > 0.0 {
            let (colour, width) = ZERO;
            let (x, _) = self.point((0.0, 0.0));
            self.canvas.polyline(
                &[(x, self.top), (x, BOTTOM)],
                Line { width, dash: &[] },
                colour,
            )?;
        }
        for (tick, _) in &self.y.ticks {
            let y = BOTTOM - (tick - self.y.low) / (self.y.high - self.y.low) * (BOTTOM - self.top);
            let zero_inside = *tick == 0.0 && self.y.low < 0.0;
            let (colour, width) = if zero_inside { ZERO } else { (GRID, 0.7) };
            self.canvas
                .polyline(&[(LEFT, y), (RIGHT, y)], Line { width, dash: &[] }, colour)?;
        }
        Ok(())
    }

    fn axes(&self) -> Result<(), String> {
        let line = |from, to| {
            self.canvas.polyline(
                &[from, to],
                Line {
                    width: 1.1,
                    dash: &[],
                },
                INK,
            )
        };
        line((LEFT, self.top), (LEFT, BOTTOM))?;
        line((LEFT, BOTTOM), (RIGHT, BOTTOM))?;
        for (tick, label) in &self.y.ticks {
            let y = BOTTOM - (tick - self.y.low) / (self.y.high - self.y.low) * (BOTTOM - self.top);
            line((LEFT - 5.0, y), (LEFT, y))?;
            self.canvas.text(
                label,
                (LEFT - 9.0, y),
                &lettering(13.0, HPos::Right, VPos::Center),
            )?;
        }
        for (tick, label) in &self.x.ticks {
            let x = LEFT + (tick - self.x.low) / (self.x.high - self.x.low) * (RIGHT - LEFT);
            line((x, BOTTOM), (x, BOTTOM + 5.0))?;
            self.canvas.text(
                label,
                (x, BOTTOM + 9.0),
                &lettering(13.0, HPos::Center, VPos::Top),
            )?;
        }
        let middle = (0.5 * (LEFT + RIGHT), 0.5 * (self.top + BOTTOM));
        self.canvas.text(
            &self.x.title,
            (middle.0, BOTTOM + 30.0),
            &lettering(14.0, HPos::Center, VPos::Top),
        )?;
        let upright = Lettering {
            upright: true,
            ..lettering(14.0, HPos::Center, VPos::Top)
        };
        self.canvas.text(&self.y.title, (10.0, middle.1), &upright)
    }

    /// How many of its lines, or marks, are in the rectangle between these corners.
    fn crossings(&self, series: &Series, corners: (Point, Point)) -> usize {
        let lines = series
            .points
            .windows(2)
            .filter(|pair| series.style.line.is_some() && pair[0] != pair[1]);
        let lines = lines
            .filter(|pair| crosses((self.point(pair[0]), self.point(pair[1])), corners))
            .count();
        let marks = series
            .points
            .iter()
            .filter(|_| series.style.marker.is_some());
        lines
            + marks
                .filter(|point| crosses((self.point(**point), self.point(**point)), corners))
                .count()
    }

    fn series(&self, series: &Series) -> Result<(), String> {
        let points: Vec<Point> = series
            .points
            .iter()
            .filter(|(x, y)| x.is_finite() && y.is_finite())
            .map(|point| self.point(*point))
            .collect();
        // A cloud has no line to keep the look of: each of its marks counts.
        let points = if series.style.line.is_some() {
            columns(&points, THINNEST)
        } else {
            points
        };
        let points = thinned(&points, THINNEST);
        if let Some(line) = series.style.line {
            self.canvas.polyline(&points, line, series.style.colour)?;
        }
        if let Some(marker) = series.style.marker {
            for point in &points {
                mark(self.canvas, marker, *point, series.style.colour)?;
            }
        }
        Ok(())
    }

    /// Each line with its words where they cover the least data.
    fn references(&self, chart: &Chart) -> Result<(), String> {
        let mut written: Vec<(Point, Point)> = Vec::new();
        for (index, reference) in chart.references.iter().enumerate() {
            let place = self.y.place(reference.y);
            let label = match place {
                above if above > 1.0 => format!("↑ {}", reference.label),
                below if below < 0.0 => format!("↓ {}", reference.label),
                _ => reference.label.clone(),
            };
            let (_, y) = self.point((
                0.0,
                reference
                    .y
                    .clamp(self.y.low * self.y.factor, self.y.high * self.y.factor),
            ));
            if (0.0..=1.0).contains(&place) {
                self.canvas.polyline(
                    &[(LEFT, y), (RIGHT, y)],
                    Line {
                        width: 1.3,
                        dash: &[6.0, 4.0],
                    },
                    LIMIT_INK,
                )?;
            }
            if reference.label.is_empty() {
                continue;
            }
            let style = Lettering {
                colour: LIMIT_INK,
                ..lettering(12.0, HPos::Left, VPos::Bottom)
            };
            let width = style.width(&label)?;
            // Words may stand at either line of two that share them.
            let other = chart
                .references
                .get(index + 1)
                .filter(|other| other.label.is_empty());
            let other = other
                .filter(|_| (0.0..=1.0).contains(&place))
                .map(|other| self.point((0.0, other.y)).1);
            let bottoms = [Some(y), other]
                .into_iter()
                .flatten()
                .flat_map(|y| [y - 3.0, y + 18.0]);
            let covered = |(left, bottom): &Point| {
                let corners = ((*left, bottom - 16.0), (left + width, *bottom));
                let data = chart
                    .series
                    .iter()
                    .map(|series| self.crossings(series, corners))
                    .sum::<usize>();
                // Words on words are worse than words on any curve; words on the line of another limit nearly so.
                let (right, top) = (left + width, bottom - 16.0);
                let words = written.iter().any(|(from, to)| {
                    *left < to.0 + 8.0 && right > from.0 - 8.0 && top < to.1 && *bottom > from.1
                });
                let lines = chart
                    .references
                    .iter()
                    .filter(|other| (top..*bottom).contains(&self.point((0.0, other.y)).1))
                    .count();
                (words, lines, data)
            };
            let last = (RIGHT - width - 8.0).max(LEFT + 8.0);
            let places = bottoms.filter(|bottom| bottom - 17.0 >= self.top && *bottom <= BOTTOM);
            let places = places.flat_map(|bottom| {
                [last, 0.5 * (last + LEFT + 8.0), LEFT + 8.0].map(|left| (left, bottom))
            });
            let (left, bottom) = places.min_by_key(covered).unwrap_or((last, y + 18.0));
            written.push(((left, bottom - 16.0), (left + width, bottom)));
            self.canvas.text(&label, (left, bottom), &style)?;
        }
        Ok(())
    }
}

/// Whether the straight line between two points passes through the rectangle between two corners (after Liang and
/// Barsky: what is left of it, cut at each side in turn).
fn crosses((from, to): (Point, Point), (low, high): (Point, Point)) -> bool {
    let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
    for (start, way, low, high) in [
        (from.0, to.0 - from.0, low.0, high.0),
        (from.1, to.1 - from.1, low.1, high.1),
    ] {
        if way == 0.0 {
            if start < low || start > high {
                return false;
            }
            continue;
        }
        let (one, other) = ((low - start) / way, (high - start) / way);
        enters = enters.max(one.min(other));
        leaves = leaves.min(one.max(other));
    }
    enters <= leaves
}

fn lettering(size: f64, horizontal: HPos, vertical: VPos) -> Lettering {
    Lettering {
        size,
        bold: false,
        colour: INK,
        anchor: Anchor {
            horizontal,
            vertical,
        },
        upright: false,
    }
}

fn mark(canvas: &dyn Canvas, marker: Marker, at: Point, colour: Colour) -> Result<(), String> {
    match marker {
        Marker::Disc(radius) => canvas.disc(at, radius, colour),
        Marker::Ring(radius) => {
            canvas.disc(at, radius, colour)?;
            canvas.disc(at, radius - 1.3, (255, 255, 255))
        }
    }
}

/// Of each run of points in one upright column only the first, the lowest, the highest and the last: a record of a
/// million steps is drawn as fast as one of a thousand, and looks the same.
fn columns(points: &[Point], width: f64) -> Vec<Point> {
    let column = |point: &Point| (point.0 / width).floor();
    let mut kept = Vec::new();
    for run in points.chunk_by(|a, b| column(a) == column(b)) {
        if run.len() <= 4 {
            kept.extend_from_slice(run);
            continue;
        }
        let by_height = |a: &usize, b: &usize| run[*a].1.total_cmp(&run[*b].1);
        let lowest = (0..run.len()).min_by(by_height).unwrap_or(0);
        let highest = (0..run.len()).max_by(by_height).unwrap_or(0);
        let mut chosen = [0, lowest, highest, run.len() - 1];
        chosen.sort_unstable();
        kept.extend(chosen.map(|index| run[index]));
    }
    kept
}

/// The points less those nearer than `least` to the one kept before, except where the line turns back: a short blow
/// or a sharp peak is never lost. The last point always stays.
fn thinned(points: &[Point], least: f64) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::new();
    for (index, point) in points.iter().enumerate() {
        let Some(last) = kept.last() else {
            kept.push(*point);
            continue;
        };
        let far = (point.0 - last.0).hypot(point.1 - last.1) >= least;
        let turns = points.get(index + 1).is_none_or(|next| {
            let before = points[index - 1];
            (point.1 - before.1) * (next.1 - point.1) < 0.0
        }) && point != last;
        if far || turns {
            kept.push(*point);
        }
    }
    kept
}

enum Entry<'a> {
    Series(&'a Series),
    Band(&'static str, Colour),
}

impl Entry<'_> {
    fn sample(&self) -> f64 {
        match self {
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

fn legend_entries(chart: &Chart) -> Vec<Entry<'_>> {
    let series = chart
        .series
        .iter()
        .filter(|series| !series.label.is_empty())
        .map(Entry::Series);
    let bands = chart
        .bands
        .iter()
        .filter(|band| !band.intervals.is_empty())
        .map(|band| Entry::Band(band.label, band.colour));
    series.chain(bands).collect()
}

/// Length of a line's sample.
const SAMPLE: f64 = 30.0;
/// Space before the next entry.
const GAP: f64 = 18.0;
/// From a sample to its words.
const NEAR: f64 = 7.0;

/// Entries with the left end of each, broken into lines that fit the frame.
fn legend_rows<'a, 'b>(entries: &'b [Entry<'a>]) -> Result<Vec<Vec<(&'b Entry<'a>, f64)>>, String> {
    let mut rows: Vec<Vec<(&Entry<'_>, f64)>> = vec![Vec::new()];
    let mut left = LEFT;
    for entry in entries {
        let width = entry.sample()
            + NEAR
            + lettering(13.0, HPos::Left, VPos::Center).width(entry.label())?;
        if left + width > RIGHT && left > LEFT {
            rows.push(Vec::new());
            left = LEFT;
        }
        if let Some(row) = rows.last_mut() {
            row.push((entry, left));
        }
        left += width + GAP;
    }
    Ok(rows)
}

fn legend_entry(
    canvas: &dyn Canvas,
    entry: &Entry<'_>,
    (left, middle): Point,
) -> Result<(), String> {
    let sample = entry.sample();
    match entry {
        Entry::Series(series) => {
            if let Some(line) = series.style.line {
                canvas.polyline(
                    &[(left, middle), (left + sample, middle)],
                    line,
                    series.style.colour,
                )?;
            }
            if let Some(marker) = series.style.marker {
                mark(
                    canvas,
                    marker,
                    (left + 0.5 * sample, middle),
                    series.style.colour,
                )?;
            }
        }
        Entry::Band(_, colour) => {
            canvas.rectangle(
                (left, middle - 6.0),
                (left + sample, middle + 6.0),
                palette::CLOUD,
            )?;
            canvas.rectangle(
                (left + 0.8, middle - 5.2),
                (left + sample - 0.8, middle + 5.2),
                *colour,
            )?;
        }
    }
    canvas.text(
        entry.label(),
        (left + sample + NEAR, middle),
        &lettering(13.0, HPos::Left, VPos::Center),
    )
}

#[cfg(test)]
mod tests {
    use super::super::chart::{Quantity, Reference, Style};
    use super::*;
    use crate::units::Dimension;

    #[test]
    fn a_dense_record_keeps_first_lowest_highest_and_last_of_each_column() {
        let points: Vec<Point> = (0..1000)
            .map(|i| (f64::from(i) * 0.001, f64::from(i * 7 % 101)))
            .collect();
        let kept = columns(&points, 0.5);
        assert_eq!(kept.len(), 8);
        assert!(
            kept.contains(&(0.0, 0.0))
                && kept.iter().any(|point| point.1 == 100.0)
                && kept.last() == points.last()
        );
    }

    #[test]
    fn a_line_crosses_words_that_neither_of_its_ends_is_in() {
        let words = ((10.0, 10.0), (20.0, 14.0));
        assert!(crosses(((0.0, 0.0), (30.0, 24.0)), words));
        assert!(
            crosses(((15.0, 0.0), (15.0, 30.0)), words)
                && crosses(((12.0, 12.0), (12.0, 12.0)), words)
        );
        assert!(
            !crosses(((0.0, 0.0), (30.0, 9.0)), words)
                && !crosses(((0.0, 12.0), (9.0, 12.0)), words)
        );
        assert!(
            !crosses(((21.0, 0.0), (21.0, 30.0)), words)
                && !crosses(((15.0, 15.0), (15.0, 15.0)), words)
        );
    }

    #[test]
    fn a_far_limit_does_not_stretch_the_axis() {
        let chart = |limit: f64| Chart {
            x: Quantity::time(),
            y: Quantity::of("Force", Dimension::FORCE),
            bands: Vec::new(),
            series: vec![Series {
                label: String::new(),
                points: vec![(0.0, 0.0), (1.0, 10.0)].into(),
                style: Style::line(palette::BLUE, 1.0, &[]),
            }],
            references: vec![Reference {
                label: String::new(),
                y: limit,
            }],
        };
        assert_eq!(near(&chart(12.0)).collect::<Vec<f64>>(), [12.0]);
        assert_eq!(near(&chart(1e6)).count(), 0);
        assert!(png(&chart(1e6)).is_ok());
    }

    #[test]
    fn thinning_keeps_ends_and_turning_points() {
        let mut points: Vec<Point> = (0..100).map(|i| (f64::from(i) * 0.01, 0.0)).collect();
        points[40].1 = 0.3;
        let kept = thinned(&points, 0.5);
        assert!(kept.len() < 12);
        assert!(
            kept.contains(&(0.4, 0.3))
                && kept.first() == points.first()
                && kept.last() == points.last()
        );
    }
}
