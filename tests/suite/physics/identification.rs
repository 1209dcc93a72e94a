//! Coverage of standard errors: over many seeds, the true value lies within one and two of them as often as it should.

use psd_physics::identification::{LineFit, fit_damping, fit_line};
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64Mcg;

const SEEDS: u64 = 500;
const READINGS: u32 = 40;

/// Number of fits whose value lies within one and within two standard errors of the truth. 500 trials scatter by three binomial standard
/// deviations, 0.062 and 0.028. 38 degrees of freedom add another 0.01 (Student's t compared with the normal distribution).
#[track_caller]
fn honest(what: &str, fits: &[LineFit], true_value: f64, of: impl Fn(&LineFit) -> (f64, f64)) {
    for (errors, expected, tolerance) in [(1.0, 0.683, 0.072), (2.0, 0.954, 0.039)] {
        let holds = fits
            .iter()
            .map(&of)
            .filter(|(value, error)| (value - true_value).abs() <= errors * error)
            .count();
        #[allow(clippy::cast_precision_loss)] // 500 at most
        let coverage = holds as f64 / fits.len() as f64;
        assert!(
            (coverage - expected).abs() <= tolerance,
            "{what} within {errors} standard errors: {coverage}"
        );
    }
}

fn fits(noise: f64, fit: impl Fn(&mut dyn FnMut() -> f64) -> LineFit) -> Vec<LineFit> {
    let noise = Normal::new(0.0, noise).expect("a standard deviation");
    (0..SEEDS)
        .map(|seed| {
            let mut random = Pcg64Mcg::seed_from_u64(seed);
            fit(&mut || noise.sample(&mut random))
        })
        .collect()
}

/// A ramp to 4 mm on 300 kN/m that starts from 12 N, read with 5 N of noise.
#[test]
fn stiffness_ramp() {
    let displacements: Vec<f64> = (1..=READINGS).map(|i| 1e-4 * f64::from(i)).collect();
    let fits = fits(5.0, |noise| {
        let forces: Vec<f64> = displacements
            .iter()
            .map(|x| 12.0 + 3e5 * x + noise())
            .collect();
        fit_line(&displacements, &forces).expect("a line")
    });
    honest("stiffness", &fits, 3e5, |fit| (fit.slope, fit.slope_error));
    honest("intercept", &fits, 12.0, |fit| {
        (fit.intercept, fit.intercept_error)
    });
}

/// Sweeps in both directions at 0.01 to 0.2 m/s. c = 80 N·s/m and 3 N of friction, read with 2 N of noise. The readings at rest contain a
/// force that would falsify the fit.
#[test]
fn damping_sweep() {
    let mut velocities: Vec<f64> = (1..=READINGS / 2)
        .flat_map(|i| [0.01 * f64::from(i), -0.01 * f64::from(i)])
        .collect();
    velocities.extend([0.0, 0.0]);
    let fits = fits(2.0, |noise| {
        let forces: Vec<f64> = velocities
            .iter()
            .map(|v| {
                if *v == 0.0 {
                    1000.0
                } else {
                    80.0 * v + 3.0 * v.signum() + noise()
                }
            })
            .collect();
        fit_damping(&velocities, &forces).expect("a line")
    });
    honest("viscous damping", &fits, 80.0, |fit| {
        (fit.slope, fit.slope_error)
    });
    honest("friction", &fits, 3.0, |fit| {
        (fit.intercept, fit.intercept_error)
    });
}

/// Five points by hand: x 0..4, y 1, 3, 2, 5, 4 → slope 0.8, intercept 1.4, residual 3.6, R² = 0.64.
#[test]
fn a_line_by_hand() {
    let fit = fit_line(&[0.0, 1.0, 2.0, 3.0, 4.0], &[1.0, 3.0, 2.0, 5.0, 4.0]).expect("a line");
    let expected = [0.8, 0.12_f64.sqrt(), 1.4, 0.72_f64.sqrt(), 0.64];
    let found = [
        fit.slope,
        fit.slope_error,
        fit.intercept,
        fit.intercept_error,
        fit.r_squared,
    ];
    for (found, expected) in found.into_iter().zip(expected) {
        assert!(
            (found - expected).abs() < 1e-14,
            "{found} is not {expected}"
        );
    }
}

#[test]
fn no_line_without_three_points_or_a_change_of_x() {
    assert_eq!(fit_line(&[0.0, 1.0], &[0.0, 1.0]), None);
    assert_eq!(fit_line(&[0.0, 1.0, 2.0], &[0.0, 1.0]), None);
    assert_eq!(fit_line(&[1.0, 1.0, 1.0], &[0.0, 1.0, 2.0]), None);
    assert_eq!(
        fit_damping(&[0.0, 0.0, 0.0, 0.1], &[1.0, 2.0, 3.0, 4.0]),
        None
    );
}
