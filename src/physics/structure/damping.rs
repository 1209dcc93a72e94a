//! The damping matrix of a frame from ratios of critical damping. In: masses, stiffnesses, modes. Out: C.

use thiserror::Error;

use super::matrix::SymmetricBand;
use super::modes::Modes;

/// The damping of a frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Damping {
    None,
    /// C = a M + b K with the ratio ζ in each of two modes, counted from 0; as narrow as K.
    Rayleigh {
        ratios: (f64, f64),
        modes: (usize, usize),
    },
    /// A ratio a mode, the longest period first; modes beyond the last are not damped. C is full.
    Modal(Vec<f64>),
}

impl Damping {
    /// One ratio in the first two modes.
    #[must_use]
    pub const fn rayleigh(ratio: f64) -> Self {
        Self::Rayleigh {
            ratios: (ratio, ratio),
            modes: (0, 1),
        }
    }
}

/// Ratios that no matrix gives.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum DampingError {
    #[error("mode {} is damped, but there are {count}", mode + 1)]
    NoSuchMode { mode: usize, count: usize },
    #[error("the two modes of Rayleigh damping have the same period")]
    OneFrequency,
    /// It would feed a mode between or beyond the two: a or b is negative.
    #[error("these ratios give a mode negative damping")]
    Negative,
}

/// a (1/s) and b \[s\] of C = a M + b K: ζ = a/(2ω) + bω/2 in each of two modes.
///
/// # Errors
/// If the two frequencies are one, or a coefficient is negative.
pub fn rayleigh_coefficients(
    ratios: (f64, f64),
    frequencies: (f64, f64),
) -> Result<(f64, f64), DampingError> {
    let (first, second) = frequencies;
    let apart = second * second - first * first;
    if apart == 0.0 {
        return Err(DampingError::OneFrequency);
    }
    let of_mass = 2.0 * first * second * (ratios.0 * second - ratios.1 * first) / apart;
    let of_stiffness = 2.0 * (ratios.1 * second - ratios.0 * first) / apart;
    if of_mass < 0.0 || of_stiffness < 0.0 {
        Err(DampingError::Negative)
    } else {
        Ok((of_mass, of_stiffness))
    }
}

/// C \[N·s/m\]. With one degree of freedom Rayleigh damping is 2ζωM with the first ratio.
///
/// # Errors
/// If the ratios do not fit the modes.
pub fn damping_matrix(
    damping: &Damping,
    mass: &SymmetricBand,
    stiffness: &SymmetricBand,
    modes: &Modes,
) -> Result<SymmetricBand, DampingError> {
    let order = mass.order();
    let exists = |mode: usize| {
        if mode < order {
            Ok(())
        } else {
            Err(DampingError::NoSuchMode { mode, count: order })
        }
    };
    match damping {
        Damping::None => Ok(SymmetricBand::zero(order, 0)),
        Damping::Rayleigh { ratios, .. } if order == 1 => modal(&[ratios.0], mass, modes),
        Damping::Rayleigh {
            ratios,
            modes: (first, second),
        } => {
            exists(*first)?;
            exists(*second)?;
            let frequencies = (
                modes.angular_frequency(*first),
                modes.angular_frequency(*second),
            );
            let (of_mass, of_stiffness) = rayleigh_coefficients(*ratios, frequencies)?;
            let mut matrix = SymmetricBand::zero(order, 0);
            matrix.add(mass, of_mass);
            matrix.add(stiffness, of_stiffness);
            Ok(matrix)
        }
        Damping::Modal(ratios) => {
            if let Some(last) = ratios.len().checked_sub(1) {
                exists(last)?;
            }
            modal(ratios, mass, modes)
        }
    }
}

/// C = M (Σ 2ζω φφᵀ / φᵀMφ) M.
fn modal(
    ratios: &[f64],
    mass: &SymmetricBand,
    modes: &Modes,
) -> Result<SymmetricBand, DampingError> {
    if ratios.iter().any(|ratio| *ratio < 0.0) {
        return Err(DampingError::Negative);
    }
    let order = mass.order();
    let mut matrix = SymmetricBand::zero(order, order.saturating_sub(1));
    let mut inertia = vec![0.0; order];
    for (mode, ratio) in ratios.iter().enumerate() {
        let shape = &modes.shapes[mode];
        mass.mul_into(shape, &mut inertia);
        let factor = 2.0 * ratio * modes.angular_frequency(mode) / mass.form(shape, shape);
        for k in 0..order {
            for (i, entry) in matrix.band_mut(k).iter_mut().enumerate() {
                *entry += factor * inertia[i] * inertia[i + k];
            }
        }
    }
    Ok(matrix)
}

