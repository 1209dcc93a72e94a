//! The zero drift of a rig in a run: zeros before and after it, and the slopes of readings while nothing moved. `run`
//! writes it. In: readings. Out: whether the zero drift exceeds the limit of the rig. It knows no rig and no procedure.

use crate::DriftCheck;
use crate::record::Held;
use crate::{named_axis, of_axis};
use psd_text::units::Dimension;
use psd_text::units::display::{readable, stated};

/// The zero drift of a rig in a run, and its limits.
#[derive(Clone, Debug, PartialEq)]
pub struct Drift {
    pub check: DriftCheck,
    /// Lowest floor first.
    pub axes: Vec<AxisDrift>,
    /// Of all dwells of the run.
    pub held: Held,
}

/// The zeros of one actuator and its load cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisDrift {
    pub before: Zero,
    /// None if it was not read.
    pub after: Option<Zero>,
}

/// A zero reading: the mean of several readings, and the line through them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zero {
    /// Rig time of the last of them \[s\].
    pub time: f64,
    /// \[N\]
    pub force: f64,
    /// Measured displacement minus its target \[m\].
    pub displacement: f64,
    /// \[N/s\]
    pub force_slope: f64,
    /// \[m/s\]
    pub displacement_slope: f64,
}

/// A zero drift beyond the limit of the rig, and its quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Beyond {
    /// Whether it is the drift of the load cell; otherwise that of the displacement.
    pub of_force: bool,
    pub reason: String,
}

impl AxisDrift {
    /// Change of the zero: force \[N\] and displacement \[m\].
    #[must_use]
    pub fn change(&self) -> Option<(f64, f64)> {
        self.after.map(|after| {
            (
                after.force - self.before.force,
                after.displacement - self.before.displacement,
            )
        })
    }
}

impl Drift {
    /// The zero drifts beyond their limits, axis by axis. Three changes are assessed: the change of a zero; the change at rest before the
    /// first move; and an increase of the force in a dwell at a displacement beyond all earlier ones. There, relaxation can only
    /// decrease the force.
    pub fn beyond(&self) -> impl Iterator<Item = Beyond> {
        let several = self.axes.len();
        let axes = self.axes.iter().enumerate();
        axes.flat_map(move |(index, axis)| self.of_axis(axis, &of_axis(named_axis(index, several))))
            .chain(self.grown())
    }

    fn of_axis(&self, axis: &AxisDrift, of: &str) -> Vec<Beyond> {
        let DriftCheck {
            force,
            displacement,
            over,
            ..
        } = self.check;
        let (forces, lengths) = (Dimension::FORCE, Dimension::LENGTH);
        let mut found = Vec::new();
        let mut assess =
            |what: &str, change: f64, allowed: Option<f64>, of_force: bool, dimension| {
                // NaN is outside every interval.
                let Some(allowed) =
                    allowed.filter(|allowed| change.is_nan() || change.abs() > *allowed)
                else {
                    return;
                };
                let reason = format!(
                    "{what} by {} (limit {})",
                    readable(change, dimension),
                    stated(allowed, dimension)
                );
                found.push(Beyond { of_force, reason });
            };
        if let Some((by_force, by_displacement)) = axis.change() {
            assess(
                &format!("the zero of the force{of} drifted"),
                by_force,
                Some(force),
                true,
                forces,
            );
            assess(
                &format!("the zero of the displacement{of} drifted"),
                by_displacement,
                displacement,
                false,
                lengths,
            );
        }
        let at_rest = |what: &str| format!("at rest the {what}{of} drifted");
        assess(
            &at_rest("force"),
            axis.before.force_slope * over,
            Some(force),
            true,
            forces,
        );
        assess(
            &at_rest("displacement"),
            axis.before.displacement_slope * over,
            displacement,
            false,
            lengths,
        );
        found
    }

    fn grown(&self) -> Option<Beyond> {
        let (grown, allowed) = (self.held.grown?, self.check.force);
        (grown.is_nan() || grown > allowed).then(|| Beyond {
            of_force: true,
            reason: format!(
                "the force increased by {} in a dwell in which a specimen can only relax (limit {})",
                readable(grown, Dimension::FORCE),
                stated(allowed, Dimension::FORCE)
            ),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ZeroAfter;

    fn zero(force: f64, displacement: f64) -> Zero {
        Zero {
            time: 0.0,
            force,
            displacement,
            force_slope: 0.0,
            displacement_slope: 0.0,
        }
    }

    fn drift(before: Zero, after: Option<Zero>, grown: Option<f64>) -> Drift {
        let check = DriftCheck {
            force: 2.0,
            displacement: Some(1e-5),
            over: 5.0,
            after: ZeroAfter::Start,
        };
        Drift {
            check,
            axes: vec![AxisDrift { before, after }],
            held: Held {
                grown,
                ..Held::default()
            },
        }
    }

    fn reason(drift: &Drift) -> String {
        drift
            .beyond()
            .next()
            .map_or_else(String::new, |beyond| beyond.reason)
    }

    #[test]
    fn a_change_is_judged_by_its_size_and_what_is_no_number_is_beyond() {
        assert_eq!(
            drift(zero(1.0, 0.0), Some(zero(-1.0, 1e-5)), Some(2.0))
                .beyond()
                .next(),
            None
        );
        let shifted = drift(zero(1.0, 0.0), Some(zero(-1.1, 0.0)), None);
        assert_eq!(
            reason(&shifted),
            "the zero of the force drifted by −2.100 N (limit 2 N)"
        );
        let moved = drift(zero(0.0, 0.0), Some(zero(0.0, 2e-5)), None)
            .beyond()
            .next()
            .unwrap();
        assert!(
            !moved.of_force && moved.reason.contains("displacement drifted by 20"),
            "{}",
            moved.reason
        );
        assert!(
            drift(zero(0.0, 0.0), Some(zero(f64::NAN, 0.0)), None)
                .beyond()
                .next()
                .is_some()
        );
    }

    #[test]
    fn without_a_zero_after_the_run_rest_and_holds_are_judged() {
        let sloping = Zero {
            force_slope: 0.5,
            ..zero(0.0, 0.0)
        };
        assert!(
            reason(&drift(sloping, None, None)).starts_with("at rest the force drifted by 2.500 N")
        );
        assert_eq!(
            drift(
                Zero {
                    force_slope: 0.4,
                    ..sloping
                },
                None,
                None
            )
            .beyond()
            .next(),
            None
        );
        assert!(reason(&drift(zero(0.0, 0.0), None, Some(2.5))).contains("can only relax"));
    }

    #[test]
    fn of_several_axes_the_one_is_named() {
        let mut two = drift(zero(0.0, 0.0), Some(zero(0.0, 0.0)), None);
        two.axes.push(AxisDrift {
            before: zero(0.0, 0.0),
            after: Some(zero(3.0, 0.0)),
        });
        assert!(
            reason(&two).starts_with("the zero of the force of axis 2 drifted by 3"),
            "{}",
            reason(&two)
        );
    }
}
