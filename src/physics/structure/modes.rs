//! Natural modes of a frame. In: mass and stiffness. Out: periods, shapes, participation in a ground motion.

use nalgebra::{DMatrix, SymmetricEigen};
use std::f64::consts::PI;
use thiserror::Error;

use super::matrix::{BandFactor, NotPositiveDefinite, SymmetricBand};

/// The modes, the longest period first.
#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    /// \[s\]
    pub periods: Vec<f64>,
    /// One per mode, scaled so that its entry of the largest absolute value is +1.
    pub shapes: Vec<Vec<f64>>,
    /// Γ = φᵀMι / φᵀMφ under a ground motion that moves every mass equally, for the scaled shape.
    pub participation: Vec<f64>,
    /// (φᵀMι)² / (φᵀMφ · ιᵀMι): fractions of the mass that sum to 1.
    pub effective_mass: Vec<f64>,
}

/// The reason why there are no modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum ModesError {
    #[error("no degree of freedom")]
    Empty,
    #[error("mass is of order {mass}, stiffness of order {stiffness}")]
    Orders { mass: usize, stiffness: usize },
    #[error("the mass matrix is {0}")]
    Mass(NotPositiveDefinite),
    #[error("the stiffness matrix is {0}")]
    Stiffness(NotPositiveDefinite),
    #[error("the eigenvalues did not converge")]
    NoConvergence,
}

impl Modes {
    /// 2π/T of a mode \[rad/s\].
    #[must_use]
    pub fn angular_frequency(&self, mode: usize) -> f64 {
        2.0 * PI / self.periods[mode]
    }

    /// The period that an explicit integrator has to resolve \[s\].
    #[must_use]
    pub fn shortest_period(&self) -> f64 {
        self.periods.last().copied().unwrap_or(f64::INFINITY)
    }

    /// Critical time step of many degrees of freedom \[s\]: a tenth of the shortest period (Melo et al. 2006, eq. 7).
    #[must_use]
    pub fn critical_time_step(&self) -> f64 {
        self.shortest_period() / 10.0
    }
}

/// Largest number of sweeps of the eigenvalue iteration per row: QR converges in two or three.
const SWEEPS: usize = 100;

