//! The text of a frame of psd's own protocol: numbers, codes, checksum. In: words and bytes. Out: numbers and bytes. It carries
//! nothing out.

/// Adds the axis, from 1, to a code if there are several axes.
pub(super) fn of_axis(code: &str, axis: usize, axes: usize) -> String {
    if axes > 1 {
        format!("{code} {}", axis + 1)
    } else {
        code.to_owned()
    }
}

/// Parses a number of the protocol: digits, at most one point with digits on both sides, no exponent.
pub(super) fn decimal(word: &str) -> Option<f64> {
    let digits = word.strip_prefix('-').unwrap_or(word);
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, "0"));
    let all_digits =
        |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    if all_digits(whole) && all_digits(fraction) {
        word.parse().ok()
    } else {
        None
    }
}

/// CRC-16/CCITT-FALSE by table-free byte steps.
pub(super) fn crc(bytes: &[u8]) -> u16 {
    let mut crc = 0xffff_u16;
    for byte in bytes {
        // The classical byte-wise form, different from the driver's shift register.
        let mut mixed = crc >> 8 ^ u16::from(*byte);
        mixed ^= mixed >> 4;
        crc = crc << 8 ^ mixed << 12 ^ mixed << 5 ^ mixed;
    }
    crc
}

/// A request with its checksum, as a host sends it.
pub fn sealed(body: &str) -> Vec<u8> {
    format!(">{body}*{:04X}\n", crc(body.as_bytes())).into_bytes()
}
