//! The messages of the NEES "LabVIEW plugin" from the rig's side: tab-separated ASCII, one line each. In: a line without
//! its ending. Out: the request; and answers as lines. It knows no rig and no socket.

use std::fmt::Write as _;

/// Auxiliary devices (cameras, loggers) have control points with this prefix; they move nothing.
const AUXILIARY: &str = "MDL-AUX";

/// A request. Texts are the client's own.
#[derive(Clone, Debug, PartialEq)]
pub enum Request<'a> {
    OpenSession,
    SetParameter,
    Propose {
        transaction: &'a str,
        points: Vec<Point<'a>>,
    },
    Execute {
        transaction: &'a str,
    },
    /// The transaction can be `dummy`.
    GetControlPoint {
        transaction: &'a str,
        point: &'a str,
    },
    Cancel {
        transaction: &'a str,
    },
    CloseSession,
}

/// A control point, and the requested action.
#[derive(Clone, Debug, PartialEq)]
pub struct Point<'a> {
    pub name: &'a str,
    pub demands: Vec<StopRequest<'a>>,
}

impl Point<'_> {
    /// Whether it is an auxiliary device, such as a camera.
    #[must_use]
    pub fn is_auxiliary(&self) -> bool {
        self.name.starts_with(AUXILIARY)
    }
}

/// `x displacement 1.5E-3`
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StopRequest<'a> {
    pub axis: &'a str,
    pub kind: &'a str,
    /// m
    pub value: f64,
}

/// A request that is refused: the text after `NOT OK`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal<'a> {
    pub why: Why,
    pub transaction: &'a str,
    pub reason: String,
}

/// The code of a refusal. The protocol defines none; these are psd's own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Why {
    /// A limit is exceeded.
    Limit = 1,
    /// Not understood, or more than this rig has.
    Message = 2,
    /// Not possible now: no session, another transaction, still moving.
    Order = 3,
    /// The rig failed.
    Rig = 4,
}

impl<'a> Refusal<'a> {
    pub fn new(why: Why, transaction: &'a str, reason: impl Into<String>) -> Self {
        Self {
            why,
            transaction,
            reason: reason.into(),
        }
    }

    /// As a line, without its end.
    #[must_use]
    pub fn line(&self) -> String {
        let reason: String = self
            .reason
            .chars()
            .filter(|letter| !letter.is_control())
            .take(200)
            .collect();
        format!(
            "NOT OK\t{}\t{}\t{reason}",
            self.why as u8,
            clipped(self.transaction)
        )
    }
}

/// The control point among `names` that a client names: by its whole name, or by the part before a `:`.
#[must_use]
pub fn control_point_index(names: &[String], name: &str) -> Option<usize> {
    let model = name.split(':').next();
    names
        .iter()
        .position(|known| known == name)
        .or_else(|| names.iter().position(|known| Some(known.as_str()) == model))
}

/// The requested displacement of each axis that a proposal names: one displacement of one control point each, and no point
/// twice. Empty if it is for auxiliary devices alone. `control_point_index` finds a control point.
///
/// # Errors
/// The invalid part, for the client.
pub fn demands<'a>(
    points: &[Point<'a>],
    control_point_index: impl Fn(&str) -> Option<usize>,
) -> Result<Vec<(usize, StopRequest<'a>)>, &'static str> {
    let mut demands: Vec<(usize, StopRequest<'a>)> = Vec::new();
    for point in points.iter().filter(|point| !point.is_auxiliary()) {
        let axis = control_point_index(point.name).ok_or("no such control point")?;
        let [demand] = *point.demands.as_slice() else {
            return Err("a control point has one degree of freedom");
        };
        if demand.kind != "displacement" {
            return Err("a control point moves by displacement only");
        }
        if demands.iter().any(|(other, _)| *other == axis) {
            return Err("a control point is listed twice");
        }
        demands.push((axis, demand));
    }
    Ok(demands)
}

/// Reads one line.
///
/// # Errors
/// It is not a message of the protocol.
pub fn parse(line: &str) -> Result<Request<'_>, Refusal<'_>> {
    let mut words: Vec<&str> = line.split('\t').map(str::trim).collect();
    while words.last() == Some(&"") {
        words.pop();
    }
    match *words.as_slice() {
        ["open-session", ..] => Ok(Request::OpenSession),
        ["set-parameter", _, ..] => Ok(Request::SetParameter),
        ["propose", transaction, ref wanted @ ..] => {
            let points =
                points(wanted).map_err(|reason| Refusal::new(Why::Message, transaction, reason))?;
            Ok(Request::Propose {
                transaction,
                points,
            })
        }
        ["execute", transaction] => Ok(Request::Execute { transaction }),
        ["get-control-point", transaction, point] => {
            Ok(Request::GetControlPoint { transaction, point })
        }
        ["cancel", transaction] => Ok(Request::Cancel { transaction }),
        ["close-session", ..] => Ok(Request::CloseSession),
        _ => {
            let transaction = words.get(1).copied().unwrap_or_default();
            Err(Refusal::new(
                Why::Message,
                transaction,
                "unknown message, or wrong number of words",
            ))
        }
    }
}

/// `MDL-00-01 (axis kind value)+ [MDL-… …]`. Axis and kind can be in either order.
fn points<'a>(wanted: &[&'a str]) -> Result<Vec<Point<'a>>, String> {
    let mut points: Vec<Point<'a>> = Vec::new();
    let mut left = wanted;
    loop {
        match *left {
            [] if points.is_empty() => return Err("no control point".to_owned()),
            [] => return Ok(points),
            [name, ref rest @ ..] if name.starts_with("MDL-") => {
                points.push(Point {
                    name,
                    demands: Vec::new(),
                });
                left = rest;
            }
            [first, second, value, ref rest @ ..] => {
                let point = points
                    .last_mut()
                    .ok_or("the control point must come before its values")?;
                let value = value
                    .parse()
                    .map_err(|_| format!("`{}` is not a number", clipped(value)))?;
                let is_axis = |word: &str| matches!(word, "x" | "y" | "z");
                let (axis, kind) = if is_axis(second) {
                    (second, first)
                } else {
                    (first, second)
                };
                point.demands.push(StopRequest { axis, kind, value });
                left = rest;
            }
            _ => return Err("axis, kind and value must come in threes".to_owned()),
        }
    }
}