/// K φ = ω² M φ by the symmetric eigenproblem of L⁻¹ K L⁻ᵀ, M = L Lᵀ: n³, once before a run.
///
/// # Errors
/// If a matrix is not positive definite, or the two have different orders.
pub fn modes(mass: &SymmetricBand, stiffness: &SymmetricBand) -> Result<Modes, ModesError> {
    let order = mass.order();
    if order == 0 {
        return Err(ModesError::Empty);
    }
    if stiffness.order() != order {
        return Err(ModesError::Orders {
            mass: order,
            stiffness: stiffness.order(),
        });
    }
    BandFactor::new(mass).map_err(ModesError::Mass)?;
    BandFactor::new(stiffness).map_err(ModesError::Stiffness)?;
    let dense = |band: &SymmetricBand| DMatrix::from_fn(order, order, |i, j| band.entry(i, j));
    let lower = dense(mass)
        .cholesky()
        .ok_or(ModesError::Mass(NotPositiveDefinite { row: 0 }))?
        .unpack();
    let half = lower
        .solve_lower_triangular(&dense(stiffness))
        .ok_or(ModesError::NoConvergence)?;
    let whole = lower
        .solve_lower_triangular(&half.transpose())
        .ok_or(ModesError::NoConvergence)?;
    // Rounding makes the two halves differ in the last digit: their mean is symmetric.
    let symmetric = (&whole + whole.transpose()) * 0.5;
    let eigen = SymmetricEigen::try_new(symmetric, f64::EPSILON, SWEEPS * order)
        .ok_or(ModesError::NoConvergence)?;
    let vectors = lower
        .transpose()
        .solve_upper_triangular(&eigen.eigenvectors)
        .ok_or(ModesError::NoConvergence)?;

    let mut rising: Vec<usize> = (0..order).collect();
    rising.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
    let everywhere = vec![1.0; order];
    let total = mass.form(&everywhere, &everywhere);
    let mut found = Modes {
        periods: vec![],
        shapes: vec![],
        participation: vec![],
        effective_mass: vec![],
    };
    for mode in rising {
        let vector: Vec<f64> = vectors.column(mode).iter().copied().collect();
        let largest = vector.iter().copied().fold(0.0, |largest: f64, entry| {
            if entry.abs() > largest.abs() {
                entry
            } else {
                largest
            }
        });
        let shape: Vec<f64> = vector.iter().map(|entry| entry / largest).collect();
        // Rayleigh's quotient of the shape: its error is the square of the shape's.
        let (own, shared) = (mass.form(&shape, &shape), mass.form(&shape, &everywhere));
        let squared = stiffness.form(&shape, &shape) / own;
        if !(squared > 0.0 && squared.is_finite()) {
            return Err(ModesError::NoConvergence);
        }
        found.periods.push(2.0 * PI / squared.sqrt());
        found.participation.push(shared / own);
        found.effective_mass.push(shared * shared / (own * total));
        found.shapes.push(shape);
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::super::shear_building::storey_stiffness;
    use super::*;

    /// Masses 2, 1 and storeys 2, 1: det(K − ω²M) = (3 − 2ω²)(1 − ω²) − 1 = (2ω² − 1)(ω² − 2), and φ₂ = (3 − 2ω²)φ₁:
    /// ω² = ½ and 2, shapes (½, 1) and (−1, 1).
    #[test]
    fn two_storeys_by_hand() {
        let (mass, stiffness) = (
            SymmetricBand::diagonal(&[2.0, 1.0]),
            storey_stiffness(&[2.0, 1.0]),
        );
        let modes = modes(&mass, &stiffness).expect("two modes");
        let near = |value: f64, expected: f64| {
            assert!(
                (value - expected).abs() < 1e-14,
                "{value} is not {expected}"
            );
        };
        near(modes.angular_frequency(0).powi(2), 0.5);
        near(modes.angular_frequency(1).powi(2), 2.0);
        near(modes.shapes[0][0], 0.5);
        near(modes.shapes[0][1], 1.0);
        near(modes.shapes[1][0] * modes.shapes[1][1], -1.0);
        near(modes.participation[0], 4.0 / 3.0);
        near(modes.effective_mass[0], 8.0 / 9.0);
        near(modes.effective_mass[1], 1.0 / 9.0);
        near(modes.critical_time_step(), modes.periods[1] / 10.0);
    }

    /// Two floors tied by a mass between them, M = [1 ½; ½ 1] and K = 3 I: det(K − λM) = (3 − 3λ/2)(3 − λ/2).
    #[test]
    fn masses_may_be_coupled() {
        let mass = SymmetricBand::from_dense(&[vec![1.0, 0.5], vec![0.5, 1.0]]).expect("symmetric");
        let modes = modes(&mass, &SymmetricBand::diagonal(&[3.0, 3.0])).expect("two modes");
        assert!((modes.angular_frequency(0).powi(2) - 2.0).abs() < 1e-14);
        assert!((modes.angular_frequency(1).powi(2) - 6.0).abs() < 1e-14);
        assert!((modes.effective_mass[0] - 1.0).abs() < 1e-14);
    }

    #[test]
    fn without_modes_the_reason_is_given() {
        let mass = SymmetricBand::diagonal(&[1.0, 1.0]);
        let no_mass = SymmetricBand::diagonal(&[1.0, 0.0]);
        let stiffness = storey_stiffness(&[1.0, 1.0]);
        assert_eq!(
            modes(&no_mass, &stiffness),
            Err(ModesError::Mass(NotPositiveDefinite { row: 1 }))
        );
        assert!(matches!(
            modes(&mass, &storey_stiffness(&[0.0, 1.0])),
            Err(ModesError::Stiffness(_))
        ));
        assert_eq!(
            modes(&mass, &storey_stiffness(&[1.0])),
            Err(ModesError::Orders {
                mass: 2,
                stiffness: 1
            })
        );
        let none = SymmetricBand::diagonal(&[]);
        assert_eq!(modes(&none, &none), Err(ModesError::Empty));
    }
}
