//! The surface of a chart: shapes and text in reference pixels, 96 to the inch, y downward. There are two canvases: a raster
//! and a vector drawing. Both use the same font, so that text has the same width on each.

use std::sync::Once;

use plotters::prelude::{IntoFont as _, RGBColor};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, FontStyle, FontTransform, TextStyle, register_font};

use super::super::document::fonts::{SANS, SANS_BOLD};
use super::chart::{Colour, Line};

/// A point in reference pixels, y downward.
pub(super) type Point = (f64, f64);

/// A surface to draw on.
pub(super) trait Canvas {
    fn rectangle(&self, from: Point, to: Point, colour: Colour);

    fn disc(&self, centre: Point, radius: f64, colour: Colour);

    /// A filled area; its corners in order.
    fn polygon(&self, corners: &[Point], colour: Colour);

    /// A line of several segments with round joins.
    fn polyline(&self, points: &[Point], line: Line, colour: Colour);

    fn text(&self, text: &str, anchor: Point, style: &Lettering);
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
            .box_size(&crate::text::glyphs::shown(text))
            .expect("the embedded font reads");
        f64::from(width) / MEASURED_AT
    }

    /// The style for the font library, `scale` times as large.
    pub fn scaled(&self, scale: f64) -> TextStyle<'static> {
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
        let (red, green, blue) = self.colour;
        let color = RGBColor(red, green, blue).to_backend_color();
        TextStyle {
            font,
            color,
            pos: Pos::new(self.anchor.horizontal, self.anchor.vertical),
        }
    }
}
