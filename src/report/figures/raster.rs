//! The raster canvas: shapes are drawn with 8 × 8 subpixels per reference pixel and averaged to 2 × 2, which is 192 dpi. In:
//! shapes in reference pixels. Out: PNG bytes. It knows no axes.

use plotters::prelude::{
    BitMapBackend, Circle, DrawingArea, IntoDrawingArea as _, Polygon, RGBColor, Rectangle, Text,
};
use plotters::style::Color as _;
use plotters::style::text_anchor::VPos;

use super::canvas::{Canvas, Lettering, Point};
use super::chart::{Colour, Line};

/// Subpixels per reference pixel, in each direction.
const FINE: u32 = 8;
/// Subpixels per pixel of the image, in each direction.
const BOX: u32 = 4;
const SIDE: usize = BOX as usize;
/// Bytes of one pixel in a row of subpixels.
const PIECE: usize = 3 * SIDE;
/// Bytes of a row that are compared with white together.
const CHUNK: usize = 16 * PIECE;
/// 192 dpi in pixels per metre.
const PIXELS_PER_METRE: u32 = 7559;

struct Raster<'a> {
    area: DrawingArea<BitMapBackend<'a>, plotters::coord::Shift>,
}

/// Draws on a white sheet of `width × height` reference pixels and encodes it.
pub(super) fn png(
    width: u32,
    height: u32,
    paint: impl FnOnce(&dyn Canvas) -> Result<(), String>,
) -> Result<Vec<u8>, String> {
    let (fine_width, fine_height) = (width * FINE, height * FINE);
    let mut fine = vec![255_u8; fine_width as usize * fine_height as usize * 3];
    {
        let area =
            BitMapBackend::with_buffer(&mut fine, (fine_width, fine_height)).into_drawing_area();
        let canvas = Raster { area };
        paint(&canvas)?;
        canvas.area.present().map_err(|error| error.to_string())?;
    }
    encode(
        &average(&fine, fine_width as usize),
        fine_width / BOX,
        fine_height / BOX,
    )
    .map_err(|error| error.to_string())
}

/// The mean of each BOX × BOX square of subpixels. Most of a figure is white, which is found by comparing chunks of rows.
fn average(fine: &[u8], fine_width: usize) -> Vec<u8> {
    let row = 3 * fine_width;
    let white = vec![255_u8; row];
    let mut picture = vec![255; fine.len() / (SIDE * SIDE)];
    for (band, line) in fine
        .chunks_exact(row * SIDE)
        .zip(picture.chunks_exact_mut(row / SIDE))
    {
        let rows = [0, 1, 2, 3].map(|y| &band[y * row..(y + 1) * row]);
        for start in (0..row).step_by(CHUNK) {
            let end = row.min(start + CHUNK);
            if rows.iter().all(|row| row[start..end] == white[start..end]) {
                continue;
            }
            for x in (start..end).step_by(PIECE) {
                line[x / SIDE..x / SIDE + 3].copy_from_slice(&mean(&rows, x));
            }
        }
    }
    picture
}

