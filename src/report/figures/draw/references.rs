//! Reference lines with their text, at the position that covers the least of the data. In: a chart on its sheet. Out: shapes on a canvas.

use plotters::style::text_anchor::{HPos, VPos};
use psd_physics::statistics::samples::peak;

use super::super::canvas::{Lettering, Point};
use super::super::chart::{Chart, LineStyle, Reference, Series};
use super::sheet::Sheet;
use super::{BOTTOM, LIMIT_INK, RIGHT, lettering};
use crate::report::wording::figures as wording;

/// Number of limits with a text that are drawn; the others are counted. Texts of more would cover each other.
const MOST: usize = 12;

/// The reference lines that are drawn, and the number of limits that are not.
fn drawn(chart: &Chart) -> (&[Reference], usize) {
    let mut labelled = chart
        .references
        .iter()
        .enumerate()
        .filter(|(_, reference)| !reference.label.is_empty())
        .map(|(index, _)| index);
    match labelled.nth(MOST) {
        Some(first_left) => (&chart.references[..first_left], 1 + labelled.count()),
        None => (&chart.references, 0),
    }
}

/// Reference lines that the axis includes. If a line is far from the data, only its text is printed, at the nearer edge. Otherwise the
/// axis range would make the curves flat.
pub(super) fn near(chart: &Chart) -> impl Iterator<Item = f64> {
    const FARTHEST: f64 = 2.5;
    let points = chart.series.iter().flat_map(|series| &series.points);
    let largest = peak(points.map(|point| point.1));
    drawn(chart)
        .0
        .iter()
        .map(|reference| reference.y)
        .filter(move |y| largest == 0.0 || y.abs() <= FARTHEST * largest)
}

/// A rectangle in reference pixels, y downward.
#[derive(Clone, Copy)]
struct Area {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

/// Height of a text, reference pixels.
const TEXT_HEIGHT: f64 = 16.0;

impl Area {
    /// The area of a text of this width with its lower left corner here.
    fn of_text((left, bottom): Point, width: f64) -> Self {
        Self {
            left,
            right: left + width,
            top: bottom - TEXT_HEIGHT,
            bottom,
        }
    }

    /// Whether two texts overlap, or are side by side with too little space.
    fn touches(self, other: Self) -> bool {
        const SPACE: f64 = 8.0;
        self.left < other.right + SPACE
            && self.right > other.left - SPACE
            && self.top < other.bottom
            && self.bottom > other.top
    }

    /// Whether the straight line between two points passes through the area (Liang–Barsky: the line is clipped at each side
    /// in turn).
    fn is_crossed_by(self, from: Point, to: Point) -> bool {
        let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
        for (start, length, low, high) in [
            (from.0, to.0 - from.0, self.left, self.right),
            (from.1, to.1 - from.1, self.top, self.bottom),
        ] {
            if length == 0.0 {
                if start < low || start > high {
                    return false;
                }
                continue;
            }
            let (one, other) = ((low - start) / length, (high - start) / length);
            enters = enters.max(one.min(other));
            leaves = leaves.min(one.max(other));
        }
        enters <= leaves
    }

