//! R = R∞ + A e^(−t/τ) in every hold, with one τ for all. In: holds. Out: its linear parameters and their errors. It knows no moves.

use nalgebra::{DMatrix, DVector, Matrix2, Vector2};

use super::{Amplitude, Linear, Optimum, RelaxationModel, Steady, TimeConstantModel, Uncertainty};
use crate::identification::{StatedVariance, fit_line};
use crate::relaxation::hold::Hold;
use crate::statistics::least_squares::inverse_normal;

pub(super) struct Exponential<'a> {
    pub holds: &'a [Hold],
}

impl TimeConstantModel for Exponential<'_> {
    const MODEL: RelaxationModel = RelaxationModel::Exponential;

    fn holds(&self) -> &[Hold] {
        self.holds
    }

    #[expect(clippy::cast_precision_loss, reason = "far fewer holds than 2^53")]
    fn parameters(&self) -> f64 {
        2.0 * self.holds.len() as f64 + 1.0
    }

    /// Each dwell separately: a line of force over e^(−t/τ).
    fn solve(&self, forces: &[f64], tau: f64) -> Option<Linear> {
        let mut forces = forces;
        let holds = self.holds.iter().map(|hold| {
            let (own, others) = forces.split_at(hold.readings.len());
            forces = others;
            let fall: Vec<f64> = hold
                .readings
                .iter()
                .map(|(time, _)| (-time / tau).exp())
                .collect();
            let line = fit_line(&fall, own)?;
            Some([line.intercept, line.slope])
        });
        Some(Linear {
            holds: holds.collect::<Option<Vec<[f64; 2]>>>()?,
            solid: [0.0; 3],
        })
    }

    fn by_time_constant(&self, solved: &Linear, tau: f64) -> Vec<f64> {
        let holds = self.holds.iter().zip(&solved.holds);
        let changes = holds.flat_map(|(hold, [_, amplitude])| {
            let by = *amplitude / (tau * tau);
            let readings = hold.readings.iter();
            readings.map(move |(time, _)| by * time * (-time / tau).exp())
        });
        changes.collect()
    }

    /// A constant force in every hold.
    #[expect(clippy::cast_precision_loss, reason = "far fewer holds than 2^53")]
    fn steady(&self) -> Steady {
        Steady {
            squares: self.holds.iter().map(Hold::squares_about_mean).sum(),
            parameters: self.holds.len() as f64,
        }
    }

    fn uncertainty(&self, optimum: &Optimum<'_>, worst: usize) -> Option<Uncertainty> {
        let tau = optimum.tau;
        let offset: usize = self.holds[..worst]
            .iter()
            .map(|hold| hold.readings.len())
            .sum();
        let readings = &self.holds[worst].readings;
        let by_tau = &optimum.by_tau[offset..offset + readings.len()];
        let inverse = inverse_normal(&normal(readings, tau))?;
        let gradient = readings
            .iter()
            .zip(by_tau)
            .fold(Vector2::zeros(), |sum, ((time, _), by_tau)| {
                sum + Vector2::new(1.0, (-time / tau).exp()) * *by_tau
            });
        // dA/dτ along the least squares over R∞ and A.
        let amplitude_by_tau = -(&inverse * DVector::from_column_slice(gradient.as_slice()))[1];
        let error =
            optimum.variance * inverse[(1, 1)] + (amplitude_by_tau * optimum.tau_error).powi(2);
        Some(Uncertainty {
            relaxed_stiffness: self.relaxed_stiffness(optimum),
            branch_stiffness: None,
            worst: Amplitude {
                force: optimum.solved.holds[worst][1],
                error: error.sqrt(),
                covariance: amplitude_by_tau * optimum.tau_error * optimum.tau_error,
            },
        })
    }
}

impl Exponential<'_> {
    /// Slope of the relaxed forces over the displacements, which have the stated errors of the readings of their hold.
    fn relaxed_stiffness(&self, optimum: &Optimum<'_>) -> Option<(f64, f64)> {
        let (x, r): (Vec<f64>, Vec<f64>) = self
            .holds
            .iter()
            .zip(&optimum.solved.holds)
            .map(|(hold, [relaxed, _])| (hold.displacement, *relaxed))
            .unzip();
        let each = self
            .holds
            .iter()
            .filter_map(|hold| Some(inverse_normal(&normal(&hold.readings, optimum.tau))?[(0, 0)]));
        #[expect(clippy::cast_precision_loss, reason = "far fewer holds than 2^53")]
        let relaxed = StatedVariance {
            force: optimum.stated.force * each.sum::<f64>() / x.len() as f64,
            ..optimum.stated
        };
        let line = fit_line(&x, &r)?;
        let line = line.stated(&x, relaxed, line.slope);
        Some((line.slope, line.slope_error))
    }
}

/// JᵀJ of R∞ and A, with the rows (1, e^(−t/τ)).
fn normal(readings: &[(f64, f64)], tau: f64) -> DMatrix<f64> {
    let normal = readings.iter().fold(Matrix2::zeros(), |sum, (time, _)| {
        let row = Vector2::new(1.0, (-time / tau).exp());
        sum + row * row.transpose()
    });
    DMatrix::from_column_slice(2, 2, normal.as_slice())
}
