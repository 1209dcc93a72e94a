//! R = R₀ + K∞X + q with q' = K₁X' − q/τ, a spring beside a Maxwell branch, through all moves and holds. In: holds, and where the
//! first move began. Out: its linear parameters and their errors. It knows no rig.

use nalgebra::{DMatrix, DVector};

use super::{Amplitude, Linear, Optimum, RelaxationModel, Steady, TimeConstantModel, Uncertainty};
use crate::identification::{StatedVariance, fit_line};
use crate::relaxation::hold::Hold;
use crate::relaxation::maxwell::{MaxwellBranch, Motion};
use crate::statistics::least_squares::{Covariance, linear};

/// Relative width of the central difference over τ.
const WIDTH: f64 = 1e-5;

pub(super) struct StandardLinearSolid<'a> {
    pub holds: &'a [Hold],
    /// Displacement at the begin of the first move \[m\].
    pub start: f64,
}

impl TimeConstantModel for StandardLinearSolid<'_> {
    const MODEL: RelaxationModel = RelaxationModel::StandardLinearSolid;

    fn holds(&self) -> &[Hold] {
        self.holds
    }

    fn parameters(&self) -> f64 {
        4.0
    }

    fn solve(&self, forces: &[f64], tau: f64) -> Option<Linear> {
        let kernel = self.kernel(tau);
        let rows = self.rows(&kernel, tau).zip(forces.iter().copied());
        let solved = linear(rows, 3)?;
        let solid = [solved[0], solved[1], solved[2]];
        let holds = self.holds.iter().zip(&kernel);
        Some(Linear {
            holds: holds
                .map(|(hold, begins)| [solid[0] + solid[1] * hold.displacement, solid[2] * begins])
                .collect(),
            solid,
        })
    }

    fn by_time_constant(&self, solved: &Linear, tau: f64) -> Vec<f64> {
        let width = WIDTH * tau;
        let (below, above) = (self.kernel(tau - width), self.kernel(tau + width));
        let by = solved.solid[2] / (2.0 * width);
        let holds = self.holds.iter().zip(below.into_iter().zip(above));
        let changes = holds.flat_map(|(hold, (below, above))| {
            let force = |begins: f64, tau: f64, time: f64| begins * (-time / tau).exp();
            let readings = hold.readings.iter();
            readings.map(move |(time, _)| {
                by * (force(above, tau + width, *time) - force(below, tau - width, *time))
            })
        });
        changes.collect()
    }

    /// Forces on one line over the displacement.
    fn steady(&self) -> Steady {
        let points = self.holds.iter().flat_map(|hold| {
            let readings = hold.readings.iter();
            readings.map(|(_, force)| (hold.displacement, *force))
        });
        let (x, r): (Vec<f64>, Vec<f64>) = points.unzip();
        let squares = fit_line(&x, &r).map_or(f64::INFINITY, |fit| {
            x.iter()
                .zip(&r)
                .map(|(x, r)| (r - fit.intercept - fit.slope * x).powi(2))
                .sum()
        });
        Steady {
            squares,
            parameters: 2.0,
        }
    }

    fn uncertainty(&self, optimum: &Optimum<'_>, worst: usize) -> Option<Uncertainty> {
        let (tau, [_, relaxed, branch]) = (optimum.tau, optimum.solved.solid);
        let kernel = self.kernel(tau);
        let mut normal = DMatrix::zeros(4, 4);
        for (row, by_tau) in self.rows(&kernel, tau).zip(optimum.by_tau) {
            let row = DVector::from_vec(vec![row[0], row[1], row[2], *by_tau]);
            normal += &row * row.transpose();
        }
        let covariance = Covariance::of_normal(&normal, optimum.variance)?;
        let gradient = |entries: [f64; 4]| DVector::from_column_slice(&entries);
        // All readings of a hold have the error of its displacement in common.
        let with_displacements = |stiffness: f64, entries: [f64; 4]| {
            let error = covariance.error(&gradient(entries));
            let common = self.error_by_displacements(optimum.stated, stiffness);
            (stiffness, error.hypot(common.unwrap_or(0.0)))
        };
        let width = WIDTH * tau;
        let by_tau = branch * (self.kernel(tau + width)[worst] - self.kernel(tau - width)[worst])
            / (2.0 * width);
        let amplitude = gradient([0.0, 0.0, kernel[worst], by_tau]);
        Some(Uncertainty {
            relaxed_stiffness: Some(with_displacements(relaxed, [0.0, 1.0, 0.0, 0.0])),
            branch_stiffness: Some(with_displacements(branch, [0.0, 0.0, 1.0, 0.0])),
            worst: Amplitude {
                force: optimum.solved.holds[worst][1],
                error: covariance.error(&amplitude),
                covariance: covariance.between(&amplitude, &gradient([0.0, 0.0, 0.0, 1.0])),
            },
        })
    }
}

impl StandardLinearSolid<'_> {
    /// ∂R/∂(R₀, K∞, K₁) of each reading.
    fn rows(&self, kernel: &[f64], tau: f64) -> impl Iterator<Item = [f64; 3]> {
        let holds = self.holds.iter().zip(kernel.to_vec());
        holds.flat_map(move |(hold, begins)| {
            let readings = hold.readings.iter();
            readings.map(move |(time, _)| [1.0, hold.displacement, begins * (-time / tau).exp()])
        })
    }

    /// q at the first reading of each hold for K₁ = 1 N/m \[m\].
    fn kernel(&self, tau: f64) -> Vec<f64> {
        let (mut branch, mut from) = (MaxwellBranch::new(1.0, tau), self.start);
        let each = self.holds.iter().map(|hold| {
            let moved = hold.displacement - from;
            from = hold.displacement;
            let seconds = hold.moved_for.max(1e-9);
            branch.follow(&Motion::rest(hold.waited_for));
            branch.follow(&Motion::even(moved / seconds, seconds));
            branch.follow(&Motion::rest(hold.settled_for));
            let force = branch.force();
            branch.follow(&Motion::rest(hold.duration()));
            force
        });
        each.collect()
    }

    /// Standard error of a stiffness \[N/m\] by the stated errors of the displacements.
    fn error_by_displacements(&self, stated: StatedVariance, stiffness: f64) -> Option<f64> {
        let x: Vec<f64> = self.holds.iter().map(|hold| hold.displacement).collect();
        let displacements = StatedVariance {
            force: 0.0,
            ..stated
        };
        let line = fit_line(&x, &x)?.stated(&x, displacements, stiffness);
        Some(line.slope_error)
    }
}
