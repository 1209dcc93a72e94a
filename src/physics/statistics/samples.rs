//! Mean, standard deviation and peak of samples. In: numbers. Out: numbers. It knows no instrument.

use std::borrow::Borrow;

/// Arithmetic mean; NaN without values.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "far fewer values than 2^53")]
pub fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len();
    values.sum::<f64>() / count as f64
}

/// Peak absolute value; 0 without values.
#[must_use]
pub fn peak(values: impl IntoIterator<Item: Borrow<f64>>) -> f64 {
    let sizes = values.into_iter().map(|value| value.borrow().abs());
    sizes.fold(0.0, f64::max)
}

/// Standard deviation of the samples; 0 for one.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "far fewer values than 2^53")]
pub fn scatter(values: impl ExactSizeIterator<Item = f64>, mean: f64) -> f64 {
    match values.len() {
        0 | 1 => 0.0,
        count => {
            (values.map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1) as f64).sqrt()
        }
    }
}
