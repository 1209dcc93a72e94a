//! Comparison of two rows of numbers. In: both, a rule and a scale. Out: one finding for all numbers that changed.

use super::finding::{Change, Count, Moved, RowRef};
use super::tolerance::Rule;
use psd_physics::statistics::samples::peak;
use psd_text::units::Dimension;

/// One number; None if both are within the tolerance.
pub(super) fn single(
    was: Option<f64>,
    is: Option<f64>,
    dimension: Dimension,
    rule: Rule,
    scale: f64,
) -> Option<Change> {
    let near = match (was, is) {
        (Some(was), Some(is)) => rule.at_scale(scale).is_near(was, is),
        (None, None) => true,
        _ => false,
    };
    (!near).then_some(Change::Moved(Moved {
        dimension,
        was,
        is,
        rule,
        scale,
        largest: None,
        first: None,
        count: None,
    }))
}

/// Many numbers, pair by pair; the finding shows the largest change. A number that appeared or disappeared counts as the largest.
pub(super) fn many(
    pairs: &[(Option<f64>, Option<f64>)],
    dimension: Dimension,
    rule: Rule,
    scale: f64,
    row_ref: impl Fn(usize) -> RowRef,
) -> Option<Change> {
    let mut moved = 0;
    let mut first = None;
    let mut largest: Option<(usize, f64)> = None;
    for (row, (was, is)) in pairs.iter().enumerate() {
        if single(*was, *is, dimension, rule, scale).is_none() {
            continue;
        }
        moved += 1;
        first = first.or(Some(row));
        let by = match (was, is) {
            (Some(was), Some(is)) if (is - was).is_finite() => (is - was).abs(),
            _ => f64::INFINITY,
        };
        if largest.is_none_or(|(_, most)| by > most) {
            largest = Some((row, by));
        }
    }
    let (row, _) = largest?;
    let (was, is) = pairs[row];
    let count = Some(Count {
        moved,
        of: pairs.len(),
    });
    Some(Change::Moved(Moved {
        dimension,
        was,
        is,
        rule,
        scale,
        largest: Some(row_ref(row)),
        first: first.map(row_ref),
        count,
    }))
}

/// The largest absolute value of some numbers.
pub(super) fn scale(values: impl Iterator<Item = f64>) -> f64 {
    peak(values.filter(|value| value.is_finite()))
}
