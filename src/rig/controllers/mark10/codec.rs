//! A Mark-10 ESM301/303 test frame and its gauge: single letters, some followed by digits, without line endings. In: \[m\] and \[m/s\].
//! Out: the bytes of settings and questions, and the meaning of status, travel and force. The test frame has no absolute move: a target
//! is a travel limit. Negative is the direction that the gauge calls negative. It knows no device.

use crate::controllers::number;

/// Ends every answer.
pub const ENDING: &[u8] = b"\r\n";

/// Travel and speed in mm, limit mode, the programmed speed.
pub const READY: &[u8] = b"ilo";
pub const UP: &[u8] = b"u";
pub const DOWN: &[u8] = b"d";
pub const STOP: &[u8] = b"s";
pub const ASK_STATUS: &[u8] = b"p";
pub const ASK_TRAVEL: &[u8] = b"x";
pub const ASK_UPPER_LIMIT: &[u8] = b"v";
pub const ASK_LOWER_LIMIT: &[u8] = b"w";
/// The reading of the gauge, requested from the gauge itself and through the test frame.
pub const ASK_FORCE: &[u8] = b"?\r";
pub const ASK_FORCE_THROUGH_STAND: &[u8] = b"/?\r\\";

const MILLIMETRES: f64 = 1e3;
const MILLIMETRES_A_MINUTE: f64 = 6e4;
/// Largest travel and speed that the digits can express, mm and mm/min.
const FURTHEST: f64 = 999.99;
const FASTEST: f64 = 9999.9;

const NEWTONS_PER_POUND: f64 = 4.448_221_615_260_5;
const NEWTONS_PER_KILOGRAM: f64 = 9.806_65;

/// The end of the travel at which a limit is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    Lower,
    Upper,
}

/// The answer to `p`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status {
    pub moving: bool,
    pub limit_mode: bool,
    /// The travel limit that it has reached.
    pub at: Option<Side>,
}

/// The reading of the gauge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Force {
    Newtons(f64),
    /// `*10`: the gauge did not recognise the question.
    Unknown,
}

/// The setting of a travel limit, and its decoded value \[m\]. None if it does not fit its digits.
#[must_use]
pub fn limit(side: Side, target: f64) -> Option<(Vec<u8>, f64)> {
    let millimetres = target * MILLIMETRES;
    if !(-FURTHEST..=FURTHEST).contains(&millimetres) {
        return None;
    }
    let written = number::write(millimetres, 2)?;
    let (sign, digits) = written
        .strip_prefix('-')
        .map_or(("", written.as_str()), |digits| ("-", digits));
    let letter = match side {
        Side::Lower => 'g',
        Side::Upper => 'h',
    };
    let encoded = number::read_back(&format!("{sign}{digits:0>6}"), MILLIMETRES, target)?;
    Some((format!("{letter}{sign}{digits:0>6}").into_bytes(), encoded))
}

/// The setting of the speed \[m/s\], never above the requested one, and its decoded value. None if it does not fit its
/// digits.
#[must_use]
pub fn speed(speed: f64) -> Option<(Vec<u8>, f64)> {
    // Rounded down to 0.1 mm/min; an error in the last bit of a float is ignored.
    let tenths = (speed * MILLIMETRES_A_MINUTE * 10.0 * (1.0 + 4.0 * f64::EPSILON)).floor();
    if !(1.0..=FASTEST * 10.0).contains(&tenths) {
        return None;
    }
    let written = format!("{:06.1}", tenths / 10.0);
    let encoded = number::read_back(&written, MILLIMETRES_A_MINUTE, speed)?;
    Some((format!("e{written}").into_bytes(), encoded))
}

#[must_use]
pub fn status(answer: &[u8]) -> Option<Status> {
    let squeezed: Vec<u8> = answer
        .iter()
        .copied()
        .filter(|byte| !matches!(byte, b' ' | b','))
        .collect();
    let (moving, rest) = match squeezed.split_first()? {
        (b'U' | b'D', rest) => (true, rest),
        (b'S', rest) => (false, rest),
        _ => return None,
    };
    let (mode, rest) = rest.split_first()?;
    let at = match rest {
        b"" => None,
        b"UL" => Some(Side::Upper),
        b"DL" => Some(Side::Lower),
        _ => return None,
    };
    matches!(mode, b'C' | b'L' | b'M').then_some(Status {
        moving,
        limit_mode: *mode == b'L',
        at,
    })
}

/// Travel \[m\]: a number of mm, with its unit or without.
#[must_use]
pub fn travel(answer: &[u8]) -> Option<f64> {
    let answer = answer.strip_suffix(b" mm").unwrap_or(answer);
    number::fixed(answer).map(|millimetres| millimetres / MILLIMETRES)
}

