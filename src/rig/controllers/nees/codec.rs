//! NEES "LabVIEW plugin" ASCII, spec v1.4, the coordinator's side: one line a message, fields separated by tabs. In: a
//! transaction, a control point, \[m\]. Out: the bytes of a request; the meaning of a reply. Lengths are in metres and
//! forces in newtons, as OpenFresco sends them: the protocol itself names no unit. It knows no device.

use crate::controllers::number;

/// Ends every line; a CR before it is allowed.
pub const ENDING: &[u8] = b"\n";

const DIRECTION: &str = "x";

/// The meaning of a reply.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reply {
    /// The fields after `OK` and its code; the first is the transaction if the request had one.
    Done(Vec<String>),
    /// Any other reply, as text, with the transaction it names.
    Refused {
        transaction: Option<String>,
        reason: String,
    },
}

/// The measured values of a control point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    /// \[m\]
    pub displacement: Option<f64>,
    /// \[N\]
    pub force: Option<f64>,
}

#[must_use]
pub fn open_session(name: &str) -> Vec<u8> {
    line(&["open-session", name])
}

#[must_use]
pub fn close_session(name: &str) -> Vec<u8> {
    line(&["close-session", name])
}

/// Announces the number of steps to come.
#[must_use]
pub fn steps(transaction: &str, steps: u32) -> Vec<u8> {
    line(&["set-parameter", transaction, "nstep", &steps.to_string()])
}

/// Proposes a displacement \[m\] of every control point in one transaction, and gives the decoded values. None if one is
/// not finite.
#[must_use]
pub fn propose(transaction: &str, displacements: &[(&str, f64)]) -> Option<(Vec<u8>, Vec<f64>)> {
    let written: Vec<String> = displacements
        .iter()
        .map(|(_, value)| ten_digits(*value))
        .collect::<Option<_>>()?;
    let encoded = written
        .iter()
        .map(|written| number::scientific(written.as_bytes()))
        .collect::<Option<_>>()?;
    let points = displacements.iter().zip(&written);
    let fields = points
        .flat_map(|((point, _), written)| [point, DIRECTION, "displacement", written.as_str()]);
    Some((
        line(
            &["propose", transaction]
                .into_iter()
                .chain(fields)
                .collect::<Vec<_>>(),
        ),
        encoded,
    ))
}

#[must_use]
pub fn execute(transaction: &str) -> Vec<u8> {
    line(&["execute", transaction])
}

#[must_use]
pub fn cancel(transaction: &str) -> Vec<u8> {
    line(&["cancel", transaction])
}

#[must_use]
pub fn get_control_point(transaction: &str, control_point: &str) -> Vec<u8> {
    line(&["get-control-point", transaction, control_point])
}

/// The transaction of a request of ours.
#[must_use]
pub fn transaction(request: &[u8]) -> Option<&str> {
    std::str::from_utf8(request)
        .ok()?
        .trim_end()
        .split('\t')
        .nth(1)
}

/// Whether a name can be a field: it contains no separator and no line end.
#[must_use]
pub fn is_field(name: &str) -> bool {
    !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_graphic())
}

/// Reads a reply without its ending.
#[must_use]
pub fn reply(line: &[u8]) -> Reply {
    let line = line.strip_suffix(b"\r").unwrap_or(line);
    let text = String::from_utf8_lossy(line);
    let mut fields = text
        .split('\t')
        .map(|field| field.trim_matches(' ').to_owned());
    if line.is_ascii()
        && fields.next().as_deref() == Some("OK")
        && fields.next().as_deref() == Some("0")
    {
        return Reply::Done(fields.collect());
    }
    let fields: Vec<&str> = text.split('\t').collect();
    Reply::Refused {
        transaction: fields.get(2).map(|field| (*field).to_owned()),
        reason: line.escape_ascii().to_string(),
    }
}

/// The measured values in the fields after the transaction: the control point, then triples of direction, kind and value.
/// None for other fields, or a value that is not a number.
#[must_use]
pub fn measured(fields: &[String], control_point: &str) -> Option<Measured> {
    let (point, values) = fields.split_first()?;
    // Some rigs name the point without its suffix.
    if point != control_point && Some(point.as_str()) != control_point.split(':').next() {
        return None;
    }
    let mut measured = Measured::default();
    let triples = values.chunks_exact(3);
    if !triples.remainder().is_empty() {
        return None;
    }
    for triple in triples {
        let value = number::scientific(triple[2].as_bytes())?;
        match (triple[0].as_str(), triple[1].as_str()) {
            (DIRECTION, "displacement") => measured.displacement = Some(value),
            (DIRECTION, "force") => measured.force = Some(value),
            _ => {}
        }
    }
    Some(measured)
}

/// As `%.10E` in C: eleven digits, and an exponent with a sign and at least two digits.
fn ten_digits(value: f64) -> Option<String> {
    let written = value.is_finite().then(|| format!("{:.10E}", value + 0.0))?;
    let (mantissa, exponent) = written.split_once('E')?;
    let (sign, digits) = exponent
        .strip_prefix('-')
        .map_or(('+', exponent), |digits| ('-', digits));
    Some(format!("{mantissa}E{sign}{digits:0>2}"))
}

