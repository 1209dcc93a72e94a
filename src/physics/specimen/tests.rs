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

/// A model of plain numbers is read and described by the same names.
#[test]
fn a_model_of_numbers_is_the_model_of_its_numbers() {
    for word in ["elastic", "bouc_wen", "degrading", "bolted"] {
        let read = Behaviour::of_numbers(word, |name| {
            let bytes = name.bytes().map(f64::from);
            Some(bytes.sum())
        });
        let read = read.expect(word);
        let (own, numbers) = read.numbers().expect(word);
        assert_eq!(own, word);
        let again = Behaviour::of_numbers(word, |name| {
            numbers
                .iter()
                .find(|(own, _)| *own == name)
                .map(|found| found.1)
        });
        assert_eq!(again, Some(read));
    }
}
