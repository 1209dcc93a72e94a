//! Pictures of a report: the logo of the laboratory, photographs of the specimen. In: a path and bytes. Out: a picture whose format is
//! verified. Nothing is drawn here.

use std::io::Cursor;

/// Largest picture \[bytes\].
pub const PICTURE_BYTES: usize = 2 << 20;
/// Most photographs of a report.
pub const MOST_PHOTOS: usize = 8;
/// Largest side of a picture in pixels.
const SIDE: u32 = 10_000;

/// The format of a picture, which the ending of its file states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureKind {
    Png,
    Jpeg,
    Svg,
}

/// A verified picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// The path of the file, relative to the plan's folder.
    pub file: String,
    pub kind: PictureKind,
    pub bytes: Vec<u8>,
}

impl PictureKind {
    /// The format that the ending of a path states; None for any other file.
    #[must_use]
    pub fn of(path: &str) -> Option<Self> {
        let (_, ending) = path.rsplit_once('.')?;
        match ending.to_ascii_lowercase().as_str() {
            "png" => Some(Self::Png),
            "jpg" | "jpeg" => Some(Self::Jpeg),
            "svg" => Some(Self::Svg),
            _ => None,
        }
    }

    /// Whether the file is bytes; a run log holds bytes as base64.
    #[must_use]
    pub const fn is_binary(self) -> bool {
        matches!(self, Self::Png | Self::Jpeg)
    }

    /// The media type.
    #[must_use]
    pub const fn media_type(self) -> &'static str {
        match self {
            Self::Png => "image/png",
            Self::Jpeg => "image/jpeg",
            Self::Svg => "image/svg+xml",
        }
    }

    /// The ending of its files.
    #[must_use]
    pub const fn ending(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Jpeg => "jpg",
            Self::Svg => "svg",
        }
    }

    /// Verifies that bytes have this format.
    ///
    /// # Errors
    /// The reason why they do not.
    pub fn verify(self, bytes: &[u8]) -> Result<(), String> {
        if bytes.len() > PICTURE_BYTES {
            return Err(format!("it is larger than {} MiB", PICTURE_BYTES >> 20));
        }
        let (width, height) = match self {
            Self::Png => png_size(bytes)?,
            Self::Jpeg => jpeg_size(bytes).ok_or("it is not a JPEG image")?,
            Self::Svg => {
                return is_svg(bytes)
                    .then_some(())
                    .ok_or_else(|| "it is not an SVG image".to_owned());
            }
        };
        if width == 0 || height == 0 || width > SIDE || height > SIDE {
            return Err(format!(
                "it has {width} × {height} pixels (limit {SIDE} × {SIDE}, at least 1 × 1)"
            ));
        }
        Ok(())
    }
}

/// Decodes the whole image.
fn png_size(bytes: &[u8]) -> Result<(u32, u32), String> {
    let fault = |error: png::DecodingError| format!("it is not a PNG image: {error}");
    let mut reader = png::Decoder::new(Cursor::new(bytes))
        .read_info()
        .map_err(fault)?;
    let size = reader.info().size();
    if size.0 > SIDE || size.1 > SIDE {
        return Ok(size);
    }
    while reader.next_row().map_err(fault)?.is_some() {}
    Ok(size)
}

/// The size in the frame header; None if a segment before it is damaged, or if the end of the image is missing.
fn jpeg_size(bytes: &[u8]) -> Option<(u32, u32)> {
    let mut rest = bytes.strip_prefix(&[0xff, 0xd8])?;
    if !bytes.windows(2).any(|pair| pair == [0xff, 0xd9]) {
        return None;
    }
    loop {
        let [0xff, marker, after @ ..] = rest else {
            return None;
        };
        let (length, _) = after.split_first_chunk::<2>()?;
        let length = usize::from(u16::from_be_bytes(*length));
        let segment = after.get(2..length)?;
        // SOF0 to SOF15, without the tables and extensions among them.
        if matches!(marker, 0xc0..=0xcf) && !matches!(marker, 0xc4 | 0xc8 | 0xcc) {
            let &[_, h1, h0, w1, w0, ..] = segment else {
                return None;
            };
            return Some((
                u32::from(u16::from_be_bytes([w1, w0])),
                u32::from(u16::from_be_bytes([h1, h0])),
            ));
        }
        rest = after.get(length..)?;
    }
}

fn is_svg(bytes: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return false;
    };
    // An entity could grow without bound.
    text.trim_start_matches('\u{feff}')
        .trim_start()
        .starts_with('<')
        && text.contains("<svg")
        && text.trim_end().ends_with("</svg>")
        && !text.contains("<!ENTITY")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn png() -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 3, 2);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&[7; 18]).unwrap();
        writer.finish().unwrap();
        bytes
    }

    #[test]
    fn the_bytes_of_a_picture_have_the_format_of_its_ending() {
        assert_eq!(PictureKind::of("a/b.JPEG"), Some(PictureKind::Jpeg));
        assert_eq!(PictureKind::of("record.csv"), None);
        let png = png();
        assert_eq!(PictureKind::Png.verify(&png), Ok(()));
        assert!(PictureKind::Png.verify(&png[..png.len() / 2]).is_err());
        assert!(PictureKind::Jpeg.verify(&png).is_err());
        let jpeg = [
            &[0xff, 0xd8, 0xff, 0xe0, 0, 4, 1, 2][..],
            &[0xff, 0xc0, 0, 11, 8, 0, 2, 0, 3, 1, 1, 0x11, 0],
            &[0xff, 0xd9],
        ]
        .concat();
        assert_eq!(PictureKind::Jpeg.verify(&jpeg), Ok(()));
        assert!(PictureKind::Jpeg.verify(&jpeg[..10]).is_err());
        assert_eq!(
            PictureKind::Svg.verify(b"<svg xmlns=\"http://www.w3.org/2000/svg\"></svg>\n"),
            Ok(())
        );
        assert!(PictureKind::Svg.verify(b"text").is_err());
        assert!(
            PictureKind::Svg
                .verify(&vec![b' '; PICTURE_BYTES + 1])
                .unwrap_err()
                .contains("larger than 2 MiB")
        );
    }
}