fn line(fields: &[&str]) -> Vec<u8> {
    [fields.join("\t").as_bytes(), ENDING].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fields(text: &str) -> Vec<String> {
        text.split(' ').map(str::to_owned).collect()
    }

    #[test]
    fn requests_are_those_of_the_specification() {
        let (bytes, encoded) = propose("t1", &[("MDL-00-01", 0.001_25)]).unwrap();
        assert_eq!(
            bytes,
            b"propose\tt1\tMDL-00-01\tx\tdisplacement\t1.2500000000E-03\n"
        );
        assert_eq!(encoded, [0.001_25]);
        let (bytes, encoded) =
            propose("t1", &[("MDL-00-01", 0.001_25), ("MDL-00-02", -0.5)]).unwrap();
        let expected =
            b"propose\tt1\tMDL-00-01\tx\tdisplacement\t1.2500000000E-03\tMDL-00-02\tx\tdisplacement\t-5.0000000000E-01\n";
        assert_eq!(
            (bytes.as_slice(), encoded.as_slice()),
            (expected.as_slice(), [0.001_25, -0.5].as_slice())
        );
        assert_eq!(execute("t1"), b"execute\tt1\n");
        assert_eq!(cancel("t1"), b"cancel\tt1\n");
        assert_eq!(
            get_control_point("t1", "MDL-00-01:top"),
            b"get-control-point\tt1\tMDL-00-01:top\n"
        );
        assert_eq!(open_session("psd"), b"open-session\tpsd\n");
        assert_eq!(steps("t0", 100), b"set-parameter\tt0\tnstep\t100\n");
        assert_eq!(
            ten_digits(-12_345.678_901_234).as_deref(),
            Some("-1.2345678901E+04")
        );
        assert_eq!(ten_digits(-0.0).as_deref(), Some("0.0000000000E+00"));
        assert_eq!(ten_digits(1e-300).as_deref(), Some("1.0000000000E-300"));
    }

    #[test]
    fn a_target_is_the_value_of_its_eleven_digits() {
        let (_, encoded) = propose("t", &[("p", 1.0 / 3.0)]).unwrap();
        assert_eq!(encoded, [0.333_333_333_33]);
        for none in [f64::NAN, f64::INFINITY] {
            assert_eq!(propose("t", &[("p", 0.0), ("q", none)]), None);
        }
    }

    #[test]
    fn only_ok_is_done_and_anything_else_is_a_refusal_in_its_own_words() {
        assert_eq!(reply(b"OK\t0\tt1"), Reply::Done(vec!["t1".to_owned()]));
        assert_eq!(reply(b"OK\t0\tt1\r"), Reply::Done(vec!["t1".to_owned()]));
        let refused = |line: &[u8]| matches!(reply(line), Reply::Refused { .. });
        for line in [
            &b"NOT OK\t7\tt1\tlimit"[..],
            b"NOTOK\t0",
            b"OK",
            b"OK\t1\tt1",
            b"ok\t0\tt1",
            b"",
            b"OK\t0\tt\xff",
        ] {
            assert!(refused(line), "{}", line.escape_ascii());
        }
        let Reply::Refused {
            transaction,
            reason,
        } = reply(b"NOT OK\t7\tt1\tbeyond \x1b[2J")
        else {
            panic!()
        };
        assert_eq!(transaction.as_deref(), Some("t1"));
        assert_eq!(
            reason, r"NOT OK\t7\tt1\tbeyond \x1b[2J",
            "nothing in it reaches a terminal as it came"
        );
    }

    #[test]
    fn a_control_point_gives_triples_of_numbers_or_nothing() {
        let both = Some(Measured {
            displacement: Some(0.001),
            force: Some(-250.0),
        });
        let point = "MDL-00-01 x displacement 1.0E-03 x force -2.5E+02";
        assert_eq!(measured(&fields(point), "MDL-00-01"), both);
        assert_eq!(measured(&fields(point), "MDL-00-01:top"), both);
        assert_eq!(measured(&fields(point), "MDL-00-02"), None);
        for value in ["nan", "NaN", "inf", "1e400", "1,5", "", "OVL", "0x1"] {
            assert_eq!(
                measured(&fields(&format!("p x force {value}")), "p"),
                None,
                "{value}"
            );
        }
        assert_eq!(
            measured(&fields("p x force"), "p"),
            None,
            "a field is missing"
        );
        assert_eq!(
            measured(&fields("p y force 1.0"), "p"),
            Some(Measured::default())
        );
        assert_eq!(measured(&[], "p"), None);
    }

    #[test]
    fn a_name_that_divides_fields_is_none() {
        assert!(is_field("MDL-00-01:top"));
        for name in ["", "a\tb", "a\nb", "a b", "\u{e9}"] {
            assert!(!is_field(name), "{name:?}");
        }
    }
}
