//! Decimal numbers as devices write them, and nothing else that a float parser would take. In: bytes. Out: a finite
//! number. It knows no units.

/// `[+-] digits [. digits]`, digits on both sides of the point.
#[must_use]
pub fn strict(text: &[u8]) -> Option<f64> {
    let unsigned = text.strip_prefix(b"-").or_else(|| text.strip_prefix(b"+")).unwrap_or(text);
    let mut parts = unsigned.splitn(2, |byte| *byte == b'.');
    let digits = |part: &[u8]| !part.is_empty() && part.len() <= LONGEST && part.iter().all(u8::is_ascii_digit);
    if !parts.all(digits) {
        return None;
    }
    std::str::from_utf8(text).ok()?.parse().ok()
}

/// As [`strict`], or with an exponent: `1.0000000000E-03`.
#[must_use]
pub fn scientific(text: &[u8]) -> Option<f64> {
    let mut parts = text.splitn(2, |byte| *byte == b'E' || *byte == b'e');
    strict(parts.next()?)?;
    if let Some(exponent) = parts.next() {
        let digits = exponent.strip_prefix(b"-").or_else(|| exponent.strip_prefix(b"+")).unwrap_or(exponent);
        if digits.is_empty() || digits.len() > 3 || !digits.iter().all(u8::is_ascii_digit) {
            return None;
        }
    }
    std::str::from_utf8(text).ok()?.parse().ok().filter(|value: &f64| value.is_finite())
}

/// Most digits on one side of the point.
const LONGEST: usize = 40;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_decimals_are_numbers() {
        for (text, value) in [("0", 0.0), ("-12.50", -12.5), ("+0001234", 1234.0), ("0.001", 0.001)] {
            assert_eq!(strict(text.as_bytes()), Some(value));
            assert_eq!(scientific(text.as_bytes()), Some(value));
        }
        let none = [
            "", "-", "+", ".", "5.", ".5", "1,5", "nan", "NaN", "inf", "-inf", "infinity", "OVL", "1e400", "9.91E999", "0x10", "1_000",
            "--1", "1 2", " 1", "1 ", "1.2.3", "1\0", "1e", "1e+", "1e1.0", "e5", "²",
        ];
        for text in none {
            assert_eq!((strict(text.as_bytes()), scientific(text.as_bytes())), (None, None), "{text:?}");
        }
        assert_eq!(strict(b"1e3"), None);
        assert_eq!(scientific(b"-1.2500000000E-03"), Some(-0.001_25));
    }
}
