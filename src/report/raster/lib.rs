//! Lines, areas and text as a PNG: shapes are drawn with 8 × 8 subpixels per reference pixel and averaged to 2 × 2, which is 192 dpi. In:
//! shapes in reference pixels. Out: PNG bytes. It knows no axes.
//!
//! It is a crate of its own for its build: all its work is loops over pixels, and a development build optimises this crate alone.

mod average;
mod band;
mod dashes;
mod shapes;

use std::cell::RefCell;
use std::ops::Range;

use plotters::coord::Shift;
use plotters::prelude::{
    BitMapBackend, Circle, DrawingArea, IntoDrawingArea as _, Polygon, RGBColor, Rectangle, Text,
};
use plotters::style::text_anchor::VPos;
use plotters::style::{Color as _, FontTransform, TextStyle};

use average::{BOX, take_average};
use band::Band;
use dashes::dashes;
pub use shapes::{Colour, Line, Point};

/// Subpixels per reference pixel, in each direction.
pub const FINE: u32 = 8;
/// Subpixels drawn together, from top to bottom: those of a whole sheet are 60 MB.
const BAND: u32 = 32 * FINE;
/// 192 dpi in pixels per metre.
const PIXELS_PER_METRE: u32 = 7559;

/// A sheet to draw on: it keeps its shapes.
#[derive(Default)]
pub struct Sheet {
    shapes: RefCell<Vec<Drawn>>,
}

struct Drawn {
    shape: Shape,
    /// Its rows of subpixels, or more.
    rows: Range<i32>,
}

/// In subpixels.
enum Shape {
    Rectangle([(i32, i32); 2], RGBColor),
    Disc((i32, i32), i32, RGBColor),
    Polygon(Vec<(i32, i32)>, RGBColor),
    Text(String, (i32, i32), Box<TextStyle<'static>>),
}

/// Draws on a white sheet of `width × height` reference pixels and encodes it.
///
/// # Errors
/// A shape cannot be drawn, or the picture cannot be encoded.
pub fn png(width: u32, height: u32, paint: impl FnOnce(&Sheet)) -> Result<Vec<u8>, String> {
    let sheet = Sheet::default();
    paint(&sheet);
    let picture = picture(&sheet, width, height, BAND)?;
    let (width, height) = (width * FINE / BOX, height * FINE / BOX);
    encode(&picture, width, height).map_err(|error| error.to_string())
}

/// The pixels of a sheet, drawn in bands of so many subpixels.
fn picture(sheet: &Sheet, width: u32, height: u32, band: u32) -> Result<Vec<u8>, String> {
    let (width, height) = (width * FINE, height * FINE);
    let row = width as usize * 3;
    let mut fine = vec![255_u8; row * band as usize];
    let mut picture = Vec::with_capacity(row * height as usize / (BOX * BOX) as usize);
    for top in (0..height).step_by(band as usize) {
        let rows = band.min(height - top);
        let part = &mut fine[..row * rows as usize];
        let bottom = (top + rows).cast_signed();
        let top = top.cast_signed();
        let area = Band {
            rows: BitMapBackend::with_buffer(part, (width, rows)),
            top,
            sheet: (width, height),
        }
        .into_drawing_area();
        for Drawn { shape, rows } in sheet.shapes.borrow().iter() {
            if rows.start < bottom && rows.end > top {
                shape.draw(&area)?;
            }
        }
        area.present().map_err(|error| error.to_string())?;
        drop(area);
        picture.extend(take_average(part, width as usize));
    }
    Ok(picture)
}

impl Shape {
    fn draw(&self, area: &DrawingArea<Band<'_>, Shift>) -> Result<(), String> {
        let drawn = match self {
            Self::Rectangle(corners, colour) => {
                area.draw(&Rectangle::new(*corners, colour.filled()))
            }
            Self::Disc(centre, radius, colour) => {
                area.draw(&Circle::new(*centre, *radius, colour.filled()))
            }
            Self::Polygon(corners, colour) => {
                area.draw(&Polygon::new(corners.clone(), colour.filled()))
            }
            Self::Text(text, anchor, style) => {
                area.draw(&Text::new(text.as_str(), *anchor, style.as_ref().clone()))
            }
        };
        drawn.map_err(|error| error.to_string())
    }
}

fn encode(picture: &[u8], width: u32, height: u32) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    // Large areas of few colours: filters would take longer than the compression, and make the file larger.
    encoder.set_filter(png::Filter::NoFilter);
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

impl Sheet {
    fn add(&self, shape: Shape, rows: Range<i32>) {
        self.shapes.borrow_mut().push(Drawn { shape, rows });
    }

