//! The surface of a chart: shapes and text in reference pixels, 96 to the inch, y downward. plotters draws them, in fractions of a
//! reference pixel, on a vector drawing.

use std::sync::Once;

use plotters::coord::Shift;
use plotters::element::{Drawable, PointCollection};
use plotters::prelude::{
    Circle, DrawingArea, IntoDrawingArea as _, IntoFont as _, Polygon, RGBColor, Rectangle, Text,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, FontStyle, FontTransform, TextStyle, register_font};
use plotters_backend::BackendCoord;

use super::super::document::fonts::{SANS, SANS_BOLD};
use super::chart::{Colour, LineStyle};
use super::vector::{Drawing, Polyline, UNITS};

/// A point in reference pixels, y downward.
pub(super) type Point = (f64, f64);

/// A surface to draw on.
pub(super) struct Canvas(DrawingArea<Drawing, Shift>);

#[expect(
    clippy::cast_possible_truncation,
    reason = "clamped to a few times any sheet"
)]
fn units((x, y): Point) -> BackendCoord {
    let scale = |value: f64| (value.clamp(-1e5, 1e5) * UNITS).round() as i32;
    (scale(x), scale(y))
}

const fn rgb((red, green, blue): Colour) -> RGBColor {
    RGBColor(red, green, blue)
}

/// Draws on `width × height` reference pixels.
pub(super) fn svg(width: u32, height: u32, paint: impl FnOnce(&Canvas)) -> String {
    let drawing = Drawing::new(width, height);
    paint(&Canvas(drawing.clone().into_drawing_area()));
    drawing.svg()
}

impl Canvas {
    fn draw<E: Drawable<Drawing>>(&self, element: &E)
    where
        for<'b> &'b E: PointCollection<'b, BackendCoord>,
    {
        self.0
            .draw(element)
            .expect("a drawing in memory takes every shape");
    }

    pub fn rectangle(&self, from: Point, to: Point, colour: Colour) {
        self.draw(&Rectangle::new(
            [units(from), units(to)],
            rgb(colour).filled(),
        ));
    }

    pub fn disc(&self, centre: Point, radius: f64, colour: Colour) {
        let (radius, _) = units((radius, 0.0));
        self.draw(&Circle::new(units(centre), radius, rgb(colour).filled()));
    }

    /// A filled area; its corners in order.
    pub fn polygon(&self, corners: &[Point], colour: Colour) {
        let corners: Vec<BackendCoord> = corners.iter().copied().map(units).collect();
        self.draw(&Polygon::new(corners, rgb(colour).filled()));
    }

    /// A line of several segments with round joins.
    pub fn polyline(&self, points: &[Point], line: LineStyle, colour: Colour) {
        self.draw(&Polyline {
            points: points.iter().copied().map(units).collect(),
            line,
            colour,
        });
    }

    pub fn text(&self, text: &str, anchor: Point, style: &Lettering) {
        self.draw(&Text::new(
            text.to_owned(),
            units(anchor),
            style.scaled(UNITS),
        ));
    }
}

/// Position of a text relative to its anchor point.
#[derive(Clone, Copy)]
pub(super) struct Anchor {
    pub horizontal: HPos,
    pub vertical: VPos,
}

/// Size, weight, colour and direction of a text.
#[derive(Clone, Copy)]
pub(super) struct Lettering {
    /// Height of a line from the lowest to the highest letter, reference pixels.
    pub size: f64,
    pub bold: bool,
    pub colour: Colour,
    pub anchor: Anchor,
    /// Rotated, read from bottom to top.
    pub upright: bool,
}

/// Text is measured at a multiple of its size: the font library rounds to whole pixels.
const MEASURED_AT: f64 = 8.0;

impl Lettering {
    /// Width of a text as it is drawn, in reference pixels.
    pub fn width(&self, text: &str) -> f64 {
        let (width, _) = self
            .scaled(MEASURED_AT)
            .font
            .box_size(&psd_text::glyphs::shown(text))
            .expect("the embedded font reads");
        f64::from(width) / MEASURED_AT
    }

    /// The style for plotters, `scale` times as large.
    fn scaled(&self, scale: f64) -> TextStyle<'static> {
        const FAMILY: &str = "psd";
        static FONTS: Once = Once::new();
        FONTS.call_once(|| {
            // The two fonts are part of the program: whether they are readable depends on the build, not on a run.
            for (style, font) in [(FontStyle::Normal, SANS), (FontStyle::Bold, SANS_BOLD)] {
                assert!(
                    register_font(FAMILY, style, font).is_ok(),
                    "the embedded font reads"
                );
            }
        });
        let weight = if self.bold {
            FontStyle::Bold
        } else {
            FontStyle::Normal
        };
        let mut font = (FAMILY, self.size * scale, weight).into_font();
        if self.upright {
            font = font.transform(FontTransform::Rotate270);
        }
        TextStyle {
            font,
            color: rgb(self.colour).to_backend_color(),
            pos: Pos::new(self.anchor.horizontal, self.anchor.vertical),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_is_never_markup() {
        let anchor = Anchor {
            horizontal: HPos::Left,
            vertical: VPos::Top,
        };
        let style = Lettering {
            size: 13.0,
            bold: false,
            colour: (0, 0, 0),
            anchor,
            upright: false,
        };
        let drawn = svg(10, 10, |canvas| {
            canvas.text("</text><script>&\u{1b}", (1.0, 2.0), &style);
        });
        assert!(
            drawn.contains(">&lt;/text&gt;&lt;script&gt;&amp;\u{fffd}</text>"),
            "{drawn}"
        );
    }
}