/// The reading of the gauge: a number, a space, a unit. None: no usable reading.
#[must_use]
pub fn force(answer: &[u8]) -> Option<Force> {
    if answer == b"*10" {
        return Some(Force::Unknown);
    }
    let at = answer.iter().position(|byte| *byte == b' ')?;
    let newtons = match &answer[at + 1..] {
        b"N" => 1.0,
        b"kN" => 1e3,
        b"lbF" => NEWTONS_PER_POUND,
        b"kgF" => NEWTONS_PER_KILOGRAM,
        _ => return None,
    };
    number::fixed(&answer[..at]).map(|value| Force::Newtons(value * newtons))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_the_value_of_its_digits() {
        let encoded_text = |side, target| {
            limit(side, target).map(|(bytes, encoded)| (String::from_utf8(bytes).unwrap(), encoded))
        };
        assert_eq!(
            encoded_text(Side::Lower, -0.007_52),
            Some(("g-007.52".to_owned(), -0.007_52))
        );
        assert_eq!(
            encoded_text(Side::Upper, 0.010_7),
            Some(("h010.70".to_owned(), 0.010_7))
        );
        assert_eq!(
            encoded_text(Side::Upper, 0.001_234_6),
            Some(("h001.23".to_owned(), 0.001_23))
        );
        assert_eq!(
            encoded_text(Side::Lower, -0.000_001),
            Some(("g000.00".to_owned(), 0.0)),
            "no minus of nothing"
        );
        for beyond in [1.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(limit(Side::Upper, beyond), None, "{beyond}");
        }
        for hundredths in -2000_i32..2000 {
            let target = f64::from(hundredths) * 1e-5;
            assert_eq!(limit(Side::Upper, target).unwrap().1, target);
        }
    }

    #[test]
    fn a_speed_is_rounded_down() {
        let encoded_text = |asked| {
            speed(asked).map(|(bytes, encoded)| (String::from_utf8(bytes).unwrap(), encoded))
        };
        assert_eq!(encoded_text(0.01), Some(("e0600.0".to_owned(), 0.01)));
        let (bytes, slower) = encoded_text(0.000_012_3).unwrap();
        assert_eq!(bytes, "e0000.7");
        assert!(slower <= 0.000_012_3);
        for asked in [0.0, 1e-6, 0.17, -0.01, f64::NAN] {
            assert_eq!(speed(asked), None, "{asked}");
        }
        for tenths in 1..5000 {
            let asked = f64::from(tenths) / 6e5;
            assert_eq!(speed(asked).unwrap().1, asked, "{tenths}");
        }
    }

    #[test]
    fn status_states_motion_mode_and_limit() {
        let still = Status {
            moving: false,
            limit_mode: true,
            at: None,
        };
        assert_eq!(status(b"SL"), Some(still));
        assert_eq!(
            status(b"SLUL"),
            Some(Status {
                at: Some(Side::Upper),
                ..still
            })
        );
        assert_eq!(
            status(b"S, L, DL"),
            Some(Status {
                at: Some(Side::Lower),
                ..still
            })
        );
        assert_eq!(
            status(b"UL"),
            Some(Status {
                moving: true,
                ..still
            }),
            "up, in limit mode"
        );
        assert_eq!(
            status(b"DM"),
            Some(Status {
                moving: true,
                limit_mode: false,
                ..still
            })
        );
        for none in [&b""[..], b"S", b"X", b"SLX", b"SLULDL", b"12.50", b"SX"] {
            assert_eq!(status(none), None, "{}", none.escape_ascii());
        }
    }

    #[test]
    fn force_and_travel_are_numbers_with_known_units_or_nothing() {
        assert_eq!(force(b"-12.5 N"), Some(Force::Newtons(-12.5)));
        assert_eq!(force(b"0.25 kN"), Some(Force::Newtons(250.0)));
        assert_eq!(force(b"2 kgF"), Some(Force::Newtons(19.6133)));
        assert_eq!(force(b"1 lbF"), Some(Force::Newtons(4.448_221_615_260_5)));
        assert_eq!(force(b"*10"), Some(Force::Unknown));
        for none in [
            &b""[..],
            b"12.5",
            b"12,5 N",
            b"nan N",
            b"OVL",
            b" N",
            b"1 lb",
            b"1 N ",
            b"1  N",
            b"inf N",
            b"*11",
        ] {
            assert_eq!(force(none), None, "{}", none.escape_ascii());
        }
        assert_eq!(travel(b"-12.34"), Some(-0.012_34));
        assert_eq!(travel(b"12.34 mm"), Some(0.012_34));
        for none in [&b""[..], b"12,34", b"0.04 in", b"SL", b"nan"] {
            assert_eq!(travel(none), None);
        }
    }
}
