//! Numbers on the wire, in both directions. In: the bytes of one field. Out: its number, or nothing; and the text of a
//! number to be sent. It knows no unit and no protocol. Forms that `f64` accepts beyond plain decimals (nan, inf, `1e400`,
//! `.5`, `5.`) are not numbers here: an invalid reading must never become a number.

use crate::safety::failpoint::{Guarding, on};

/// Longest field that can be a number, bytes.
const LONGEST: usize = 40;

/// Only digits: a count or the number of a move.
#[must_use]
pub fn count(field: &[u8]) -> Option<u64> {
    (is_short(field) && all_digits(field))
        .then(|| ascii_text(field)?.parse().ok())
        .flatten()
}

/// A whole number with an optional sign.
#[must_use]
pub fn whole(field: &[u8]) -> Option<i64> {
    (is_short(field) && all_digits(unsigned(field)))
        .then(|| ascii_text(field)?.parse().ok())
        .flatten()
}

/// A decimal with an optional sign and an optional fraction.
#[must_use]
pub fn fixed(field: &[u8]) -> Option<f64> {
    if !on(Guarding::Invalid) {
        return ascii_text(field)?.parse().ok();
    }
    (is_short(field) && is_fixed(unsigned(field)))
        .then(|| finite(field))
        .flatten()
}

/// A decimal with an optional exponent.
#[must_use]
pub fn scientific(field: &[u8]) -> Option<f64> {
    let Some(at) = field.iter().position(|byte| matches!(byte, b'e' | b'E')) else {
        return fixed(field);
    };
    let (mantissa, exponent) = (unsigned(&field[..at]), unsigned(&field[at + 1..]));
    if !is_short(field) || !is_fixed(mantissa) || !all_digits(exponent) {
        return None;
    }
    // A number that is too small for a double would become zero.
    let vanished =
        |value: f64| value == 0.0 && mantissa.iter().any(|byte| matches!(byte, b'1'..=b'9'));
    finite(field).filter(|value| !vanished(*value))
}

/// A field of exactly `digits` upper-case hexadecimal digits, at most 4.
#[must_use]
pub fn hexadecimal(field: &[u8], digits: usize) -> Option<u16> {
    let fits = field.len() == digits
        && digits <= 4
        && field
            .iter()
            .all(|byte| matches!(byte, b'0'..=b'9' | b'A'..=b'F'));
    fits.then(|| u16::from_str_radix(ascii_text(field)?, 16).ok())
        .flatten()
}

/// The text of a number with this many decimals, never `-0`. Nothing for a value that is not finite or does not fit.
#[must_use]
pub fn write(value: f64, decimals: usize) -> Option<String> {
    if !value.is_finite() {
        return None;
    }
    let written = format!("{value:.decimals$}");
    let nothing = written
        .bytes()
        .all(|byte| matches!(byte, b'-' | b'0' | b'.'));
    let written = if nothing {
        written.trim_start_matches('-').to_owned()
    } else {
        written
    };
    is_short(written.as_bytes()).then_some(written)
}

/// The value of a text that was written for `meant` × `scale`, in the unit of `meant`. A difference that is only the
/// rounding of the unit conversion is ignored.
#[must_use]
pub fn read_back(written: &str, scale: f64, meant: f64) -> Option<f64> {
    let decoded = fixed(written.as_bytes())? / scale;
    let rounding = 4.0 * f64::EPSILON * meant.abs();
    Some(if (decoded - meant).abs() <= rounding {
        meant
    } else {
        decoded
    })
}

fn is_short(field: &[u8]) -> bool {
    (1..=LONGEST).contains(&field.len())
}

fn all_digits(field: &[u8]) -> bool {
    !field.is_empty() && field.iter().all(u8::is_ascii_digit)
}

/// The field without its single sign.
fn unsigned(field: &[u8]) -> &[u8] {
    match field {
        [b'+' | b'-', rest @ ..] => rest,
        _ => field,
    }
}