    /// Number of line segments and markers of a series that pass through the area.
    fn crossings(self, sheet: &Sheet<'_>, series: &Series) -> usize {
        let segments = series
            .points
            .windows(2)
            .filter(|pair| series.style.line.is_some() && pair[0] != pair[1]);
        let segments =
            segments.filter(|pair| self.is_crossed_by(sheet.point(pair[0]), sheet.point(pair[1])));
        let markers = series
            .points
            .iter()
            .filter(|_| series.style.marker.is_some());
        let markers = markers.filter(|point| {
            let point = sheet.point(**point);
            self.is_crossed_by(point, point)
        });
        segments.count() + markers.count()
    }
}

/// Draws each reference line with its text at the position that covers the least data.
pub(super) fn draw(sheet: &Sheet<'_>, chart: &Chart) {
    let mut written: Vec<Area> = Vec::new();
    let (drawn, left) = drawn(chart);
    let last = drawn
        .iter()
        .rposition(|reference| !reference.label.is_empty());
    for (index, reference) in drawn.iter().enumerate() {
        let fraction = sheet.y.fraction(reference.y);
        let is_inside = (0.0..=1.0).contains(&fraction);
        let label = match fraction {
            above if above > 1.0 => format!("↑ {}", reference.label),
            below if below < 0.0 => format!("↓ {}", reference.label),
            _ => reference.label.clone(),
        };
        let label = if left > 0 && last == Some(index) {
            wording::more_limits(label, left)
        } else {
            label
        };
        let (low, high) = (sheet.y.low * sheet.y.factor, sheet.y.high * sheet.y.factor);
        let (_, y) = sheet.point((0.0, reference.y.clamp(low, high)));
        if is_inside {
            let line = LineStyle {
                width: 1.3,
                dash: &[6.0, 4.0],
            };
            sheet
                .canvas
                .polyline(&[(sheet.left, y), (RIGHT, y)], line, LIMIT_INK);
        }
        if reference.label.is_empty() {
            continue;
        }
        let style = Lettering {
            colour: LIMIT_INK,
            ..lettering(12.0, HPos::Left, VPos::Bottom)
        };
        let width = style.width(&label);
        // A reference without a label shares the text of the previous one: the text may be at either line.
        let other = drawn
            .get(index + 1)
            .filter(|other| is_inside && other.label.is_empty());
        let other = other.map(|other| sheet.point((0.0, other.y)).1);
        let bottoms = [Some(y), other]
            .into_iter()
            .flatten()
            .flat_map(|y| [y - 3.0, y + 18.0])
            .filter(|bottom| bottom - 17.0 >= sheet.top && *bottom <= BOTTOM);
        let rightmost = (RIGHT - width - 8.0).max(sheet.left + 8.0);
        let positions = bottoms.flat_map(|bottom| {
            let middle = 0.5 * (rightmost + sheet.left + 8.0);
            [rightmost, middle, sheet.left + 8.0].map(|left| (left, bottom))
        });
        let covered = |position: &Point| {
            cover(
                sheet,
                chart,
                drawn,
                &written,
                Area::of_text(*position, width),
            )
        };
        let position = positions
            .min_by_key(covered)
            .unwrap_or((rightmost, y + 18.0));
        written.push(Area::of_text(position, width));
        sheet.canvas.text(&label, position, &style);
    }
}

/// The objects that a text would cover, the most important first: another text, lines of other limits, data.
fn cover(
    sheet: &Sheet<'_>,
    chart: &Chart,
    drawn: &[Reference],
    written: &[Area],
    area: Area,
) -> (bool, usize, usize) {
    let texts = written.iter().any(|other| area.touches(*other));
    let lines = drawn
        .iter()
        .filter(|other| (area.top..area.bottom).contains(&sheet.point((0.0, other.y)).1))
        .count();
    let data = chart
        .series
        .iter()
        .map(|series| area.crossings(sheet, series))
        .sum();
    (texts, lines, data)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::figures::chart::Quantity;

    #[test]
    fn a_dozen_limits_are_drawn_and_the_others_counted() {
        let quantity = || Quantity::of("x", psd_text::units::Dimension::LENGTH);
        let mut chart = Chart::of(quantity(), quantity(), Vec::new());
        let mut limit = |label: &str, y| {
            chart.references.push(Reference {
                label: label.to_owned(),
                y,
            });
            let (drawn, left) = drawn(&chart);
            (drawn.len(), left)
        };
        for count in 1..=12 {
            assert_eq!(limit("a limit", 1.0), (2 * count - 1, 0));
            assert_eq!(limit("", -1.0), (2 * count, 0));
        }
        assert_eq!(limit("the thirteenth", 2.0), (24, 1));
        assert_eq!(limit("", -2.0), (24, 1));
        assert_eq!(limit("the fourteenth", 3.0), (24, 2));
        assert_eq!(near(&chart).count(), 24);
        assert_eq!(
            wording::more_limits("a limit", 2),
            "a limit (and 2 more limits)"
        );
    }

    #[test]
    fn a_line_crosses_a_text_that_holds_neither_of_its_ends() {
        let text = Area {
            left: 10.0,
            right: 20.0,
            top: 10.0,
            bottom: 14.0,
        };
        assert!(text.is_crossed_by((0.0, 0.0), (30.0, 24.0)));
        assert!(text.is_crossed_by((15.0, 0.0), (15.0, 30.0)));
        assert!(text.is_crossed_by((12.0, 12.0), (12.0, 12.0)));
        assert!(!text.is_crossed_by((0.0, 0.0), (30.0, 9.0)));
        assert!(!text.is_crossed_by((0.0, 12.0), (9.0, 12.0)));
        assert!(!text.is_crossed_by((21.0, 0.0), (21.0, 30.0)));
        assert!(!text.is_crossed_by((15.0, 15.0), (15.0, 15.0)));
    }
}