    /// A filled rectangle.
    pub fn rectangle(&self, from: Point, to: Point, colour: Colour) {
        let corners = [fine(from), fine(to)];
        let rows = rows_of(&corners);
        self.add(Shape::Rectangle(corners, rgb(colour)), rows);
    }

    /// A filled circle.
    pub fn disc(&self, centre: Point, radius: f64, colour: Colour) {
        let (centre, (radius, _)) = (fine(centre), fine((radius, 0.0)));
        let rows = centre.1 - radius - 1..centre.1 + radius + 2;
        self.add(Shape::Disc(centre, radius, rgb(colour)), rows);
    }

    /// A filled polygon.
    pub fn polygon(&self, corners: &[Point], colour: Colour) {
        let corners: Vec<(i32, i32)> = corners.iter().copied().map(fine).collect();
        let rows = rows_of(&corners);
        self.add(Shape::Polygon(corners, rgb(colour)), rows);
    }

    /// A line of several segments. Each segment is a separate quadrangle: one filled outline would show slits where the line folds back.
    pub fn polyline(&self, points: &[Point], line: Line, colour: Colour) {
        for piece in dashes(points, line.dash) {
            for ends in piece.windows(2) {
                self.segment(ends[0], ends[1], line.width, colour);
            }
            // A dash has square ends; a solid line's joins are round.
            let joins = if line.dash.is_empty() {
                &piece[..]
            } else {
                piece.get(1..piece.len() - 1).unwrap_or_default()
            };
            for join in joins {
                self.disc(*join, 0.5 * line.width, colour);
            }
        }
    }

    /// A text, `FINE` times as large as its style says in reference pixels.
    pub fn text(&self, text: &str, anchor: Point, style: TextStyle<'static>) {
        let anchor = fine(anchor);
        let size = style.font.get_size();
        // A line is at most 1.3 times as high as the size of its font, a letter at most as wide; a little more at each end.
        let (above, below) = match (style.font.get_transform(), style.pos.v_pos) {
            (FontTransform::None, VPos::Top) => (0.3, 1.6),
            (FontTransform::None, VPos::Center) => (1.0, 1.0),
            (FontTransform::None, VPos::Bottom) => (1.6, 0.3),
            _ => {
                #[expect(clippy::cast_precision_loss, reason = "a text of a figure")]
                let letters = text.chars().count() as f64 + 1.0;
                (letters, letters)
            }
        };
        #[expect(clippy::cast_possible_truncation, reason = "a text of a figure")]
        let rows_in = |sizes: f64| (sizes * size).ceil() as i32;
        let rows = anchor.1 - rows_in(above)..anchor.1 + rows_in(below);
        self.add(Shape::Text(text.to_owned(), anchor, Box::new(style)), rows);
    }

    fn segment(&self, from: Point, to: Point, width: f64, colour: Colour) {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let length = dx.hypot(dy);
        if length == 0.0 {
            return;
        }
        let (nx, ny) = (-dy / length * 0.5 * width, dx / length * 0.5 * width);
        let corners = [
            (from.0 + nx, from.1 + ny),
            (to.0 + nx, to.1 + ny),
            (to.0 - nx, to.1 - ny),
            (from.0 - nx, from.1 - ny),
        ];
        self.polygon(&corners, colour);
    }
}

/// The rows of some corners, and one more at each end.
fn rows_of(corners: &[(i32, i32)]) -> Range<i32> {
    let rows = corners.iter().map(|corner| corner.1);
    let (least, largest) = (rows.clone().min(), rows.max());
    least.unwrap_or_default() - 1..largest.unwrap_or_default() + 2
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines of all slopes, dashes, discs and areas, at the edges too.
    #[test]
    fn bands_together_are_the_sheet() {
        let sheet = Sheet::default();
        sheet.rectangle((-3.0, 5.0), (60.0, 21.3), (232, 232, 232));
        sheet.polygon(
            &[(1.0, 70.0), (33.3, 2.2), (58.0, 44.0), (20.0, 30.0)],
            (0, 95, 255),
        );
        for step in 0..12 {
            let (x, y) = (f64::from(step) * 5.7, f64::from(step % 5) * 16.3);
            let line = |dash| Line { width: 1.8, dash };
            sheet.polyline(&[(30.0, 36.0), (x, y), (y, x)], line(&[]), (213, 94, 0));
            sheet.polyline(&[(x, y), (64.0 - x, 72.0)], line(&[4.0, 2.0]), (40, 40, 40));
            sheet.disc((x, y), 3.2, (0, 158, 115));
        }
        let whole = picture(&sheet, 64, 72, 72 * FINE).unwrap();
        assert!(whole.iter().any(|colour| *colour != 255));
        for band in [8, 16, 256, 400] {
            assert!(picture(&sheet, 64, 72, band).unwrap() == whole, "{band}");
        }
    }
}
