//! The outline of a text. In: a font, a size, a text. Out: a path that begins at (0, 0) on the baseline, y downward. It draws nothing.

use ab_glyph::{Font as _, FontRef, InvalidFont, OutlineCurve, Point, ScaleFont as _};
use tiny_skia::{Path, PathBuilder};

/// The letters of a sheet.
pub struct Fonts {
    regular: FontRef<'static>,
    bold: FontRef<'static>,
}

impl Fonts {
    /// # Errors
    /// One of them is no font.
    pub fn new(regular: &'static [u8], bold: &'static [u8]) -> Result<Self, InvalidFont> {
        Ok(Self {
            regular: FontRef::try_from_slice(regular)?,
            bold: FontRef::try_from_slice(bold)?,
        })
    }

    pub(crate) const fn of(&self, bold: bool) -> &FontRef<'static> {
        if bold { &self.bold } else { &self.regular }
    }
}

/// The outlines of the letters of a text, `size` high from the lowest to the highest letter of the font.
pub(crate) fn text_outline(font: &FontRef<'static>, size: f32, text: &str) -> Option<Path> {
    let mut path = PathBuilder::new();
    let scaled = font.as_scaled(size);
    let (across, up) = (scaled.h_scale_factor(), scaled.v_scale_factor());
    let (mut x, mut previous) = (0.0, None);
    for letter in text.chars() {
        let glyph = font.glyph_id(letter);
        if let Some(previous) = previous {
            x += scaled.kern(previous, glyph);
        }
        previous = Some(glyph);
        let curves = font.outline(glyph).map(|outline| outline.curves);
        let place = |point: Point| (x + point.x * across, -point.y * up);
        let mut last = None;
        for curve in curves.unwrap_or_default() {
            let (from, to) = match curve {
                OutlineCurve::Line(from, to)
                | OutlineCurve::Quad(from, _, to)
                | OutlineCurve::Cubic(from, _, _, to) => (from, to),
            };
            if last != Some(from) {
                let (x, y) = place(from);
                path.move_to(x, y);
            }
            last = Some(to);
            let (x, y) = place(to);
            match curve {
                OutlineCurve::Line(..) => path.line_to(x, y),
                OutlineCurve::Quad(_, bend, _) => {
                    let (bend_x, bend_y) = place(bend);
                    path.quad_to(bend_x, bend_y, x, y);
                }
                OutlineCurve::Cubic(_, first, second, _) => {
                    let ((first_x, first_y), (second_x, second_y)) = (place(first), place(second));
                    path.cubic_to(first_x, first_y, second_x, second_y, x, y);
                }
            }
        }
        x += scaled.h_advance(glyph);
    }
    path.finish()
}
