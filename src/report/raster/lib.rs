//! Lines, areas and text as a PNG: shapes are drawn with 8 × 8 subpixels per reference pixel and averaged to 2 × 2, which is 192 dpi. In:
//! shapes in reference pixels. Out: PNG bytes. It knows no axes.
//!
//! It is a crate of its own for its build: all its work is loops over pixels, and a development build optimises this crate alone.

mod average;
mod dashes;
mod shapes;

use plotters::prelude::{
    BitMapBackend, Circle, DrawingArea, IntoDrawingArea as _, Polygon, RGBColor, Rectangle, Text,
};
use plotters::style::{Color as _, TextStyle};

use average::{BOX, average};
use dashes::dashes;
pub use shapes::{Colour, Line, Point};

/// Subpixels per reference pixel, in each direction.
pub const FINE: u32 = 8;
/// 192 dpi in pixels per metre.
const PIXELS_PER_METRE: u32 = 7559;

/// A sheet to draw on.
pub struct Sheet<'a> {
    area: DrawingArea<BitMapBackend<'a>, plotters::coord::Shift>,
}

/// Draws on a white sheet of `width × height` reference pixels and encodes it.
///
/// # Errors
/// A shape cannot be drawn, or the picture cannot be encoded.
pub fn png(
    width: u32,
    height: u32,
    paint: &dyn Fn(&Sheet<'_>) -> Result<(), String>,
) -> Result<Vec<u8>, String> {
    let (fine_width, fine_height) = (width * FINE, height * FINE);
    let mut fine = vec![255_u8; fine_width as usize * fine_height as usize * 3];
    {
        let area =
            BitMapBackend::with_buffer(&mut fine, (fine_width, fine_height)).into_drawing_area();
        let sheet = Sheet { area };
        paint(&sheet)?;
        sheet.area.present().map_err(|error| error.to_string())?;
    }
    encode(
        &average(&fine, fine_width as usize),
        fine_width / BOX,
        fine_height / BOX,
    )
    .map_err(|error| error.to_string())
}

fn encode(picture: &[u8], width: u32, height: u32) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_pixel_dims(Some(png::PixelDimensions {
        xppu: PIXELS_PER_METRE,
        yppu: PIXELS_PER_METRE,
        unit: png::Unit::Meter,
    }));
    let mut writer = encoder.write_header()?;
    writer.write_image_data(picture)?;
    writer.finish()?;
    Ok(bytes)
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "clamped to a few times any sheet"
)]
fn fine(point: Point) -> (i32, i32) {
    let scale = |value: f64| (value * f64::from(FINE)).round().clamp(-1e5, 1e5) as i32;
    (scale(point.0), scale(point.1))
}

const fn rgb(colour: Colour) -> RGBColor {
    RGBColor(colour.0, colour.1, colour.2)
}

impl Sheet<'_> {
    /// A filled rectangle.
    ///
    /// # Errors
    /// As all shapes: the library cannot draw it.
    pub fn rectangle(&self, from: Point, to: Point, colour: Colour) -> Result<(), String> {
        let shape = Rectangle::new([fine(from), fine(to)], rgb(colour).filled());
        self.area.draw(&shape).map_err(|error| error.to_string())
    }

    /// A filled circle.
    ///
    /// # Errors
    /// As [`Self::rectangle`].
    pub fn disc(&self, centre: Point, radius: f64, colour: Colour) -> Result<(), String> {
        let (radius, _) = fine((radius, 0.0));
        self.area
            .draw(&Circle::new(fine(centre), radius, rgb(colour).filled()))
            .map_err(|error| error.to_string())
    }

    /// A filled polygon.
    ///
    /// # Errors
    /// As [`Self::rectangle`].
    pub fn polygon(&self, corners: &[Point], colour: Colour) -> Result<(), String> {
        let corners: Vec<(i32, i32)> = corners.iter().copied().map(fine).collect();
        self.area
            .draw(&Polygon::new(corners, rgb(colour).filled()))
            .map_err(|error| error.to_string())
    }

    /// A line of several segments. Each segment is a separate quadrangle: one filled outline would show slits where the line folds back.
    ///
    /// # Errors
    /// As [`Self::rectangle`].
    pub fn polyline(&self, points: &[Point], line: Line, colour: Colour) -> Result<(), String> {
        for piece in dashes(points, line.dash) {
            for ends in piece.windows(2) {
                self.segment(ends[0], ends[1], line.width, colour)?;
            }
            // A dash has square ends; a solid line's joins are round.
            let joins = if line.dash.is_empty() {
                &piece[..]
            } else {
                piece.get(1..piece.len() - 1).unwrap_or_default()
            };
            for join in joins {
                self.disc(*join, 0.5 * line.width, colour)?;
            }
        }
        Ok(())
    }

    /// A text, `FINE` times as large as its style says in reference pixels.
    ///
    /// # Errors
    /// As [`Self::rectangle`].
    pub fn text(&self, text: &str, anchor: Point, style: TextStyle<'static>) -> Result<(), String> {
        self.area
            .draw(&Text::new(text.to_owned(), fine(anchor), style))
            .map_err(|error| error.to_string())
    }

    fn segment(&self, from: Point, to: Point, width: f64, colour: Colour) -> Result<(), String> {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let length = dx.hypot(dy);
        if length == 0.0 {
            return Ok(());
        }
        let (nx, ny) = (-dy / length * 0.5 * width, dx / length * 0.5 * width);
        let corners = [
            (from.0 + nx, from.1 + ny),
            (to.0 + nx, to.1 + ny),
            (to.0 - nx, to.1 - ny),
            (from.0 - nx, from.1 - ny),
        ];
        self.polygon(&corners, colour)
    }
}
