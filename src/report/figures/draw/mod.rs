//! The layout of a [`Chart`]: legend above, axes left and below, only data inside the frame. In: a chart in SI. Out: SVG.

mod legend;
mod references;
mod sheet;
mod thinning;

use plotters::style::text_anchor::{HPos, VPos};

use super::axis::Axis;
use super::canvas::{self, Anchor, Canvas, Lettering, Point};
use super::chart::{Chart, Colour, Marker};
use sheet::Sheet;

const WIDTH: u32 = 720;
const HEIGHT: u32 = 430;
/// The frame, reference pixels; its top moves down if the legend has two lines.
const LEFT: f64 = 78.0;
const RIGHT: f64 = 700.0;
/// The left edge of a frame with long names beside it.
const WIDEST_NAMES: f64 = 330.0;
const BOTTOM: f64 = 372.0;
const LEGEND_TOP: f64 = 20.0;
const LEGEND_LINE: f64 = 21.0;
pub(super) const INK: Colour = (40, 40, 40);
const GRID: Colour = (232, 232, 232);
const LIMIT_INK: Colour = (150, 20, 20);
/// Points closer than this are dropped, reference pixels: half a pixel is not visible.
const THINNEST: f64 = 0.5;

/// The chart as an SVG.
pub(crate) fn svg(chart: &Chart) -> String {
    canvas::svg(WIDTH, HEIGHT, |canvas| paint(chart, canvas))
}

fn paint(chart: &Chart, canvas: &Canvas) {
    let xs = chart
        .series
        .iter()
        .flat_map(|series| series.points.iter().map(|point| point.0));
    let ys = chart
        .series
        .iter()
        .flat_map(|series| series.points.iter().map(|point| point.1));
    let references = references::near(chart);
    let x = Axis::over(&chart.x, xs, 8);
    let y = Axis::over(&chart.y, ys.chain(references), 6);
    let entries = legend::entries(chart);
    let rows = legend::rows(&entries);
    #[expect(clippy::cast_precision_loss, reason = "a legend has a few lines")]
    let top = LEGEND_TOP + LEGEND_LINE * rows.len().max(1) as f64 - 2.0;
    let sheet = Sheet {
        canvas,
        x: &x,
        y: &y,
        top,
        left: left_edge(chart),
    };
    sheet.bands(chart);
    sheet.grid();
    for series in &chart.series {
        sheet.series(series);
    }
    references::draw(&sheet, chart);
    sheet.axes();
    for (index, row) in rows.iter().enumerate() {
        #[expect(clippy::cast_precision_loss, reason = "a legend has a few lines")]
        let middle = LEGEND_TOP + LEGEND_LINE * index as f64 - 4.0;
        for (entry, left) in row {
            legend::draw(canvas, entry, (*left, middle));
        }
    }
}

/// The left edge of the frame: an axis of names needs the width of the longest one.
fn left_edge(chart: &Chart) -> f64 {
    let style = lettering(13.0, HPos::Right, VPos::Center);
    let title = if chart.y.name.is_empty() { 0.0 } else { 24.0 };
    let mut left = LEFT;
    for name in &chart.y.names {
        left = left.max(style.width(name) + 20.0 + title);
    }
    left.min(WIDEST_NAMES)
}

pub(super) fn lettering(size: f64, horizontal: HPos, vertical: VPos) -> Lettering {
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

fn draw_marker(canvas: &Canvas, marker: Marker, at: Point, colour: Colour) {
    match marker {
        Marker::Disc(radius) => canvas.disc(at, radius, colour),
        Marker::Ring(radius) => {
            canvas.disc(at, radius, colour);
            canvas.disc(at, radius - 1.3, (255, 255, 255));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::chart::{Quantity, Reference, Series, Style, palette};
    use super::*;
    use psd_text::units::Dimension;

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
        assert_eq!(references::near(&chart(12.0)).collect::<Vec<f64>>(), [12.0]);
        assert_eq!(references::near(&chart(1e6)).count(), 0);
        assert!(svg(&chart(1e6)).starts_with("<svg"));
    }
}
