//! The mean colour of each square of subpixels. In: subpixels, three bytes each. Out: pixels. It draws nothing.

use std::ops::Range;

/// Subpixels per pixel of the image, in each direction.
pub(crate) const BOX: u32 = 4;
const SIDE: usize = BOX as usize;
/// Bytes of one pixel in a row of subpixels.
const PIECE: usize = 3 * SIDE;
/// Bytes of a row that are compared with white together.
const CHUNK: usize = 16 * PIECE;
const WHITE: [u8; CHUNK] = [255; CHUNK];

/// The mean of each BOX × BOX square of subpixels, which are white afterwards. Most of a figure is white, which is found by comparing chunks
/// of rows.
pub(crate) fn take_average(fine: &mut [u8], fine_width: usize) -> Vec<u8> {
    let row = 3 * fine_width;
    let mut picture = vec![255; fine.len() / (SIDE * SIDE)];
    for (band, line) in fine
        .chunks_exact_mut(row * SIDE)
        .zip(picture.chunks_exact_mut(row / SIDE))
    {
        for start in (0..row).step_by(CHUNK) {
            let end = row.min(start + CHUNK);
            let ranges = [0, 1, 2, 3].map(|y| y * row + start..y * row + end);
            let is_white = |range: &Range<usize>| band[range.clone()] == WHITE[..end - start];
            if ranges.iter().all(is_white) {
                continue;
            }
            let rows = ranges.clone().map(|range| &band[range]);
            for x in (0..end - start).step_by(PIECE) {
                let pixel = (start + x) / SIDE;
                line[pixel..pixel + 3].copy_from_slice(&mean(&rows, x));
            }
            for range in ranges {
                band[range].fill(255);
            }
        }
    }
    picture
}

/// Mean colour of the square that begins at byte `x` of its rows.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn averaging_keeps_a_flat_colour_and_halves_an_edge() {
        let row: Vec<u8> = [0_u8, 0, 255, 255]
            .iter()
            .flat_map(|grey| [*grey; 3])
            .collect();
        assert_eq!(take_average(&mut row.repeat(4), 4), [128, 128, 128]);
        assert_eq!(take_average(&mut [7; 4 * 4 * 3], 4), [7, 7, 7]);
    }

    /// A white image with one dark subpixel, at every position: the mean of its square, and white around it. The subpixels are white again.
    #[test]
    fn no_dark_subpixel_is_lost() {
        let (width, height) = (4 * 37, 8);
        let mut fine = vec![255_u8; 3 * width * height];
        for subpixel in 0..width * height {
            fine[3 * subpixel..3 * subpixel + 3].copy_from_slice(&[0, 95, 255]);
            let picture = take_average(&mut fine, width);
            assert!(fine.iter().all(|colour| *colour == 255));
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
