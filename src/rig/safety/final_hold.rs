//! What became of a rig that was told to hold for good, at the early end of a run. In: what it said and where it was seen. Out: the
//! sentence for the person who stands before it. It asks no rig.

use crate::units::Dimension;
use crate::units::display::readable;

/// Where a run that ended early left its rig.
#[derive(Clone, Debug, PartialEq)]
pub struct Halted {
    /// Rig time, s.
    pub time: f64,
    /// Why nobody knows whether it holds; None: it was seen at rest after it had been told to.
    pub doubt: Option<String>,
    /// Displacement (m) and force (N) of every axis, read then; None: they could not be read.
    pub found: Option<(Vec<f64>, Vec<f64>)>,
    /// The bytes of that reading.
    pub raw: Vec<Vec<u8>>,
}

impl Halted {
    /// Whether it is known to hold.
    #[must_use]
    pub const fn is_held(&self) -> bool {
        self.doubt.is_none()
    }
}

/// Places (m) and forces (N) of all axes: `4.000 mm, 1.200 kN`.
#[must_use]
pub fn place_and_force(displacement: &[f64], force: &[f64]) -> String {
    let pair = |(x, r): (&f64, &f64)| {
        format!(
            "{}, {}",
            readable(*x, Dimension::LENGTH),
            readable(*r, Dimension::FORCE)
        )
    };
    displacement
        .iter()
        .zip(force)
        .map(pair)
        .collect::<Vec<_>>()
        .join("; ")
}

impl std::fmt::Display for Halted {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (&self.doubt, &self.found) {
            (Some(doubt), _) => {
                write!(
                    f,
                    "NOT CONFIRMED HELD ({doubt}): it may still be moving; use the emergency stop"
                )
            }
            (None, Some((displacement, force))) => {
                write!(f, "held at {}", place_and_force(displacement, force))
            }
            (None, None) => f.write_str("held; where it stands could not be read"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_stands_there_is_told_where_it_stands_or_to_stop_it() {
        let held = Halted {
            time: 1.0,
            doubt: None,
            found: Some((vec![0.001_523], vec![457.0])),
            raw: Vec::new(),
        };
        assert_eq!(held.to_string(), "held at 1.523 mm, 457.0 N");
        assert_eq!(
            Halted {
                found: None,
                ..held.clone()
            }
            .to_string(),
            "held; where it stands could not be read"
        );
        let lost = Halted {
            doubt: Some("the line is gone".to_owned()),
            ..held
        };
        assert!(!lost.is_held());
        assert_eq!(
            lost.to_string(),
            "NOT CONFIRMED HELD (the line is gone): it may still be moving; use the emergency stop"
        );
        assert_eq!(
            place_and_force(&[0.001, -0.002], &[10.0, 20.0]),
            "1.000 mm, 10.00 N; −2.000 mm, 20.00 N"
        );
    }
}