/// Mean colour of the square that begins at byte `x` of its rows. Plain loops: an unoptimised build spends much of its time here.
fn mean(rows: &[&[u8]; SIDE], x: usize) -> [u8; 3] {
    let mut colour = [0; 3];
    for (channel, mean) in colour.iter_mut().enumerate() {
        let first = x + channel;
        let mut sum = BOX * BOX / 2;
        for row in rows {
            sum += u32::from(row[first])
                + u32::from(row[first + 3])
                + u32::from(row[first + 6])
                + u32::from(row[first + 9]);
        }
        // The mean of bytes is a byte.
        *mean = (sum / (BOX * BOX)).to_le_bytes()[0];
    }
    colour
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

impl Canvas for Raster<'_> {
    fn rectangle(&self, from: Point, to: Point, colour: Colour) -> Result<(), String> {
        let shape = Rectangle::new([fine(from), fine(to)], rgb(colour).filled());
        self.area.draw(&shape).map_err(|error| error.to_string())
    }

    fn disc(&self, centre: Point, radius: f64, colour: Colour) -> Result<(), String> {
        let (radius, _) = fine((radius, 0.0));
        self.area
            .draw(&Circle::new(fine(centre), radius, rgb(colour).filled()))
            .map_err(|error| error.to_string())
    }

    /// Each segment is a separate quadrangle: one filled outline would show slits where the line folds back.
    fn polyline(&self, points: &[Point], line: Line, colour: Colour) -> Result<(), String> {
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

    fn text(&self, text: &str, anchor: Point, style: &Lettering) -> Result<(), String> {
        // The box of the font is taller below its letters than above: a centred text is lowered to look centred.
        let is_lowered = matches!(style.anchor.vertical, VPos::Center) && !style.upright;
        let anchor = if is_lowered {
            (anchor.0, anchor.1 + 0.17 * style.size)
        } else {
            anchor
        };
        let style = style.scaled(f64::from(FINE));
        self.area
            .draw(&Text::new(
                crate::text::glyphs::shown(text).into_owned(),
                fine(anchor),
                style,
            ))
            .map_err(|error| error.to_string())
    }
}

impl Raster<'_> {
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
        self.area
            .draw(&Polygon::new(corners.map(fine), rgb(colour).filled()))
            .map_err(|error| error.to_string())
    }
}

/// The dashes of a line along its length; a solid line is one piece.
fn dashes(points: &[Point], pattern: &[f64]) -> Vec<Vec<Point>> {
    let Some(&first) = points.first() else {
        return Vec::new();
    };
    if pattern.is_empty() {
        return vec![points.to_vec()];
    }
    let (mut pieces, mut piece, mut part, mut left) = (Vec::new(), vec![first], 0, pattern[0]);
    for ends in points.windows(2) {
        let (from, to) = (ends[0], ends[1]);
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        let mut walked = 0.0;
        while length - walked > left {
            walked += left;
            let end = (
                from.0 + (to.0 - from.0) * walked / length,
                from.1 + (to.1 - from.1) * walked / length,
            );
            if part % 2 == 0 {
                piece.push(end);
                pieces.push(std::mem::take(&mut piece));
            } else {
                piece = vec![end];
            }
            part = (part + 1) % pattern.len();
            left = pattern[part];
        }
        left -= length - walked;
        if part % 2 == 0 {
            piece.push(to);
        }
    }
    if piece.len() > 1 {
        pieces.push(piece);
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_follow_the_length_of_the_line_round_a_corner() {
        let pieces = dashes(&[(0.0, 0.0), (3.0, 0.0), (3.0, 10.0)], &[4.0, 2.0]);
        assert_eq!(
            pieces,
            [
                vec![(0.0, 0.0), (3.0, 0.0), (3.0, 1.0)],
                vec![(3.0, 3.0), (3.0, 7.0)],
                vec![(3.0, 9.0), (3.0, 10.0)]
            ]
        );
    }

    #[test]
    fn averaging_keeps_a_flat_colour_and_halves_an_edge() {
        let row: Vec<u8> = [0_u8, 0, 255, 255]
            .iter()
            .flat_map(|grey| [*grey; 3])
            .collect();
        assert_eq!(average(&row.repeat(4), 4), [128, 128, 128]);
        assert_eq!(average(&[7; 4 * 4 * 3], 4), [7, 7, 7]);
    }

    /// A white image with one dark subpixel, at every position: the mean of its square, and white around it.
    #[test]
    fn no_dark_subpixel_is_lost() {
        let (width, height) = (4 * 37, 8);
        for subpixel in 0..width * height {
            let mut fine = vec![255_u8; 3 * width * height];
            fine[3 * subpixel..3 * subpixel + 3].copy_from_slice(&[0, 95, 255]);
            let picture = average(&fine, width);
            let square = (subpixel / width / 4) * (width / 4) + subpixel % width / 4;
            for (index, colour) in picture.chunks_exact(3).enumerate() {
                assert_eq!(
                    colour,
                    if index == square {
                        [239, 245, 255]
                    } else {
                        [255; 3]
                    },
                    "subpixel {subpixel}, square {index}"
                );
            }
        }
    }
}
