//! The frame of a figure: bands, grid, axes and curves. In: a chart with its axes. Out: shapes on a canvas.

use plotters::style::text_anchor::{HPos, VPos};

use super::super::axis::Axis;
use super::super::canvas::{Canvas, Lettering, Point};
use super::super::chart::{Chart, Colour, LineStyle, Series};
use super::thinning::{columns, thinned};
use super::{BOTTOM, GRID, INK, RIGHT, THINNEST, draw_marker, lettering};

/// The area of the data with its axes.
pub(super) struct Sheet<'a> {
    pub canvas: &'a Canvas,
    pub x: &'a Axis,
    pub y: &'a Axis,
    /// Upper edge of the frame, reference pixels.
    pub top: f64,
    /// Left edge of the frame, reference pixels.
    pub left: f64,
}

impl Sheet<'_> {
    /// The point of an SI value in reference pixels.
    pub fn point(&self, data: (f64, f64)) -> Point {
        let (x, y) = data;
        (
            self.left + self.x.fraction(x) * (RIGHT - self.left),
            BOTTOM - self.y.fraction(y) * (BOTTOM - self.top),
        )
    }

    pub fn bands(&self, chart: &Chart) {
        for band in &chart.bands {
            for (from, to) in &band.intervals {
                let left = self.point((*from, 0.0)).0.clamp(self.left, RIGHT);
                // An impact of one step stays visible.
                let right = self
                    .point((*to, 0.0))
                    .0
                    .max(left + 0.75)
                    .clamp(self.left, RIGHT);
                self.canvas
                    .rectangle((left, self.top), (right, BOTTOM), band.colour);
            }
        }
    }

    /// Horizontal lines at the ticks, and the lines of zero inside the frame.
    pub fn grid(&self) {
        const ZERO: (Colour, f64) = ((150, 150, 150), 0.9);
        if self.x.low < 0.0 && self.x.high > 0.0 {
            let (colour, width) = ZERO;
            let (x, _) = self.point((0.0, 0.0));
            self.canvas.polyline(
                &[(x, self.top), (x, BOTTOM)],
                LineStyle { width, dash: &[] },
                colour,
            );
        }
        for (tick, _) in &self.y.ticks {
            let y = BOTTOM - (tick - self.y.low) / (self.y.high - self.y.low) * (BOTTOM - self.top);
            let zero_inside = *tick == 0.0 && self.y.low < 0.0;
            let (colour, width) = if zero_inside { ZERO } else { (GRID, 0.7) };
            self.canvas.polyline(
                &[(self.left, y), (RIGHT, y)],
                LineStyle { width, dash: &[] },
                colour,
            );
        }
    }

    pub fn axes(&self) {
        let line = |from, to| {
            self.canvas.polyline(
                &[from, to],
                LineStyle {
                    width: 1.1,
                    dash: &[],
                },
                INK,
            );
        };
        line((self.left, self.top), (self.left, BOTTOM));
        line((self.left, BOTTOM), (RIGHT, BOTTOM));
        for (tick, label) in &self.y.ticks {
            let y = BOTTOM - (tick - self.y.low) / (self.y.high - self.y.low) * (BOTTOM - self.top);
            line((self.left - 5.0, y), (self.left, y));
            self.canvas.text(
                label,
                (self.left - 9.0, y),
                &lettering(13.0, HPos::Right, VPos::Center),
            );
        }
        for (tick, label) in &self.x.ticks {
            let x =
                self.left + (tick - self.x.low) / (self.x.high - self.x.low) * (RIGHT - self.left);
            line((x, BOTTOM), (x, BOTTOM + 5.0));
            self.canvas.text(
                label,
                (x, BOTTOM + 9.0),
                &lettering(13.0, HPos::Center, VPos::Top),
            );
        }
        let middle = (0.5 * (self.left + RIGHT), 0.5 * (self.top + BOTTOM));
        self.canvas.text(
            &self.x.title,
            (middle.0, BOTTOM + 30.0),
            &lettering(14.0, HPos::Center, VPos::Top),
        );
        let upright = Lettering {
            upright: true,
            ..lettering(14.0, HPos::Center, VPos::Top)
        };
        self.canvas.text(&self.y.title, (10.0, middle.1), &upright);
    }

    pub fn series(&self, series: &Series) {
        let points: Vec<Point> = series
            .points
            .iter()
            .filter(|(x, y)| x.is_finite() && y.is_finite())
            .map(|point| self.point(*point))
            .collect();
        if series.style.fill {
            return self.canvas.polygon(&points, series.style.colour);
        }
        // Every marker of a series without a line is drawn.
        let points = if series.style.line.is_some() {
            columns(&points, THINNEST)
        } else {
            points
        };
        let points = thinned(&points, THINNEST);
        if let Some(line) = series.style.line {
            self.canvas.polyline(&points, line, series.style.colour);
        }
        if let Some(marker) = series.style.marker {
            for point in &points {
                draw_marker(self.canvas, marker, *point, series.style.colour);
            }
        }
    }
}
