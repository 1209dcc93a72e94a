//! The difference of two runs, and the spread of several.

use super::ComparedRow;
use crate::golden::FLOOR;

/// The second of two runs minus the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// SI.
    pub absolute: f64,
    /// Relative to the first; None if that is 0 within rounding.
    pub relative: Option<f64>,
    /// Relative to the combined standard uncertainty √(u₁² + u₂²), if both are known and not both 0.
    pub in_uncertainties: Option<f64>,
}

impl Difference {
    /// The difference of a row of two runs that both have a value.
    #[must_use]
    pub fn of(row: &ComparedRow) -> Option<Self> {
        let [Some(first), Some(second)] = row.cells.as_slice() else {
            return None;
        };
        let (was, is) = (first.value?, second.value?);
        let absolute = is - was;
        let combined = first
            .u
            .zip(second.u)
            .map(|(first, second)| first.hypot(second))
            .filter(|u| *u > 0.0);
        let relative = (was.abs() > FLOOR).then(|| absolute / was.abs());
        Some(Self {
            absolute,
            relative,
            in_uncertainties: combined.map(|u| absolute / u),
        })
    }
}

/// The mean of several runs and their spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Runs with a value.
    pub count: usize,
    pub mean: f64,
    /// Sample standard deviation, divisor n − 1; None for one value.
    pub deviation: Option<f64>,
}

impl Spread {
    /// The spread of the existing values; None if there are none.
    #[must_use]
    pub fn of(row: &ComparedRow) -> Option<Self> {
        Self::of_values(
            &row.cells
                .iter()
                .flatten()
                .filter_map(|cell| cell.value)
                .collect::<Vec<f64>>(),
        )
    }

    pub(super) fn of_values(values: &[f64]) -> Option<Self> {
        #[expect(clippy::cast_precision_loss, reason = "a few runs")]
        let count = values.len() as f64;
        if values.is_empty() {
            return None;
        }
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        Some(Self {
            count: values.len(),
            mean,
            deviation: (count > 1.0).then(|| (squares / (count - 1.0)).sqrt()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spread_is_that_of_a_sample() {
        // 2, 4, 4, 4, 5, 5, 7, 9: mean 5, sum of squares 32, divisor 7.
        let spread = Spread::of_values(&[2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]).unwrap();
        assert_eq!(
            (spread.count, spread.mean, spread.deviation),
            (8, 5.0, Some((32.0_f64 / 7.0).sqrt()))
        );
        assert_eq!(Spread::of_values(&[3.0]).unwrap().deviation, None);
        assert_eq!(Spread::of_values(&[]), None);
    }
}
