//! An axis: range, ticks and title. In: the range of the data in SI, and the quantity. Out: an [`Axis`] in a readable unit. It
//! knows no pixels.

use std::ops::RangeInclusive;

use super::chart::{End, Quantity};
use psd_text::units::display::{minus, typeset, unit};

/// A scaled axis; `low..high` and the ticks are in the unit of the axis.
pub(super) struct Axis {
    pub low: f64,
    pub high: f64,
    pub ticks: Vec<(f64, String)>,
    /// `Displacement (mm)`
    pub title: String,
    /// The unit of the axis in SI.
    pub factor: f64,
}

/// Fraction of an axis that the width of a line covers.
const LINE_WIDTH: f64 = 0.004;

impl Axis {
    /// An axis that holds every finite one of `values` (SI), with about `wanted` ticks.
    pub fn over(quantity: &Quantity, values: impl Iterator<Item = f64>, wanted: u32) -> Self {
        if !quantity.names.is_empty() {
            return Self::of_names(quantity);
        }
        let start = if quantity.from_zero {
            Some((0.0, 0.0))
        } else {
            None
        };
        let range = values.filter(|value| value.is_finite()).fold(
            start,
            |range: Option<(f64, f64)>, value| {
                Some(range.map_or((value, value), |(low, high)| {
                    (low.min(value), high.max(value))
                }))
            },
        );
        let (low, high) = range.unwrap_or((0.0, 1.0));
        let (unit, factor) = unit(low.abs().max(high.abs()), quantity.dimension);
        let (mut low, mut high) = (low / factor, high / factor);
        if high - low <= f64::EPSILON * high.abs().max(low.abs()) {
            // One value only: it is in the middle of the axis.
            let half = if high == 0.0 { 1.0 } else { 0.5 * high.abs() };
            (low, high) = (low - half, high + half);
        }
        // A value below zero by less than the width of a line needs no tick.
        if quantity.from_zero && low < 0.0 && -low < LINE_WIDTH * high {
            low = 0.0;
        }
        let step = nice_step((high - low) / f64::from(wanted));
        let step = if quantity.end == End::Whole {
            step.max(1.0)
        } else {
            step
        };
        if quantity.end != End::Data {
            let margin = 0.025 * (high - low);
            (low, high) = (
                if low == 0.0 { 0.0 } else { low - margin },
                if high == 0.0 { 0.0 } else { high + margin },
            );
        }
        if quantity.end == End::Tick {
            (low, high) = ((low / step).floor() * step, (high / step).ceil() * step);
        }
        let title = if unit.is_empty() {
            quantity.name.to_string()
        } else {
            format!("{} ({})", quantity.name, typeset(&unit))
        };
        Self {
            low,
            high,
            ticks: ticks(low..=high, step),
            title,
            factor,
        }
    }

    /// An axis with a name at every whole number.
    fn of_names(quantity: &Quantity) -> Self {
        let ticks: Vec<(f64, String)> = (1_u32..)
            .map(f64::from)
            .zip(quantity.names.iter().cloned())
            .collect();
        let last = ticks.last().map_or(0.0, |(at, _)| *at);
        Self {
            low: 0.5,
            high: last + 0.5,
            ticks,
            title: quantity.name.to_string(),
            factor: 1.0,
        }
    }

    /// Position of an SI value on the axis, 0 at its low end and 1 at its high end.
    pub fn fraction(&self, value: f64) -> f64 {
        (value / self.factor - self.low) / (self.high - self.low)
    }
}

/// The next of 1, 2, 5 × 10ⁿ at or above `rough`.
fn nice_step(rough: f64) -> f64 {
    let power = 10_f64.powf(rough.log10().floor());
    let lead = rough / power;
    let nice = if lead <= 1.000_001 {
        1.0
    } else if lead <= 2.000_001 {
        2.0
    } else if lead <= 5.000_001 {
        5.0
    } else {
        10.0
    };
    nice * power
}

fn ticks(range: RangeInclusive<f64>, step: f64) -> Vec<(f64, String)> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "decimals of a step, bounded to 0..=12"
    )]
    let decimals = (-(step * 1.000_001).log10().floor()).clamp(0.0, 12.0) as usize;
    let first = (range.start() / step - 1e-9).ceil();
    (0_u32..64)
        .map(|index| (first + f64::from(index)) * step)
        .take_while(|tick| *tick <= range.end() + 1e-9 * step)
        .map(|tick| {
            // Rounding to the decimals of the step removes the sign of a negative zero.
            let tick = if tick.abs() < 1e-9 * step { 0.0 } else { tick };
            (tick, minus(&format!("{tick:.decimals$}")))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd_text::units::Dimension;

    fn labels(quantity: &Quantity, low: f64, high: f64) -> Vec<String> {
        Axis::over(quantity, [low, high].into_iter(), 5)
            .ticks
            .into_iter()
            .map(|(_, label)| label)
            .collect()
    }

    #[test]
    fn ticks_are_round_numbers_in_a_readable_unit() {
        let force = Quantity::of("Force", Dimension::FORCE);
        assert_eq!(
            labels(&force, -1_000.0, 2_300.0),
            ["−2", "−1", "0", "1", "2", "3"]
        );
        assert_eq!(
            Axis::over(&force, [2_300.0].into_iter(), 5).title,
            "Force (kN)"
        );
        assert_eq!(labels(&Quantity::time(), 0.0, 0.0134), ["0", "5", "10"]);
        assert_eq!(
            labels(&Quantity::of("Share", Dimension::NUMBER), 0.0, 0.47),
            ["0.0", "0.1", "0.2", "0.3", "0.4", "0.5"]
        );
    }

    #[test]
    fn a_value_just_below_zero_needs_no_tick() {
        let energy = Quantity::of("Energy", Dimension::ENERGY);
        assert_eq!(labels(&energy, -0.01, 5.0)[0], "0");
        assert_eq!(labels(&energy, -0.1, 5.0)[0], "−2");
    }

    #[test]
    fn names_are_at_whole_numbers() {
        let names = Quantity {
            names: vec!["mass".to_owned(), "speed".to_owned()],
            ..Quantity::of("", Dimension::NUMBER)
        };
        let axis = Axis::over(&names, [7.0].into_iter(), 5);
        assert_eq!([axis.low, axis.high], [0.5, 2.5]);
        assert_eq!(axis.ticks[1], (2.0, "speed".to_owned()));
        assert_eq!(axis.fraction(1.5), 0.5);
    }

    #[test]
    fn a_constant_and_no_data_have_an_axis_too() {
        for axis in [
            Axis::over(&Quantity::time(), [2.0].into_iter(), 5),
            Axis::over(&Quantity::time(), std::iter::empty(), 5),
            Axis::over(
                &Quantity::of("Force", Dimension::FORCE),
                [f64::NAN, 0.0].into_iter(),
                5,
            ),
        ] {
            assert!(axis.low < axis.high && axis.ticks.len() >= 2);
        }
    }
}
