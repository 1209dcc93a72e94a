//! Shear buildings: floors of a frame, each connected to the one below by its storey. In: storey stiffnesses, forces of the floors. Out:
//! stiffness matrices, storey drifts, shears. Floor 0 here is the lowest that moves.

use super::matrix::SymmetricBand;
use crate::statistics::samples::peak;

/// K of a shear building from the total stiffness of each storey \[N/m\], from the ground up (Melo et al. 2006, Fig. 1: two columns k
/// make 2k): `K_ii = k_i + k_(i+1)`, `K_(i+1,i) = −k_(i+1)`.
#[must_use]
pub fn storey_stiffness(stiffnesses: &[f64]) -> SymmetricBand {
    let mut matrix = SymmetricBand::zero(stiffnesses.len(), 1);
    set_storeys(stiffnesses, &mut matrix);
    matrix
}

/// The same into a matrix of half bandwidth 1.
pub(crate) fn set_storeys(stiffnesses: &[f64], matrix: &mut SymmetricBand) {
    let diagonal = matrix.band_mut(0);
    diagonal.copy_from_slice(stiffnesses);
    for (entry, above) in diagonal.iter_mut().zip(stiffnesses.iter().skip(1)) {
        *entry += above;
    }
    if stiffnesses.len() > 1 {
        for (entry, above) in matrix
            .band_mut(1)
            .iter_mut()
            .zip(stiffnesses.iter().skip(1))
        {
            *entry = -above;
        }
    }
}

/// The storey stiffnesses of K; None if it is not that of a shear building, to `1e-9` of its largest entry.
#[must_use]
pub fn storeys_of(stiffness: &SymmetricBand) -> Option<Vec<f64>> {
    let order = stiffness.order();
    if order == 0 || stiffness.half_bandwidth() > 1 {
        return None;
    }
    let mut stiffnesses: Vec<f64> = (1..order).map(|i| -stiffness.entry(i, i - 1)).collect();
    stiffnesses.insert(
        0,
        stiffness.entry(0, 0) - stiffnesses.first().copied().unwrap_or(0.0),
    );
    let largest = peak((0..order).map(|i| stiffness.entry(i, i)));
    let whole = storey_stiffness(&stiffnesses);
    let same =
        (0..order).all(|i| (whole.entry(i, i) - stiffness.entry(i, i)).abs() <= 1e-9 * largest);
    (same && stiffnesses.iter().all(|stiffness| *stiffness >= 0.0)).then_some(stiffnesses)
}

/// Raises each entry to the magnitude of its value, for the largest over several steps.
pub fn widen(largest: &mut [f64], values: &[f64]) {
    for (largest, value) in largest.iter_mut().zip(values) {
        *largest = largest.max(value.abs());
    }
}

/// Drift of each storey \[m\]: displacement of its floor relative to that of the floor below.
pub fn drifts(displacement: &[f64], drift: &mut [f64]) {
    let mut below = 0.0;
    for (drift, displacement) in drift.iter_mut().zip(displacement) {
        *drift = displacement - below;
        below = *displacement;
    }
}

/// Whether the drift of a storey is at least `limit` \[m\] in absolute value.
#[must_use]
pub(crate) fn drifts_to(displacement: &[f64], limit: f64) -> bool {
    let mut below = 0.0;
    displacement
        .iter()
        .any(|floor| (floor - std::mem::replace(&mut below, *floor)).abs() >= limit)
}

/// Shear of each storey \[N\]: the sum of the restoring forces of the floors that it carries.
pub fn shears(restoring_force: &[f64], shear: &mut [f64]) {
    let mut above = 0.0;
    for (shear, force) in shear.iter_mut().zip(restoring_force).rev() {
        above += force;
        *shear = above;
    }
}

/// Restoring force of each floor \[N\], from the shears of its own storey and of the one above.
pub fn floor_forces(shear: &[f64], restoring_force: &mut [f64]) {
    let Some((top, _)) = shear.split_last() else {
        return;
    };
    for (force, shears) in restoring_force.iter_mut().zip(shear.windows(2)) {
        *force = shears[0] - shears[1];
    }
    restoring_force[shear.len() - 1] = *top;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Storeys of 3 and 2: the matrix of the textbooks.
    #[test]
    fn two_storeys_by_hand() {
        let matrix = storey_stiffness(&[3.0, 2.0]);
        assert_eq!(
            [
                matrix.entry(0, 0),
                matrix.entry(0, 1),
                matrix.entry(1, 0),
                matrix.entry(1, 1)
            ],
            [5.0, -2.0, -2.0, 2.0]
        );
        assert_eq!(storeys_of(&matrix), Some(vec![3.0, 2.0]));
        assert_eq!(storeys_of(&storey_stiffness(&[7.0])), Some(vec![7.0]));
        let mut coupled = matrix;
        coupled.set(1, 1, 2.5);
        assert_eq!(storeys_of(&coupled), None);
    }

    /// K x equals the forces from the storey drifts.
    #[test]
    fn drifts_and_shears_agree_with_the_matrix() {
        let stiffnesses = [3.0, 2.0, 5.0];
        let displacement = [0.5, 0.25, 1.0];
        let (mut drift, mut shear, mut force, mut product) =
            ([0.0; 3], [0.0; 3], [0.0; 3], [0.0; 3]);
        drifts(&displacement, &mut drift);
        assert_eq!(drift, [0.5, -0.25, 0.75]);
        for ((shear, drift), stiffness) in shear.iter_mut().zip(&drift).zip(&stiffnesses) {
            *shear = drift * stiffness;
        }
        floor_forces(&shear, &mut force);
        storey_stiffness(&stiffnesses).mul_into(&displacement, &mut product);
        assert_eq!(force, product);
        let mut again = [0.0; 3];
        shears(&force, &mut again);
        assert_eq!(again, shear);
    }
}
