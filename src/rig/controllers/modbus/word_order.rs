//! The word order of a drive: confirmed by a reading, or not yet. In: the registers of every reading, and those of every target before it
//! is sent. Out: the target that may be sent. Readings of exactly 0 are the same number in both orders, but no target is: in the wrong
//! order 0.1 mm is 10^8 mm. Every motion of a drive passes here, whatever commands it.

use super::codec;
use crate::controllers::DeviceFault;
use crate::safety::failpoint::{Guarding, on};
use psd_plan::{Interval, Limits, ModbusNumber};
use psd_text::units::Dimension;
use psd_text::units::display::plain;

/// Smaller than any non-zero reading: the value of a float whose words are swapped.
pub(super) const IMPLAUSIBLY_SMALL: f64 = 1e-30;
/// Nearer to zero no sensor resolves \[m\] or \[N\]: such a reading shows no order.
const RESOLVED: f64 = 1e-9;
/// A value this many times beyond its limit is no value of this rig.
const BEYOND_LIMITS: f64 = 10.0;

/// What a register measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Measured {
    Position,
    Force,
}

/// A number in its registers, and the unit of the number: \[m\] or \[N\].
#[derive(Clone, Copy, Debug)]
pub(super) struct Registers<'a> {
    pub words: &'a [u16],
    pub unit: f64,
}

/// The word order of the numbers of one drive.
#[derive(Clone, Debug)]
pub(super) struct WordOrder {
    number: ModbusNumber,
    /// A number that was read is possible in the order of the plan alone.
    confirmed: bool,
    /// The last position, in the order of the plan and in the other order \[m\].
    position: Option<(f64, f64)>,
    limits: Option<Limits>,
}

impl WordOrder {
    pub(super) const fn of(number: ModbusNumber) -> Self {
        Self {
            number,
            confirmed: codec::other_order(number).is_none(),
            position: None,
            limits: None,
        }
    }

    /// The limits of this rig, in the coordinate of the drive.
    pub(super) const fn limited(&mut self, limits: Limits) {
        self.limits = Some(limits);
    }

    /// Whether a target may still have to be rounded.
    pub(super) fn is_open(&self) -> bool {
        !self.confirmed && on(Guarding::WordOrder)
    }

    /// A number was read that is plausible in the order of the plan; `plausible` says whether another value is.
    pub(super) fn read(
        &mut self,
        measured: Measured,
        registers: Registers<'_>,
        plausible: impl Fn(f64) -> bool,
    ) {
        let limit = match (self.limits, measured) {
            (None, _) => Interval::ALL,
            (Some(limits), Measured::Position) => limits.displacement,
            (Some(limits), Measured::Force) => limits.force,
        };
        let (own, other) = self.both(registers);
        if measured == Measured::Position {
            self.position = own.zip(other);
        }
        let possible =
            |value: f64| plausible(value) && (own == other || !far_outside(limit, value));
        let differs = own.is_some_and(|own| own.abs() >= RESOLVED && limit.contains(own));
        self.confirmed |= differs && !other.is_some_and(possible);
    }

    /// The target that may be sent for this one \[m\]: itself, or without a confirmed order the nearest that is harmless in both orders.
    /// `registers` gives the registers of a target, and their value.
    ///
    /// # Errors
    /// Neither may be sent.
    pub(super) fn target(
        &self,
        target: f64,
        unit: f64,
        registers: impl Fn(f64) -> Result<(Vec<u16>, f64), DeviceFault>,
    ) -> Result<f64, DeviceFault> {
        if !self.is_open() {
            return Ok(target);
        }
        let of = |target| {
            let (words, value) = registers(target)?;
            let words = Registers {
                words: &words,
                unit,
            };
            Ok((self.is_harmless(words), value, self.both(words).1))
        };
        let (harmless, _, other) = of(target)?;
        if harmless {
            return Ok(target);
        }
        if matches!(self.number, ModbusNumber::Float32 { .. }) {
            let (harmless, value, _) = of(codec::nearest_without_low_word(target / unit) * unit)?;
            if harmless {
                return Ok(value);
            }
        }
        let other = other.map_or_else(
            || "no number".to_owned(),
            |other| plain(other, Dimension::LENGTH, 3),
        );
        Err(DeviceFault::Unfit(format!(
            "its readings do not show the order of the two words, and in the other order the target {} is {other}. Move the drive by its \
             own controls until its position is not 0, a few steps of its resolution are enough, then start again",
            plain(target, Dimension::LENGTH, 6)
        )))
    }

    /// Whether a drive with the other order moves no farther than one with this order, and stays inside its limits.
    fn is_harmless(&self, target: Registers<'_>) -> bool {
        let ((Some(own), Some(other)), Some((position, other_position))) =
            (self.both(target), self.position)
        else {
            return false;
        };
        let inside = self
            .limits
            .is_none_or(|limits| limits.displacement.contains(other));
        // A float that differs from zero by less than any reading is zero.
        let travel = (own - position).abs().max(IMPLAUSIBLY_SMALL);
        inside && (other - other_position).abs() <= travel
    }

    /// A number in the order of the plan, and in the other order.
    fn both(&self, Registers { words, unit }: Registers<'_>) -> (Option<f64>, Option<f64>) {
        let value = |number| codec::from_words(number, words).map(|value| value * unit);
        (
            value(self.number),
            codec::other_order(self.number).and_then(value),
        )
    }
}

/// Whether a value is too far outside a limit to be one of this rig, also of an overloaded one.
fn far_outside(limit: Interval, value: f64) -> bool {
    value.abs() > BEYOND_LIMITS * limit.low.abs().max(limit.high.abs())
}
