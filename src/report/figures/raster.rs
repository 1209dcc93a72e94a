//! The raster canvas: a sheet of `psd-raster`. In: shapes in reference pixels. Out: PNG bytes. It knows no axes.

use plotters::style::text_anchor::VPos;
use psd_raster::{FINE, Fonts, Sheet};

use super::canvas::{Canvas, Lettering, Point};
use super::chart::{Colour, Line};
use crate::report::document::fonts::{SANS, SANS_BOLD};

/// Draws on a white sheet of `width × height` reference pixels and encodes it.
pub(super) fn png(
    width: u32,
    height: u32,
    paint: impl FnOnce(&dyn Canvas),
) -> Result<Vec<u8>, String> {
    let fonts = Fonts::new(SANS, SANS_BOLD).map_err(|error| error.to_string())?;
    psd_raster::png(width, height, &fonts, |sheet| paint(sheet))
}

impl Canvas for Sheet<'_> {
    fn rectangle(&self, from: Point, to: Point, colour: Colour) {
        self.rectangle(from, to, colour);
    }

    fn disc(&self, centre: Point, radius: f64, colour: Colour) {
        self.disc(centre, radius, colour);
    }

    fn polygon(&self, corners: &[Point], colour: Colour) {
        self.polygon(corners, colour);
    }

    fn polyline(&self, points: &[Point], line: Line, colour: Colour) {
        let Line { width, dash } = line;
        self.polyline(points, psd_raster::Line { width, dash }, colour);
    }

    fn text(&self, text: &str, anchor: Point, style: &Lettering) {
        // The box of the font is taller below its letters than above: a centred text is lowered to look centred.
        let is_lowered = matches!(style.anchor.vertical, VPos::Center) && !style.upright;
        let anchor = if is_lowered {
            (anchor.0, anchor.1 + 0.17 * style.size)
        } else {
            anchor
        };
        let style = style.scaled(f64::from(FINE));
        self.text(&crate::text::glyphs::shown(text), anchor, style);
    }
}
