//! A load cell on an HX711: a sketch that sends one raw count a line, unsolicited. In: a line without its ending. Out: the
//! count. It knows neither the cell nor its calibration.

use crate::controllers::number;

/// Lowest and highest count of the converter's 24 bits: at either it is saturated.
pub const RAILS: (i64, i64) = (-8_388_608, 8_388_607);

/// The count of a line. None for a line that is not a count of 24 bits.
#[must_use]
pub fn count(line: &[u8]) -> Option<i64> {
    // A sketch sends no `+`, and no more digits than a number of 24 bits has.
    let plain = line.first() != Some(&b'+') && line.len() <= "-8388608".len();
    plain
        .then(|| number::whole(line))
        .flatten()
        .filter(|count| (RAILS.0..=RAILS.1).contains(count))
}

#[must_use]
pub const fn is_saturated(count: i64) -> bool {
    count <= RAILS.0 || count >= RAILS.1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_a_count_of_24_bits_or_nothing() {
        assert_eq!(count(b"812344"), Some(812_344));
        assert_eq!(count(b"-8388608"), Some(RAILS.0));
        for line in [
            "",
            "nan",
            "+12",
            "8388608",
            "-8388609",
            "12.0",
            "1 2",
            "12,5",
            "OVL",
            "0x10",
            "12\0",
            "000000012",
            "--1",
        ] {
            assert_eq!(count(line.as_bytes()), None, "{line}");
        }
    }

    #[test]
    fn the_rails_are_saturated() {
        assert!(is_saturated(RAILS.0) && is_saturated(RAILS.1));
        assert!(!is_saturated(RAILS.0 + 1) && !is_saturated(RAILS.1 - 1));
    }
}
