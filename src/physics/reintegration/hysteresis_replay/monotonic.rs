//! Segments of a record without a reversal. In: readings, or the move to each. Out: the readings at their ends, and their directions. It
//! knows no force.

use super::Reading;

/// Readings at the ends of each segment without a reversal, and its direction.
pub(super) fn monotonic_branches(readings: &[Reading]) -> Vec<(usize, usize, f64)> {
    let moved = readings.windows(2).map(|two| two[1].target - two[0].target);
    branches_of(std::iter::once(0.0).chain(moved))
}

/// The same from the move to each reading: a displacement change, or a velocity.
pub(super) fn branches_of(travel: impl Iterator<Item = f64>) -> Vec<(usize, usize, f64)> {
    let mut found = Vec::new();
    let (mut begin, mut last, mut direction) = (0, 0, 0.0);
    for (step, moved) in travel.enumerate() {
        last = step;
        if moved * direction < 0.0 {
            found.push((begin, step - 1, direction));
            begin = step - 1;
        }
        if moved != 0.0 {
            direction = moved.signum();
        }
    }
    found.push((begin, last, direction));
    found
}