/// `OK 0 transaction`
#[must_use]
pub fn done(transaction: &str) -> String {
    format!("OK\t0\t{}", clipped(transaction))
}

/// The answer to `get-control-point`: displacement in m, force in N.
#[must_use]
pub fn control_point(
    transaction: &str,
    point: &str,
    axis: &str,
    displacement: f64,
    force: f64,
) -> String {
    let mut line = format!("{}\t{}", done(transaction), clipped(point));
    for (kind, value) in [("displacement", displacement), ("force", force)] {
        let _ = write!(line, "\t{axis}\t{kind}\t{}", scientific(value));
    }
    line
}

/// `%.10E` of C: the exponent has its sign and two digits or more.
fn scientific(value: f64) -> String {
    let text = format!("{value:.10E}");
    let Some((digits, exponent)) = text.split_once('E') else {
        return text;
    };
    let (sign, exponent) = exponent
        .strip_prefix('-')
        .map_or(('+', exponent), |exponent| ('-', exponent));
    format!("{digits}E{sign}{exponent:0>2}")
}

/// The echoed text stays short: an answer must be below 512 bytes.
fn clipped(text: &str) -> String {
    text.chars().take(100).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_messages_of_openfresco_and_ui_simcor() {
        let proposed = parse(
            "propose\tOPFTransaction20260431120000\tMDL-00-01\tx\tdisplacement\t1.2500000000E-03\t",
        );
        let demand = StopRequest {
            axis: "x",
            kind: "displacement",
            value: 1.25e-3,
        };
        let points = vec![Point {
            name: "MDL-00-01",
            demands: vec![demand],
        }];
        assert_eq!(
            proposed,
            Ok(Request::Propose {
                transaction: "OPFTransaction20260431120000",
                points
            })
        );
        let transaction = "trans20260531120005.123[1 0 0]";
        let asked = format!("get-control-point\t{transaction}\tMDL-00-01:LBCB1");
        assert_eq!(
            parse(&asked),
            Ok(Request::GetControlPoint {
                transaction,
                point: "MDL-00-01:LBCB1"
            })
        );
        let trigger = parse("propose\ttrans1 0001\tMDL-AUX\tdisplacement\tz\t3500").unwrap();
        let Request::Propose { points, .. } = trigger else {
            panic!("{trigger:?}")
        };
        assert!(points[0].is_auxiliary() && points[0].demands[0].axis == "z");
        for (line, request) in [
            ("open-session\tpsd", Request::OpenSession),
            ("set-parameter\tdummy\tnstep\t100", Request::SetParameter),
            ("execute\tt1", Request::Execute { transaction: "t1" }),
            ("cancel\tt1", Request::Cancel { transaction: "t1" }),
            ("close-session\tpsd", Request::CloseSession),
        ] {
            assert_eq!(parse(line), Ok(request));
        }
    }

    #[test]
    fn what_is_no_message_is_refused_with_its_transaction() {
        for (line, transaction) in [
            ("", ""),
            ("hello", ""),
            ("execute\t", ""),
            ("propose\tt1", "t1"),
            ("propose\tt1\tx\tdisplacement\t1", "t1"),
            ("propose\tt1\tMDL-00-01\tx\tdisplacement", "t1"),
            ("propose\tt1\tMDL-00-01\tx\tdisplacement\t1,5", "t1"),
            ("get-parameter\tt1\tnstep", "t1"),
        ] {
            let refusal = parse(line).unwrap_err();
            assert_eq!(
                (refusal.why, refusal.transaction),
                (Why::Message, transaction),
                "{line:?}"
            );
        }
    }

    #[test]
    fn answers_by_hand() {
        assert_eq!(done("t1"), "OK\t0\tt1");
        let answer = control_point("t1", "MDL-00-01", "x", -0.00125, 123.456);
        let by_hand =
            "OK\t0\tt1\tMDL-00-01\tx\tdisplacement\t-1.2500000000E-03\tx\tforce\t1.2345600000E+02";
        assert_eq!(answer, by_hand);
        let refusal = Refusal::new(Why::Limit, "t1", "too\tfar\n");
        assert_eq!(refusal.line(), "NOT OK\t1\tt1\ttoofar");
        assert_eq!(scientific(1e-120), "1.0000000000E-120");
        let long = "M".repeat(1000);
        assert!(
            control_point(&long, &long, "x", f64::MIN, f64::MIN).len() < 512
                && Refusal::new(Why::Rig, &long, &long).line().len() < 512
        );
    }
}