#[cfg(test)]
mod tests {
    use super::super::modes::modes;
    use super::super::shear_building::storey_stiffness;
    use super::*;

    fn frame() -> (SymmetricBand, SymmetricBand, Modes) {
        let (mass, stiffness) = (
            SymmetricBand::diagonal(&[2000.0, 1500.0, 1000.0]),
            storey_stiffness(&[3e6, 2e6, 1e6]),
        );
        let modes = modes(&mass, &stiffness).expect("three modes");
        (mass, stiffness, modes)
    }

    /// ζ = φᵀCφ / (2ω φᵀMφ), and nothing between two modes.
    fn ratio(matrix: &SymmetricBand, mass: &SymmetricBand, modes: &Modes, mode: usize) -> f64 {
        let shape = &modes.shapes[mode];
        matrix.form(shape, shape) / (2.0 * modes.angular_frequency(mode) * mass.form(shape, shape))
    }

    #[test]
    fn rayleigh_has_its_two_ratios_and_is_as_narrow_as_the_stiffness() {
        let (mass, stiffness, modes) = frame();
        let damping = Damping::Rayleigh {
            ratios: (0.02, 0.03),
            modes: (0, 2),
        };
        let matrix = damping_matrix(&damping, &mass, &stiffness, &modes).expect("positive");
        assert!((ratio(&matrix, &mass, &modes, 0) - 0.02).abs() < 1e-15);
        assert!((ratio(&matrix, &mass, &modes, 2) - 0.03).abs() < 1e-15);
        assert_eq!(matrix.half_bandwidth(), 1);
    }

    #[test]
    fn modal_ratios_are_what_was_asked_mode_by_mode() {
        let (mass, stiffness, modes) = frame();
        let matrix = damping_matrix(&Damping::Modal(vec![0.05, 0.01]), &mass, &stiffness, &modes)
            .expect("positive");
        for (mode, expected) in [0.05, 0.01, 0.0].into_iter().enumerate() {
            assert!((ratio(&matrix, &mass, &modes, mode) - expected).abs() < 1e-15);
        }
        assert!(matrix.form(&modes.shapes[0], &modes.shapes[1]).abs() < 1e-9);
    }

    #[test]
    fn one_degree_of_freedom_has_one_ratio() {
        let (mass, stiffness) = (SymmetricBand::diagonal(&[4.0]), storey_stiffness(&[100.0]));
        let modes = modes(&mass, &stiffness).expect("a mode");
        let matrix =
            damping_matrix(&Damping::rayleigh(0.05), &mass, &stiffness, &modes).expect("positive");
        assert!(
            (matrix.entry(0, 0) - 2.0).abs() < 1e-14,
            "2ζωM = 2 · 0.05 · 5 · 4"
        );
    }

    #[test]
    fn ratios_that_fit_no_matrix_are_refused() {
        let (mass, stiffness, modes) = frame();
        let refused =
            |damping| damping_matrix(&damping, &mass, &stiffness, &modes).expect_err("no matrix");
        assert_eq!(
            refused(Damping::Modal(vec![0.1; 4])),
            DampingError::NoSuchMode { mode: 3, count: 3 }
        );
        let mode = |modes| Damping::Rayleigh {
            ratios: (0.02, 0.02),
            modes,
        };
        assert_eq!(
            refused(mode((0, 3))),
            DampingError::NoSuchMode { mode: 3, count: 3 }
        );
        assert_eq!(refused(mode((1, 1))), DampingError::OneFrequency);
        assert_eq!(
            refused(Damping::Rayleigh {
                ratios: (0.2, 0.001),
                modes: (0, 1)
            }),
            DampingError::Negative
        );
        assert_eq!(refused(Damping::Modal(vec![-0.1])), DampingError::Negative);
    }
}
