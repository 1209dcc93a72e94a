//! The coordinate of one axis: conversion of positions and forces between its devices and the plan. In: numbers of one
//! side. Out: those of the other. It knows no device and no run log.

use psd_plan::{Interval, Limits};

/// Direction and zero of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Coordinate {
    /// +1 or −1.
    pub(super) sign: f64,
    /// The position of the plan's zero in the device's own coordinate \[m\].
    pub(super) datum: f64,
}

impl Coordinate {
    /// For an axis with the same zero as the plan.
    pub(super) const fn of_sign(sign: f64) -> Self {
        Self { sign, datum: 0.0 }
    }

    /// A position of the device \[m\], in the plan's coordinate.
    pub(super) fn in_plan(self, position: f64) -> f64 {
        // With a different zero, the zero is read as 0 and not as −0.
        if self.datum == 0.0 {
            self.sign * position
        } else {
            self.sign * (position - self.datum) + 0.0
        }
    }

    /// A position of the plan \[m\], in the device's coordinate.
    pub(super) fn at_device(self, position: f64) -> f64 {
        let turned = self.sign * position;
        // The sum of 0 and −0 would be 0, which is encoded in different bytes.
        if self.datum == 0.0 {
            turned
        } else {
            turned + self.datum
        }
    }

    /// A force or a velocity, converted from either side to the other.
    pub(super) fn turned(self, value: f64) -> f64 {
        self.sign * value
    }

    /// Limits of the plan in the coordinate of the device.
    pub(super) fn limits_at_device(self, limits: &Limits) -> Limits {
        let between = |ends: [f64; 2]| Interval {
            low: ends[0].min(ends[1]),
            high: ends[0].max(ends[1]),
        };
        let (stroke, force) = (limits.displacement, limits.force);
        Limits {
            displacement: between([stroke.low, stroke.high].map(|end| self.at_device(end))),
            force: between([force.low, force.high].map(|end| self.turned(end))),
            ..*limits
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reversed_axis_with_another_zero_has_its_own_positions_and_limits() {
        let axis = Coordinate {
            sign: -1.0,
            datum: -0.5,
        };
        assert_eq!((axis.at_device(0.25), axis.in_plan(-0.75)), (-0.75, 0.25));
        assert_eq!(
            (axis.in_plan(-0.5).to_bits(), axis.turned(3.0)),
            (0.0_f64.to_bits(), -3.0)
        );
        let limits = Limits {
            displacement: Interval {
                low: -0.25,
                high: 2.0,
            },
            force: Interval {
                low: -1.0,
                high: f64::INFINITY,
            },
            ..Limits::NONE
        };
        let own = axis.limits_at_device(&limits);
        assert_eq!(
            own.displacement,
            Interval {
                low: -2.5,
                high: -0.25
            }
        );
        assert_eq!(
            own.force,
            Interval {
                low: f64::NEG_INFINITY,
                high: 1.0
            }
        );
        assert_eq!(own.speed, limits.speed);
    }

    #[test]
    fn an_axis_with_its_own_zero_changes_no_bit_but_its_sign() {
        for sign in [1.0, -1.0] {
            for position in [0.0_f64, -0.0, 1.25e-3] {
                let axis = Coordinate::of_sign(sign);
                assert_eq!(
                    axis.at_device(position).to_bits(),
                    (sign * position).to_bits()
                );
                assert_eq!(
                    axis.in_plan(position).to_bits(),
                    (sign * position).to_bits()
                );
            }
        }
    }
}