fn is_fixed(unsigned: &[u8]) -> bool {
    match unsigned.iter().position(|byte| *byte == b'.') {
        None => all_digits(unsigned),
        Some(at) => all_digits(&unsigned[..at]) && all_digits(&unsigned[at + 1..]),
    }
}

fn ascii_text(field: &[u8]) -> Option<&str> {
    std::str::from_utf8(field).ok()
}

fn finite(field: &[u8]) -> Option<f64> {
    ascii_text(field)?
        .parse()
        .ok()
        .filter(|value: &f64| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Specification of reliability, row 20, and the numbers of the bad-input corpus.
    const NEVER: [&str; 37] = [
        "", " ", "nan", "NaN", "-nan", "inf", "-inf", "+INF", "infinity", "1e400", "-1e400",
        "1e-400", "OVL", "OL", "1,5", "1_000", "0x10", ".5", "5.", "1e", "1e+", "e5", "--1", "+-1",
        "- 1", "1 2", " 1", "1 ", "1\0", "\u{661}", "1.2.3", "1.5e3.0", "1-", "-", "+", ".", "1\r",
    ];

    #[test]
    fn what_is_no_decimal_is_no_number() {
        for text in NEVER {
            let field = text.as_bytes();
            assert_eq!((fixed(field), scientific(field)), (None, None), "{text:?}");
            assert_eq!((whole(field), count(field)), (None, None), "{text:?}");
        }
        let long = "1".repeat(41);
        assert_eq!((fixed(long.as_bytes()), scientific(b"1\xff")), (None, None));
    }

    #[test]
    fn each_form_takes_its_own_and_no_more() {
        assert_eq!(fixed(b"-2000.000"), Some(-2000.0));
        assert_eq!(fixed(b"+0001234"), Some(1234.0));
        assert_eq!(fixed(b"1e3"), None);
        assert_eq!(scientific(b"+1.234500E-03"), Some(1.2345e-3));
        assert_eq!(scientific(b"-4e2"), Some(-400.0));
        assert_eq!(scientific(b"9.91E37"), Some(9.91e37));
        assert_eq!(scientific(b"0e-400"), Some(0.0));
        assert_eq!(whole(b"-8388608"), Some(-8_388_608));
        assert_eq!(
            (whole(b"1.0"), whole(b"99999999999999999999")),
            (None, None)
        );
        assert_eq!(
            (count(b"42"), count(b"+42"), count(b"-1")),
            (Some(42), None, None)
        );
        assert_eq!(
            (
                hexadecimal(b"7F3A", 4),
                hexadecimal(b"7f3a", 4),
                hexadecimal(b"+F3A", 4)
            ),
            (Some(0x7f3a), None, None)
        );
        assert_eq!(
            (hexadecimal(b"7F3", 4), hexadecimal(b"12345", 5)),
            (None, None)
        );
    }

    #[test]
    fn a_number_is_written_as_it_will_be_read() {
        assert_eq!(write(-0.000_000_4, 6).as_deref(), Some("0.000000"));
        assert_eq!(write(-1.25, 6).as_deref(), Some("-1.250000"));
        assert_eq!(
            (write(f64::NAN, 3), write(f64::INFINITY, 3), write(1e40, 6)),
            (None, None, None)
        );
        assert_eq!(read_back("25.000000", 1e3, 0.025), Some(0.025));
        assert_eq!(
            read_back("1.000", 1e3, 0.000_999_6),
            Some(0.001),
            "what was rounded is said as it will be heard"
        );
    }

    #[test]
    fn a_limit_written_and_read_back_is_the_limit_itself() {
        for step in 0..20_000 {
            let meant = f64::from(step) * 0.1e-3 * 0.1;
            assert_eq!(
                read_back(&write(meant * 1e3, 6).unwrap(), 1e3, meant),
                Some(meant)
            );
        }
    }
}
