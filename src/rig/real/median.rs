//! One value for repeated readings of one quantity. In: their values. Out: the representative one. It knows no rig.

use crate::safety::failpoint::{Guarding, on};

/// The median, which a single spike does not change; for an even count the mean of the middle two.
pub(super) fn representative(mut values: Vec<f64>) -> f64 {
    if !on(Guarding::Median) {
        return values[0];
    }
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len() % 2 == 1 {
        values[middle]
    } else {
        f64::midpoint(values[middle - 1], values[middle])
    }
}
