//! Lines, areas and text as a PNG with two pixels per reference pixel, which is 192 dpi. plotters draws the shapes; their edges are smooth. In:
//! shapes in reference pixels. Out: PNG bytes. It knows no axes.
//!
//! It is a crate of its own for its build: all its work is loops over pixels, and a development build optimises this crate alone.

mod dashes;
mod letters;
mod outlines;
mod shapes;

use std::cell::OnceCell;
use std::fmt::Display;
use std::io::Write as _;

use plotters::coord::Shift;
use plotters::prelude::{
    Circle, DrawingArea, IntoDrawingArea as _, PathElement, Polygon, RGBColor, Rectangle, Text,
};
use plotters::style::{Color as _, TextStyle};
use tiny_skia::{Color, FillRule, Paint, Pixmap, Transform};

use dashes::dashes;
pub use letters::Fonts;
use outlines::{Area, Outlines, UNITS};
pub use shapes::{Colour, Line, Point};

/// Pixels per reference pixel, in each direction.
const PIXELS: u32 = 2;
/// Units of the shapes per reference pixel. A text is drawn this many times as large as its style says.
pub const FINE: u32 = PIXELS * UNITS;
/// 192 dpi in pixels per metre.
const PIXELS_PER_METRE: u32 = 7559;

/// Rows that are filled and compressed together, from top to bottom: the pixels of a whole sheet are 5 MB.
const BAND: u32 = 128;

/// A sheet to draw on.
pub struct Sheet<'a> {
    area: DrawingArea<Outlines<'a>, Shift>,
    /// The first shape that could not be drawn.
    failed: OnceCell<String>,
}

/// A sheet that has been drawn on.
struct Picture {
    /// In pixels.
    width: u32,
    height: u32,
    areas: Vec<Area>,
}

/// Draws on a white sheet of `width × height` reference pixels and encodes it.
///
/// # Errors
/// A shape cannot be drawn, or the picture cannot be encoded.
pub fn png(
    width: u32,
    height: u32,
    fonts: &Fonts,
    paint: impl FnOnce(&Sheet),
) -> Result<Vec<u8>, String> {
    let mut picture = Picture {
        width: width * PIXELS,
        height: height * PIXELS,
        areas: Vec::new(),
    };
    picture.draw(fonts, paint)?;
    let mut band = Pixmap::new(picture.width, BAND).ok_or("a sheet without an area")?;
    picture.encode(&mut band).map_err(|error| error.to_string())
}

impl Picture {
    fn draw(&mut self, fonts: &Fonts, paint: impl FnOnce(&Sheet)) -> Result<(), String> {
        let area = Outlines {
            width: self.width,
            height: self.height,
            fonts,
            areas: &mut self.areas,
        }
        .into_drawing_area();
        let sheet = Sheet {
            area,
            failed: OnceCell::new(),
        };
        paint(&sheet);
        sheet.failed.into_inner().map_or(Ok(()), Err)
    }

    /// As a PNG, filled in the memory of a band.
    fn encode(&self, band: &mut Pixmap) -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        // Large areas of few colours: filters would make the file larger, a higher level takes twice the time for a tenth of the size.
        encoder.set_filter(png::Filter::NoFilter);
        encoder.set_deflate_compression(png::DeflateCompression::Level(2));
        encoder.set_pixel_dims(Some(png::PixelDimensions {
            xppu: PIXELS_PER_METRE,
            yppu: PIXELS_PER_METRE,
            unit: png::Unit::Meter,
        }));
        let mut writer = encoder.write_header()?;
        let mut rows = writer.stream_writer()?;
        let width = self.width as usize;
        let mut line = vec![0; 3 * width];
        for top in (0..self.height).step_by(band.height() as usize) {
            self.fill(top, band);
            let lines = band.pixels().chunks_exact(width);
            // The band was white before its first area: every pixel is opaque.
            for row in lines.take((self.height - top) as usize) {
                for (bytes, pixel) in line.as_chunks_mut::<3>().0.iter_mut().zip(row) {
                    *bytes = [pixel.red(), pixel.green(), pixel.blue()];
                }
                rows.write_all(&line)?;
            }
        }
        rows.finish()?;
        writer.finish()?;
        Ok(bytes)
    }

    /// The rows from `top` on into a band.
    fn fill(&self, top: u32, band: &mut Pixmap) {
        #[expect(clippy::cast_precision_loss, reason = "a sheet has some thousand rows")]
        let (first, end) = (top as f32, (top + band.height()) as f32);
        band.fill(Color::WHITE);
        for Area { outline, colour } in &self.areas {
            let bounds = outline.bounds();
            if bounds.top() < end && bounds.bottom() > first {
                let mut paint = Paint::default();
                paint.set_color(*colour);
                let up = Transform::from_translate(0.0, -first);
                band.fill_path(outline, &paint, FillRule::Winding, up, None);
            }
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "clamped to a few times any sheet"
)]
fn fine(point: Point) -> (i32, i32) {
    let scale = |value: f64| (value * f64::from(FINE)).round().clamp(-1e5, 1e5) as i32;
    (scale(point.0), scale(point.1))
}

