//! What every reading of the holds does to the numbers of a relaxation fit, to first order. In: a fit, its holds. Out: slopes by the force
//! of each reading and by the place of each hold. It fits nothing.
//!
//! With J the slopes of the model by its numbers, they move by (JᵀJ)⁻¹Jᵀε when the readings move by ε. Of exponential holds each has an
//! R∞ and an A of its own: what a change of τ does to the readings of a hold, less what these make up for, tells τ, and R∞ and A follow
//! hold by hold.

use nalgebra::{Matrix2, Matrix4, Vector2, Vector4};

use super::relaxation::{Hold, RelaxationFit, RelaxationModel, kernel};
use super::rounding::line_weights;

/// Holds of which the places are looked at: the work goes with their square.
const MOST_HOLDS: usize = 300;

/// Slopes of what is told.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct RelaxationWeights {
    /// s/N of each reading, hold by hold.
    pub time_constant: Vec<f64>,
    /// Of the hold that loses most, N/N.
    pub amplitude: Vec<f64>,
    /// 1/m of each reading; empty where there is none.
    pub relaxed_stiffness: Vec<f64>,
    /// The same of the solid's K₁.
    pub branch_stiffness: Vec<f64>,
    /// By the place of each hold, of τ (s/m), the amplitude (N/m), K∞ and K₁ (N/m²), in this order.
    pub by_place: [Vec<f64>; 4],
}

impl RelaxationWeights {
    /// None where the numbers cannot be told apart. `worst` is the hold that loses most.
    #[must_use]
    pub fn of(fit: &RelaxationFit, holds: &[Hold], worst: usize) -> Option<Self> {
        match fit.model {
            RelaxationModel::Exponential => exponential(fit, holds, worst),
            RelaxationModel::StandardLinearSolid => solid(fit, holds, worst),
        }
    }
}

/// 1 and e^(−t/τ).
fn row(time: f64, tau: f64) -> Vector2<f64> {
    Vector2::new(1.0, (-time / tau).exp())
}

fn exponential(fit: &RelaxationFit, holds: &[Hold], worst: usize) -> Option<RelaxationWeights> {
    let tau = fit.time_constant.0;
    let change = |amplitude: f64, time: f64| amplitude * time / (tau * tau) * (-time / tau).exp();
    // Of each hold the inverse of its normal matrix, and what a second of τ does to R∞ and A.
    let mut each: Vec<(Matrix2<f64>, Vector2<f64>)> = Vec::with_capacity(holds.len());
    let mut own: Vec<f64> = Vec::new();
    for (hold, [_, amplitude]) in holds.iter().zip(&fit.holds) {
        let normal =
            hold.readings.iter().fold(Matrix2::zeros(), |sum, (time, _)| sum + row(*time, tau) * row(*time, tau).transpose());
        let inverse = normal.try_inverse()?;
        let along =
            hold.readings.iter().fold(Vector2::zeros(), |sum, (time, _)| sum + row(*time, tau) * change(*amplitude, *time));
        let taken = inverse * along;
        own.extend(hold.readings.iter().map(|(time, _)| change(*amplitude, *time) - row(*time, tau).dot(&taken)));
        each.push((inverse, taken));
    }
    let size: f64 = own.iter().map(|part| part * part).sum();
    let time_constant: Vec<f64> = own.iter().map(|part| part / size).collect();
    // A number that is Σ of `by` of the R∞ and A of the holds.
    let of = |by: &dyn Fn(usize) -> Vector2<f64>| -> Vec<f64> {
        let follows: f64 = each.iter().enumerate().map(|(hold, (_, taken))| by(hold).dot(taken)).sum();
        let direct = holds.iter().zip(&each).enumerate().flat_map(|(index, (hold, (inverse, _)))| {
            let by = by(index);
            hold.readings.iter().map(move |(time, _)| by.dot(&(inverse * row(*time, tau))))
        });
        direct.zip(&time_constant).map(|(direct, by_tau)| direct - follows * by_tau).collect()
    };
    let places: Vec<f64> = holds.iter().map(|hold| hold.displacement).collect();
    let slope = fit.relaxed_stiffness.map(|(stiffness, _)| (stiffness, line_weights(&places)[0].clone()));
    let relaxed_stiffness = slope.as_ref().map_or_else(Vec::new, |(_, weights)| of(&|hold| Vector2::new(weights[hold], 0.0)));
    let nothing = || vec![0.0; holds.len()];
    // A place that is off by e puts its relaxed force off the line by −K∞·e.
    let by_place = slope.map_or_else(nothing, |(stiffness, weights)| weights.iter().map(|weight| -stiffness * weight).collect());
    Some(RelaxationWeights {
        amplitude: of(&|hold| if hold == worst { Vector2::y() } else { Vector2::zeros() }),
        relaxed_stiffness,
        branch_stiffness: Vec::new(),
        by_place: [nothing(), nothing(), by_place, nothing()],
        time_constant,
    })
}

