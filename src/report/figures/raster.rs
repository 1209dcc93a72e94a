//! A vector drawing as PNG, with two pixels for each reference pixel, which is 192 dpi. In: SVG. Out: PNG bytes. The letters are those of the
//! fonts in the program.

use std::cell::RefCell;
use std::fmt::Display;
use std::sync::{Arc, LazyLock};

use resvg::tiny_skia::{Color, PixmapMut, PixmapRef, Transform};
use resvg::usvg::fontdb::{Database, Source};
use resvg::usvg::{Options, Tree};

use super::super::document::fonts::{SANS, SANS_BOLD};

/// Pixels per reference pixel, in each direction.
const SCALE: u16 = 2;
/// 192 dpi in pixels per metre.
const PIXELS_PER_METRE: u32 = 7559;

static FONTS: LazyLock<Arc<Database>> = LazyLock::new(|| {
    let mut fonts = Database::new();
    for font in [SANS, SANS_BOLD] {
        fonts.load_font_source(Source::Binary(Arc::new(font)));
    }
    Arc::new(fonts)
});

thread_local! {
    /// The pixels of the last sheet of this thread: the system would give new memory page by page.
    static PIXELS: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// The drawing on a white sheet.
///
/// # Errors
/// It is no SVG, or the picture cannot be encoded.
pub(crate) fn png(svg: &str) -> Result<Vec<u8>, String> {
    let options = Options {
        fontdb: Arc::clone(&FONTS),
        ..Options::default()
    };
    let drawing = Tree::from_str(svg, &options).map_err(error_text)?;
    let size = drawing
        .size()
        .to_int_size()
        .scale_by(f32::from(SCALE))
        .ok_or("a sheet without an area")?;
    let bytes = 4 * size.width() as usize * size.height() as usize;
    let scale = Transform::from_scale(f32::from(SCALE), f32::from(SCALE));
    PIXELS.with_borrow_mut(|pixels| {
        if pixels.len() < bytes {
            // Memory that the system gives is zero already.
            *pixels = vec![0; bytes];
        }
        let mut sheet = PixmapMut::from_bytes(&mut pixels[..bytes], size.width(), size.height())
            .ok_or("a sheet without an area")?;
        sheet.fill(Color::WHITE);
        resvg::render(&drawing, scale, &mut sheet);
        encoded(sheet.as_ref()).map_err(error_text)
    })
}

fn error_text(error: impl Display) -> String {
    error.to_string()
}

fn encoded(sheet: PixmapRef<'_>) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, sheet.width(), sheet.height());
    // The sheet was white before its first shape: every pixel is opaque, and its colour is not multiplied by anything.
    encoder.set_color(png::ColorType::Rgba);
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
    writer.write_image_data(sheet.data())?;
    writer.finish()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use plotters::style::text_anchor::{HPos, VPos};

    use super::super::canvas::{Anchor, Canvas, Lettering, svg};
    use super::super::chart::{Colour, LineStyle};
    use super::*;

    const INK: Colour = (0, 0, 0);

    /// The red of each pixel of a sheet of 16 × 12 reference pixels.
    fn drawn(paint: impl FnOnce(&Canvas)) -> Vec<Vec<u8>> {
        let bytes = png(&svg(16, 12, paint)).expect("a picture");
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
            .read_info()
            .expect("a PNG");
        let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
        reader.next_frame(&mut pixels).expect("pixels");
        assert_eq!(pixels.len(), 4 * 32 * 24);
        assert!(pixels.chunks(4).all(|pixel| pixel[3] == 255), "opaque");
        let reds: Vec<u8> = pixels.iter().copied().step_by(4).collect();
        reds.chunks(32).map(<[u8]>::to_vec).collect()
    }

    /// A line that folds back on itself is as dark as a single one, and as wide.
    #[test]
    fn a_line_that_folds_back_has_no_slit() {
        let line = LineStyle {
            width: 2.0,
            dash: &[],
        };
        let there_and_back = [(2.0, 6.0), (14.0, 6.0), (2.0, 6.0), (14.0, 6.0)];
        let rows = drawn(|canvas| canvas.polyline(&there_and_back, line, INK));
        for (y, row) in rows.iter().enumerate() {
            let expected = if (10..14).contains(&y) { 0 } else { 255 };
            assert!(row[6..26].iter().all(|red| *red == expected), "row {y}");
        }
    }

    /// Its ink is where its anchor is, and a rotated text is the same picture, rotated.
    #[test]
    fn a_text_is_placed_by_its_anchor() {
        let style = |upright| Lettering {
            size: 8.0,
            bold: false,
            colour: INK,
            anchor: Anchor {
                horizontal: HPos::Left,
                vertical: VPos::Top,
            },
            upright,
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
        let (across, down) = ink(&drawn(|canvas| canvas.text("I", (3.0, 2.0), &style(false))));
        assert_eq!((across, down), ((Some(7), Some(8)), (Some(2), Some(11))));
        let turned = ink(&drawn(|canvas| canvas.text("I", (3.0, 9.0), &style(true))));
        assert_eq!(turned, ((Some(4), Some(13)), (Some(15), Some(16))));
    }
}
