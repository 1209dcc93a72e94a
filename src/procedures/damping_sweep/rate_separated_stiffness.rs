//! Stiffness from readings in motion, which include the force of dampers: F = F₀ + K·d + c·v. In: displacement and force, reading by
//! reading, evenly in time. Out: K with its standard error, where the readings determine it.

use std::collections::VecDeque;

use nalgebra::{Matrix3, Vector3};
use psd_physics::statistics::samples::peak;

/// Readings of one fit, at most and at least: enough to estimate the scatter about the plane, few enough to follow a stiffness that
/// changes.
const MOST: usize = 12;
const FEWEST: usize = 10;

/// The last readings in one direction. At a reversal friction changes its sign, in a contact the velocity jumps: a new fit begins there.
#[derive(Clone, Debug, Default)]
pub(crate) struct RateSeparatedFit {
    /// The last two readings, m and N: a velocity is known one reading later, from the positions before and after.
    last: Vec<(f64, f64)>,
    /// Position \[m\], velocity \[m per reading\], force \[N\].
    points: VecDeque<[f64; 3]>,
}

impl RateSeparatedFit {
    /// Starts again after a contact: positions before it give no velocity after it.
    pub(crate) fn restart(&mut self) {
        self.last.clear();
        self.points.clear();
    }

    /// Adds a reading (m, N). Gives K and its standard error \[N/m\]; the standard deviations of the readings are `noise` (N, m).
    pub(crate) fn add(&mut self, reading: (f64, f64), noise: (f64, f64)) -> Option<(f64, f64)> {
        if let [before, at] = self.last[..] {
            let velocity = 0.5 * (reading.0 - before.0);
            if self
                .points
                .back()
                .is_some_and(|point| point[1] * velocity <= 0.0)
            {
                self.points.clear();
            }
            self.points.push_back([at.0, velocity, at.1]);
            if self.points.len() > MOST {
                self.points.pop_front();
            }
            self.last.remove(0);
        }
        self.last.push(reading);
        if self.points.len() < FEWEST {
            None
        } else {
            plane(&self.points, noise)
        }
    }
}

/// Least squares about the means, scaled to a size of 1. The larger of scatter and declared noise is used.
fn plane(points: &VecDeque<[f64; 3]>, noise: (f64, f64)) -> Option<(f64, f64)> {
    #[expect(clippy::cast_precision_loss, reason = "a dozen points")]
    let count = points.len() as f64;
    let mean =
        [0, 1, 2].map(|part: usize| points.iter().map(|point| point[part]).sum::<f64>() / count);
    let size = [0, 1].map(|part: usize| peak(points.iter().map(|point| point[part] - mean[part])));
    if size[0] <= 0.0 || size[1] <= 0.0 {
        return None;
    }
    let row = |point: &[f64; 3]| {
        Vector3::new(
            1.0,
            (point[0] - mean[0]) / size[0],
            (point[1] - mean[1]) / size[1],
        )
    };
    let (mut normal, mut load) = (Matrix3::zeros(), Vector3::zeros());
    for point in points {
        normal += row(point) * row(point).transpose();
        load += row(point) * (point[2] - mean[2]);
    }
    let inverse = normal.try_inverse()?;
    let solved = inverse * load;
    let squares: f64 = points
        .iter()
        .map(|point| (point[2] - mean[2] - row(point).dot(&solved)).powi(2))
        .sum();
    let stiffness = solved[1] / size[0];
    let scatter = (squares / (count - 3.0))
        .sqrt()
        .max(noise.0.hypot(stiffness * noise.1));
    let error = scatter * inverse[(1, 1)].max(0.0).sqrt() / size[0];
    (stiffness.is_finite() && error.is_finite()).then_some((stiffness, error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::noise::normal;

    /// 500 N/m with a damper of 40 N per (metre per reading) and friction of 0.2 N, along a sine of 40 readings.
    fn estimates(noise: &mut dyn FnMut() -> f64, declared: f64) -> Vec<(f64, f64)> {
        let mut fit = RateSeparatedFit::default();
        let position = |step: f64| 0.01 * (std::f64::consts::TAU * step / 40.0).sin();
        let readings = (0..400).filter_map(|step| {
            let step = f64::from(step);
            let velocity = 0.5 * (position(step + 1.0) - position(step - 1.0));
            let force =
                500.0 * position(step) + 40.0 * velocity + 0.2 * velocity.signum() + noise();
            fit.add((position(step), force), (declared, 0.0))
        });
        readings.collect()
    }

    #[test]
    fn dampers_and_friction_are_no_stiffness() {
        let found = estimates(&mut || 0.0, 0.0);
        assert!(found.len() > 100);
        for (stiffness, error) in found {
            assert!(
                (stiffness / 500.0 - 1.0).abs() < 1e-9 && error < 1e-6,
                "{stiffness} N/m ± {error} N/m"
            );
        }
    }

    /// The standard errors are correct: with seven degrees of freedom 2 % of the estimates are beyond three of them, and almost none beyond
    /// the threshold of an observation, with the noise declared or not.
    #[test]
    fn its_error_is_that_of_the_noise() {
        for declared in [0.01, 0.0] {
            let mut state = 5;
            let found: Vec<(f64, f64)> = (0..20)
                .flat_map(|_| estimates(&mut || 0.01 * normal(&mut state), declared))
                .collect();
            let beyond = |errors: f64| {
                found
                    .iter()
                    .filter(|(stiffness, error)| (stiffness - 500.0).abs() > errors * error)
                    .count()
            };
            assert!(
                beyond(3.0) * 40 <= found.len(),
                "{} of {}",
                beyond(3.0),
                found.len()
            );
            assert!(
                beyond(6.0) * 2000 <= found.len(),
                "{} of {}",
                beyond(6.0),
                found.len()
            );
            assert!(found.iter().any(|(_, error)| *error < 10.0));
        }
    }
}