fn solid(fit: &RelaxationFit, holds: &[Hold], worst: usize) -> Option<RelaxationWeights> {
    let tau = fit.time_constant.0;
    let (relaxed, branch) = (fit.relaxed_stiffness?.0, fit.branch_stiffness?.0);
    let part = 1e-5 * tau;
    let [now, less, more] = [tau, tau - part, tau + part].map(|tau| kernel(holds, fit.start, tau));
    let begins: Vec<f64> = now;
    let by_tau: Vec<f64> = less.iter().zip(&more).map(|(less, more)| (more - less) / (2.0 * part)).collect();
    let mut rows: Vec<Vector4<f64>> = Vec::new();
    for (index, hold) in holds.iter().enumerate() {
        for (time, _) in &hold.readings {
            let fall = (-time / tau).exp();
            let change = branch * fall * (by_tau[index] + begins[index] * time / (tau * tau));
            rows.push(Vector4::new(1.0, hold.displacement, begins[index] * fall, change));
        }
    }
    let normal: Matrix4<f64> = rows.iter().fold(Matrix4::zeros(), |sum, row| sum + row * row.transpose());
    let unit = Matrix4::from_diagonal(&normal.diagonal().map(|size| 1.0 / size.sqrt()));
    let inverse = unit * (unit * normal * unit).try_inverse()? * unit;
    let by_reading: Vec<Vector4<f64>> = rows.iter().map(|row| inverse * row).collect();
    let effects = [Vector4::w(), Vector4::new(0.0, 0.0, begins[worst], branch * by_tau[worst]), Vector4::y(), Vector4::z()];
    let [time_constant, amplitude, relaxed_stiffness, branch_stiffness] =
        effects.map(|effect| by_reading.iter().map(|weight| weight.dot(&effect)).collect::<Vec<f64>>());
    let mut by_place = [const { Vec::new() }; 4];
    if holds.len() <= MOST_HOLDS {
        // The branch is linear: what one place does to it is what it does where all others are at nothing.
        for moved in 0..holds.len() {
            let alone: Vec<Hold> = holds
                .iter()
                .enumerate()
                .map(|(hold, held)| Hold { displacement: f64::from(u8::from(hold == moved)), ..held.clone() })
                .collect();
            let response = kernel(&alone, 0.0, tau);
            let mut index = 0;
            let mut sums = Vector4::zeros();
            for (hold, held) in holds.iter().enumerate() {
                let own = if hold == moved { relaxed } else { 0.0 };
                for (time, _) in &held.readings {
                    // What is off by e in the place is off by −∂R/∂x·e in the force.
                    sums -= by_reading[index] * (own + branch * response[hold] * (-time / tau).exp());
                    index += 1;
                }
            }
            for (found, effect) in by_place.iter_mut().zip(&effects) {
                found.push(sums.dot(effect));
            }
        }
    }
    Some(RelaxationWeights { time_constant, amplitude, relaxed_stiffness, branch_stiffness, by_place })
}
