//! Tests of all behaviours, and their common helpers.

use super::*;

/// ∫ R dX from `from` (the present displacement) through `turns`, by trapezia of at most `step` \[m\], in \[J\].
pub fn energy_along(model: &mut impl RestoringForce, from: f64, turns: &[f64], step: f64) -> f64 {
    let (mut position, mut force, mut energy) = (from, model.move_to(from), 0.0);
    for to in turns {
        let count = ((to - position).abs() / step).ceil().max(1.0);
        let (start, mut done) = (position, 0.0);
        while done < count {
            done += 1.0;
            let next = if done == count {
                *to
            } else {
                start + (to - start) * (done / count)
            };
            let next_force = model.move_to(next);
            energy += 0.5 * (force + next_force) * (next - position);
            (position, force) = (next, next_force);
        }
    }
    energy
}
