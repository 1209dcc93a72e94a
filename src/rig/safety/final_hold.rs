//! The result of the final hold of a rig, at the early end of a run. In: the replies of the rig and its position. Out: a
//! sentence for the operator. It sends nothing to the rig.

use psd_text::units::Dimension;
use psd_text::units::display::readable;

/// The state of the rig after a run that ended early.
#[derive(Clone, Debug, PartialEq)]
pub struct FinalHold {
    /// Rig time \[s\].
    pub time: f64,
    /// The reason why the hold is not confirmed. None: the rig was seen at rest after the command.
    pub unconfirmed: Option<String>,
    /// Displacement \[m\] and force \[N\] of every axis, read then; None: they could not be read.
    pub found: Option<(Vec<f64>, Vec<f64>)>,
    /// The bytes of that reading.
    pub raw: Vec<Vec<u8>>,
}

impl FinalHold {
    /// Whether it is known to hold.
    #[must_use]
    pub const fn is_held(&self) -> bool {
        self.unconfirmed.is_none()
    }
}

/// Positions \[m\] and forces \[N\] of all axes: `4.000 mm, 1.200 kN`.
#[must_use]
pub fn position_and_force(displacement: &[f64], force: &[f64]) -> String {
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

impl std::fmt::Display for FinalHold {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (&self.unconfirmed, &self.found) {
            (Some(unconfirmed), _) => {
                write!(
                    f,
                    "NOT CONFIRMED HELD ({unconfirmed}): IT MAY STILL BE MOVING. Press the emergency stop"
                )
            }
            (None, Some((displacement, force))) => {
                write!(f, "HELD at {}", position_and_force(displacement, force))
            }
            (None, None) => f.write_str("HELD; its position could not be read"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_operator_is_given_the_position_or_asked_to_stop_the_rig() {
        let held = FinalHold {
            time: 1.0,
            unconfirmed: None,
            found: Some((vec![0.001_523], vec![457.0])),
            raw: Vec::new(),
        };
        assert_eq!(held.to_string(), "HELD at 1.523 mm, 457.0 N");
        assert_eq!(
            FinalHold {
                found: None,
                ..held.clone()
            }
            .to_string(),
            "HELD; its position could not be read"
        );
        let lost = FinalHold {
            unconfirmed: Some("connection lost".to_owned()),
            ..held
        };
        assert!(!lost.is_held());
        assert_eq!(
            lost.to_string(),
            "NOT CONFIRMED HELD (connection lost): IT MAY STILL BE MOVING. Press the emergency stop"
        );
        assert_eq!(
            position_and_force(&[0.001, -0.002], &[10.0, 20.0]),
            "1.000 mm, 10.00 N; −2.000 mm, 20.00 N"
        );
    }
}
