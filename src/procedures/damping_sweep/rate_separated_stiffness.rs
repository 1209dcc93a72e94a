//! Stiffness in readings that were made on the way: F = F₀ + K·d + c·v, for what damps the specimen is in them. In: displacement and
//! force, reading by reading, evenly in time. Out: K with its standard error, where the readings tell one.

use std::collections::VecDeque;

use nalgebra::{Matrix3, Vector3};

/// Readings that are looked at together: enough that the scatter about the plane tells its own size, few enough that a stiffness
/// that changes is still seen.
const MOST: usize = 12;
const FEWEST: usize = 10;

/// The last readings of one way: friction changes its sign at a turn, a blow the velocity, and a new way begins there.
#[derive(Clone, Debug, Default)]
pub(crate) struct OnTheWay {
    /// The last two, m and N: a velocity is known a reading later, from the places before and after.
    last: Vec<(f64, f64)>,
    /// m, m a reading, N
    points: VecDeque<[f64; 3]>,
}

impl OnTheWay {
    /// A blow: places before it tell no velocity after it.
    pub(crate) fn struck(&mut self) {
        self.last.clear();
        self.points.clear();
    }

    /// Takes a reading (m, N); K and its standard error (N/m) by readings whose standard deviations are `noise` (N, m).
    pub(crate) fn take(&mut self, reading: (f64, f64), noise: (f64, f64)) -> Option<(f64, f64)> {
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

/// Least squares about the means, each of the size of 1. Scatter that is larger than the noise declared counts in its place.
fn plane(points: &VecDeque<[f64; 3]>, noise: (f64, f64)) -> Option<(f64, f64)> {
    #[expect(clippy::cast_precision_loss, reason = "a dozen points")]
    let count = points.len() as f64;
    let mean =
        [0, 1, 2].map(|part: usize| points.iter().map(|point| point[part]).sum::<f64>() / count);
    let size = [0, 1].map(|part: usize| {
        points
            .iter()
            .map(|point| (point[part] - mean[part]).abs())
            .fold(0.0, f64::max)
    });
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

    /// 500 N/m with a damper that is felt as 40 N a metre a reading and friction of 0.2 N, along a sine of 40 readings.
    fn told(noise: &mut dyn FnMut() -> f64, declared: f64) -> Vec<(f64, f64)> {
        let mut way = OnTheWay::default();
        let place = |step: f64| 0.01 * (std::f64::consts::TAU * step / 40.0).sin();
        let readings = (0..400).filter_map(|step| {
            let step = f64::from(step);
            let velocity = 0.5 * (place(step + 1.0) - place(step - 1.0));
            let force = 500.0 * place(step) + 40.0 * velocity + 0.2 * velocity.signum() + noise();
            way.take((place(step), force), (declared, 0.0))
        });
        readings.collect()
    }

    #[test]
    fn dampers_and_friction_are_no_stiffness() {
        let told = told(&mut || 0.0, 0.0);
        assert!(told.len() > 100);
        for (stiffness, error) in told {
            assert!(
                (stiffness / 500.0 - 1.0).abs() < 1e-9 && error < 1e-6,
                "{stiffness} N/m ± {error} N/m"
            );
        }
    }

    /// The standard error is what it says: of the estimates few lie beyond three of them, of seven degrees of freedom 2 % and none
    /// beyond what a remark asks for, with the noise declared or not.
    #[test]
    fn its_error_is_that_of_the_noise() {
        for declared in [0.01, 0.0] {
            let mut state = 5;
            let told: Vec<(f64, f64)> = (0..20)
                .flat_map(|_| told(&mut || 0.01 * normal(&mut state), declared))
                .collect();
            let beyond = |errors: f64| {
                told.iter()
                    .filter(|(found, error)| (found - 500.0).abs() > errors * error)
                    .count()
            };
            assert!(
                beyond(3.0) * 40 <= told.len(),
                "{} of {}",
                beyond(3.0),
                told.len()
            );
            assert!(
                beyond(6.0) * 2000 <= told.len(),
                "{} of {}",
                beyond(6.0),
                told.len()
            );
            assert!(told.iter().any(|(_, error)| *error < 10.0));
        }
    }
}
