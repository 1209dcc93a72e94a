//! SCPI transducers: `*IDN?` and `READ?`. In: a line without its ending. Out: the identity; the number of a reading. The
//! force of one unit is stated in the plan.

use crate::controllers::number;

pub const IDENTIFY: &[u8] = b"*IDN?\n";
pub const READ: &[u8] = b"READ?\n";

/// The answer to `*IDN?`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Identification {
    pub maker: String,
    pub model: String,
    pub serial: String,
    pub firmware: String,
}

/// The answer to `READ?`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer {
    Number(f64),
    /// 9.9E37 of either sign: infinity.
    Overload {
        negative: bool,
    },
}

/// Infinity, as SCPI writes it; 9.91E37 is "not a number".
const INFINITY: f64 = 9.9e37;

/// The four fields of an identification.
#[must_use]
pub fn identification(line: &[u8]) -> Option<Identification> {
    let text = std::str::from_utf8(line).ok().filter(|text| {
        text.bytes()
            .all(|byte| byte == b' ' || byte.is_ascii_graphic())
    })?;
    let fields: Vec<String> = text
        .split(',')
        .map(|field| field.trim().to_owned())
        .collect();
    let [maker, model, serial, firmware] = <[String; 4]>::try_from(fields).ok()?;
    Some(Identification {
        maker,
        model,
        serial,
        firmware,
    })
}

/// The one number of an answer.
///
/// # Errors
/// The reason why it is invalid.
pub fn answer(line: &[u8]) -> Result<Answer, &'static str> {
    let value = number::scientific(line).ok_or("it is not a number")?;
    if value.abs() < INFINITY {
        Ok(Answer::Number(value))
    } else if value.abs() == INFINITY {
        Ok(Answer::Overload {
            negative: value < 0.0,
        })
    } else {
        Err("the meter reports that it has no valid number")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_is_one_number() {
        assert_eq!(answer(b"+5.12375000E+02"), Ok(Answer::Number(512.375)));
        assert_eq!(answer(b"-12"), Ok(Answer::Number(-12.0)));
        assert_eq!(answer(b"9.9E37"), Ok(Answer::Overload { negative: false }));
        assert_eq!(
            answer(b"-9.90000000E+37"),
            Ok(Answer::Overload { negative: true })
        );
        for line in [
            "9.91E37",
            "9.91000000E+37",
            "1e38",
            "1e400",
            "1e-400",
            "nan",
            "inf",
            "OVL",
            "",
            "1,5",
            "1.0,2.0",
            " 1",
            "1 N",
            "5.",
            ".5",
        ] {
            assert!(answer(line.as_bytes()).is_err(), "{line}");
        }
    }

    #[test]
    fn an_identification_has_four_fields() {
        let identity = identification(b"Maker Ltd,DMM 7, 1234,A.02").unwrap();
        assert_eq!(
            (identity.maker.as_str(), identity.model.as_str()),
            ("Maker Ltd", "DMM 7")
        );
        assert_eq!(
            (identity.serial.as_str(), identity.firmware.as_str()),
            ("1234", "A.02")
        );
        for line in [
            &b"a,b,c"[..],
            b"a,b,c,d,e",
            b"",
            b"+1.0E2",
            b"a,b,c,d\x1b",
            b"a,b,\xff,d",
        ] {
            assert_eq!(identification(line), None);
        }
    }
}