/// A length, at least one unit.
fn length(length: f64) -> u32 {
    fine((length, 0.0)).0.max(1).cast_unsigned()
}

const fn rgb(colour: Colour) -> RGBColor {
    RGBColor(colour.0, colour.1, colour.2)
}

impl Sheet<'_> {
    /// A filled rectangle.
    pub fn rectangle(&self, from: Point, to: Point, colour: Colour) {
        let style = rgb(colour).filled();
        self.keep(
            self.area
                .draw(&Rectangle::new([fine(from), fine(to)], style)),
        );
    }

    /// A filled circle.
    pub fn disc(&self, centre: Point, radius: f64, colour: Colour) {
        let style = rgb(colour).filled();
        self.keep(
            self.area
                .draw(&Circle::new(fine(centre), length(radius), style)),
        );
    }

    /// A filled polygon.
    pub fn polygon(&self, corners: &[Point], colour: Colour) {
        let corners: Vec<(i32, i32)> = corners.iter().copied().map(fine).collect();
        self.keep(self.area.draw(&Polygon::new(corners, rgb(colour).filled())));
    }

    /// A line of several segments with round joins.
    pub fn polyline(&self, points: &[Point], line: Line, colour: Colour) {
        let style = rgb(colour).stroke_width(length(line.width));
        for piece in dashes(points, line.dash) {
            let points: Vec<(i32, i32)> = piece.into_iter().map(fine).collect();
            self.keep(self.area.draw(&PathElement::new(points, style)));
        }
    }

    /// A text, `FINE` times as large as its style says in reference pixels.
    pub fn text(&self, text: &str, anchor: Point, style: TextStyle<'static>) {
        self.keep(self.area.draw(&Text::new(text, fine(anchor), style)));
    }

    fn keep<E: Display>(&self, drawn: Result<(), E>) {
        if let Err(error) = drawn {
            // Only the first.
            let _ = self.failed.set(error.to_string());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const INK: Colour = (0, 0, 0);

    /// The red of each pixel of a sheet of 16 × 12 reference pixels.
    fn drawn(paint: impl FnOnce(&Sheet)) -> Vec<Vec<u8>> {
        let fonts = Fonts::new(FONT, FONT).expect("a font");
        let pixels = decoded(&png(16, 12, &fonts, paint).expect("a picture"));
        assert_eq!(pixels.len(), 3 * 32 * 24);
        let reds: Vec<u8> = pixels.iter().copied().step_by(3).collect();
        reds.chunks(32).map(<[u8]>::to_vec).collect()
    }

    fn decoded(bytes: &[u8]) -> Vec<u8> {
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
            .read_info()
            .expect("a PNG");
        let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
        reader.next_frame(&mut pixels).expect("pixels");
        pixels
    }

    const FONT: &[u8] = include_bytes!("../document/fonts/DejaVuSans.ttf");

    /// An edge in the middle of a pixel halves its colour; the corners may come in any order.
    #[test]
    fn an_edge_is_smooth() {
        for corners in [[(1.0, 2.0), (4.25, 5.0)], [(4.25, 5.0), (1.0, 2.0)]] {
            let rows = drawn(|sheet| sheet.rectangle(corners[0], corners[1], INK));
            for (y, row) in rows.iter().enumerate() {
                for (x, red) in row.iter().enumerate() {
                    let inside = (4..10).contains(&y);
                    let expected = match x {
                        2..8 if inside => 0..=0,
                        8 if inside => 120..=135,
                        _ => 255..=255,
                    };
                    assert!(expected.contains(red), "{x}, {y}: {red}");
                }
            }
        }
    }

    /// A line that folds back on itself is as dark as a single one, and as wide.
    #[test]
    fn a_line_that_folds_back_has_no_slit() {
        let line = Line {
            width: 2.0,
            dash: &[],
        };
        let there_and_back = [(2.0, 6.0), (14.0, 6.0), (2.0, 6.0), (14.0, 6.0)];
        let rows = drawn(|sheet| sheet.polyline(&there_and_back, line, INK));
        for (y, row) in rows.iter().enumerate() {
            let expected = if (10..14).contains(&y) { 0 } else { 255 };
            assert!(row[6..26].iter().all(|red| *red == expected), "row {y}");
        }
    }

    /// Its ink is where its anchor is, and a rotated text is the same picture, rotated.
    #[test]
    fn a_text_is_placed_by_its_anchor() {
        use plotters::style::text_anchor::{HPos, Pos, VPos};
        use plotters::style::{FontStyle, FontTransform, IntoFont as _, register_font};
        assert!(register_font("raster", FontStyle::Normal, FONT).is_ok());
        let style = |turned| {
            let mut font = ("raster", 8.0 * f64::from(FINE), FontStyle::Normal).into_font();
            if turned {
                font = font.transform(FontTransform::Rotate270);
            }
            TextStyle {
                font,
                color: plotters_backend::BackendColor {
                    alpha: 1.0,
                    rgb: INK,
                },
                pos: Pos::new(HPos::Left, VPos::Top),
            }
        };
        let ink = |rows: &[Vec<u8>]| {
            let dark = |(x, y): (usize, usize)| rows[y][x] < 128;
            let places = (0..24).flat_map(|y| (0..32).map(move |x| (x, y)));
            let places: Vec<_> = places.filter(|place| dark(*place)).collect();
            let range = |of: fn(&(usize, usize)) -> usize| {
                let numbers = places.iter().map(of);
                (numbers.clone().min(), numbers.max())
            };
            (range(|place| place.0), range(|place| place.1))
        };
        // The em is 8 · 2048/2384 reference pixels, 13.7 pixels. A capital I is a bar from 201 to 401 units of 2048 to the right and up to 1493
        // above the baseline, which is half the size, 8 pixels, below the anchor.
        let (across, down) = ink(&drawn(|sheet| sheet.text("I", (3.0, 2.0), style(false))));
        assert_eq!((across, down), ((Some(7), Some(8)), (Some(2), Some(11))));
        let turned = ink(&drawn(|sheet| sheet.text("I", (3.0, 9.0), style(true))));
        assert_eq!(turned, ((Some(4), Some(13)), (Some(15), Some(16))));
    }

    /// Lines of all slopes, dashes, discs and areas, at the edges too.
    #[test]
    fn bands_together_are_the_sheet() {
        let fonts = Fonts::new(FONT, FONT).expect("a font");
        let mut picture = Picture {
            width: 128,
            height: 144,
            areas: Vec::new(),
        };
        let painted = picture.draw(&fonts, |sheet| {
            sheet.rectangle((-3.0, 5.0), (60.0, 21.3), (232, 232, 232));
            let corners = [(1.0, 70.0), (33.3, 2.2), (58.0, 44.0), (20.0, 30.0)];
            sheet.polygon(&corners, (0, 95, 255));
            for step in 0..12 {
                let (x, y) = (f64::from(step) * 5.7, f64::from(step % 5) * 16.3);
                let line = |dash| Line { width: 1.8, dash };
                sheet.polyline(&[(30.0, 36.0), (x, y), (y, x)], line(&[]), (213, 94, 0));
                sheet.polyline(&[(x, y), (64.0 - x, 72.0)], line(&[4.0, 2.0]), INK);
                sheet.disc((x, y), 3.2, (0, 158, 115));
            }
        });
        assert_eq!((painted, picture.areas.len() > 50), (Ok(()), true));
        let in_bands = |rows| {
            let mut band = Pixmap::new(128, rows).expect("pixels");
            picture.encode(&mut band).expect("a picture")
        };
        let whole = decoded(&in_bands(144));
        for rows in [1, 7, 16, 100, 200] {
            let differences = decoded(&in_bands(rows))
                .into_iter()
                .zip(&whole)
                .map(|(in_bands, whole)| in_bands.abs_diff(*whole))
                .filter(|difference| *difference > 0)
                .collect::<Vec<u8>>();
            // An edge is cut where a band ends and rounded there: one of the four samples of a pixel, one above the other, may change.
            assert!(differences.len() < whole.len() / 100, "{rows}");
            assert!(differences.iter().all(|levels| *levels <= 64), "{rows}");
        }
    }

    #[test]
    fn a_text_in_an_unknown_font_is_an_error() {
        let style = TextStyle::from(("no such font", 10.0));
        let fonts = Fonts::new(FONT, FONT).expect("a font");
        let failed = png(16, 12, &fonts, |sheet| {
            sheet.text("I", (1.0, 1.0), style);
        });
        assert!(failed.is_err());
    }
}
