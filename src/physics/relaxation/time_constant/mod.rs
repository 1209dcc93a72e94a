//! Relaxation with one time constant: the force that is lost while a specimen is held. In: holds with their readings. Out: the time
//! constant, the force still to relax, the stiffness with and without it, each with its standard error. It knows no rig.
//!
//! For a given τ both models are linear in all other parameters, so that least squares runs over ln τ alone (variable projection).

mod exponential;
mod standard_linear_solid;
#[cfg(test)]
mod tests;

use nalgebra::{DMatrix, DVector};

use super::hold::{Extent, Hold, Unrelaxed, geometric};
use crate::identification::StatedVariance;
use crate::statistics::least_squares::{FitSize, Residuals, minimize};
use exponential::Exponential;
use standard_linear_solid::StandardLinearSolid;

/// The model of the forces of holds; R \[N\], X \[m\], t \[s\].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RelaxationModel {
    /// R = R∞ + A e^(−t/τ) in every hold, with one τ for all.
    Exponential,
    /// R = R₀ + K∞ X + q, q' = K₁ X' − q/τ through all moves and holds; a move has constant velocity.
    StandardLinearSolid,
}

/// Relaxation of a specimen by one time constant. Each pair is a value and its standard error.
#[derive(Clone, Debug, PartialEq)]
pub struct RelaxationFit {
    pub model: RelaxationModel,
    /// τ \[s\]
    pub time_constant: (f64, f64),
    /// For each hold: the force when all has relaxed R∞, and the amplitude A at its first reading \[N\].
    pub holds: Vec<[f64; 2]>,
    /// K∞ \[N/m\]: for the exponential the slope of the relaxed forces, where three holds determine it.
    pub relaxed_stiffness: Option<(f64, f64)>,
    /// K₁ of the standard linear solid \[N/m\].
    pub branch_stiffness: Option<(f64, f64)>,
    /// Force that the worst hold had still to lose at its last reading \[N\].
    pub remaining: (f64, f64),
    /// Amplitude of the worst hold, from which the pause for a force accuracy follows.
    pub worst: Amplitude,
    /// Standard deviation of a reading about the fit \[N\].
    pub scatter: f64,
    /// Degrees of freedom of that scatter: number of readings minus number of parameters.
    pub degrees: f64,
    /// Fraction of the standard errors that the scatter shows; the rest is stated.
    pub shown: f64,
}

/// Amplitude A of the hold that has most left to lose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amplitude {
    /// A \[N\]
    pub force: f64,
    /// Its standard error \[N\].
    pub error: f64,
    /// Covariance of A and τ \[N·s\].
    pub covariance: f64,
}

impl RelaxationFit {
    /// Dwell until less than `accuracy` \[N\] is left to relax \[s\]: τ ln(|A|/accuracy), with its standard error.
    #[must_use]
    pub fn required_pause(&self, accuracy: f64) -> (f64, f64) {
        let (tau, tau_error) = self.time_constant;
        let Amplitude {
            force,
            error,
            covariance,
        } = self.worst;
        let times = (force.abs() / accuracy).ln();
        if times <= 0.0 {
            return (0.0, 0.0);
        }
        let variance = (times * tau_error).powi(2)
            + (tau / force * error).powi(2)
            + 2.0 * times * tau / force * covariance;
        (tau * times, variance.max(0.0).sqrt())
    }

    /// Degrees of freedom of the relaxed stiffness: for the exponential it is the slope of a line through the holds.
    #[must_use]
    pub fn degrees_of_stiffness(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "far fewer holds than 2^53")]
        let holds = self.holds.len() as f64;
        if self.model == RelaxationModel::Exponential {
            (holds - 2.0).max(1.0)
        } else {
            self.degrees
        }
    }
}

/// Time constants tried first, over the range that the readings resolve.
const TRIED: u32 = 32;
/// Scatter below this fraction of the largest force is rounding and no relaxation.
const ROUNDING: f64 = 1e-10;

/// Least squares over τ and all linear parameters. The standard errors are those of the linearised model at the optimum. `start` is
/// the displacement at the begin of the first move \[m\].
///
/// # Errors
/// The readings do not determine a time constant.
pub fn fit_relaxation(
    holds: &[Hold],
    start: f64,
    model: RelaxationModel,
    stated: StatedVariance,
) -> Result<RelaxationFit, Unrelaxed> {
    match model {
        RelaxationModel::Exponential => fit(&Exponential { holds }, stated),
        RelaxationModel::StandardLinearSolid => fit(&StandardLinearSolid { holds, start }, stated),
    }
}

/// A model of the forces of holds that is linear in all parameters but τ.
trait TimeConstantModel {
    const MODEL: RelaxationModel;

    fn holds(&self) -> &[Hold];

    /// Number of parameters, τ included.
    fn parameters(&self) -> f64;

    /// The linear parameters that describe `forces` best, one force for each reading.
    fn solve(&self, forces: &[f64], tau: f64) -> Option<Linear>;

    /// ∂R/∂τ for each reading, with the linear parameters kept.
    fn by_time_constant(&self, solved: &Linear, tau: f64) -> Vec<f64>;

    /// Without relaxation.
    fn steady(&self) -> Steady;

    /// Stiffnesses, and the amplitude of the hold `worst`, with their standard errors.
    fn uncertainty(&self, optimum: &Optimum<'_>, worst: usize) -> Option<Uncertainty>;

    fn forces(&self) -> Vec<f64> {
        let readings = self.holds().iter().flat_map(|hold| &hold.readings);
        readings.map(|(_, force)| *force).collect()
    }

    /// Forces minus those of the model.
    fn left(&self, forces: &[f64], solved: &Linear, tau: f64) -> DVector<f64> {
        let holds = self.holds().iter().zip(&solved.holds);
        let model = holds.flat_map(|(hold, [relaxed, amplitude])| {
            let readings = hold.readings.iter();
            readings.map(move |(time, _)| relaxed + amplitude * (-time / tau).exp())
        });
        let left = forces.iter().zip(model).map(|(force, model)| force - model);
        DVector::from_iterator(forces.len(), left)
    }
}

/// Linear parameters for one τ.
struct Linear {
    /// R∞ and A of each hold \[N\].
    holds: Vec<[f64; 2]>,
    /// R₀ \[N\], K∞ and K₁ \[N/m\] of the solid.
    solid: [f64; 3],
}

/// A fit of forces that do not relax.
struct Steady {
    squares: f64,
    parameters: f64,
}

/// The least squares, and the errors that go with them.
struct Optimum<'a> {
    solved: &'a Linear,
    /// ∂R/∂τ of each reading \[N/s\].
    by_tau: &'a [f64],
    tau: f64,
    /// Standard error of τ \[s\].
    tau_error: f64,
    /// Variance of a reading \[N²\].
    variance: f64,
    stated: StatedVariance,
}

/// Results that differ between the models.
struct Uncertainty {
    relaxed_stiffness: Option<(f64, f64)>,
    branch_stiffness: Option<(f64, f64)>,
    worst: Amplitude,
}

/// The model as residuals over the one parameter ln τ.
struct OverTimeConstant<'a, M> {
    model: &'a M,
    forces: &'a [f64],
}

impl<M: TimeConstantModel> OverTimeConstant<'_, M> {
    fn squares(&self, tau: f64) -> f64 {
        let solved = self.model.solve(self.forces, tau);
        solved.map_or(f64::INFINITY, |solved| {
            self.model.left(self.forces, &solved, tau).norm_squared()
        })
    }

    /// The part of ∂R/∂τ that the linear parameters do not take up.
    fn projected(&self, by_tau: &[f64], tau: f64) -> Option<DVector<f64>> {
        let fitted = self.model.solve(by_tau, tau)?;
        Some(self.model.left(by_tau, &fitted, tau))
    }
}

impl<M: TimeConstantModel> Residuals for OverTimeConstant<'_, M> {
    fn residuals(&self, parameters: &DVector<f64>) -> Option<DVector<f64>> {
        let tau = parameters[0].exp();
        let solved = self.model.solve(self.forces, tau)?;
        Some(self.model.left(self.forces, &solved, tau))
    }

    /// ∂r/∂ln τ = −τ ∂R/∂τ, projected.
    fn jacobian(&self, parameters: &DVector<f64>) -> Option<DMatrix<f64>> {
        let tau = parameters[0].exp();
        let solved = self.model.solve(self.forces, tau)?;
        let by_tau = self.model.by_time_constant(&solved, tau);
        let column = self.projected(&by_tau, tau)? * -tau;
        Some(DMatrix::from_columns(&[column]))
    }

    /// At most a factor of e in one step.
    fn longest_fraction(&self, step: &DVector<f64>) -> f64 {
        (1.0 / step[0].abs()).min(1.0)
    }
}

fn fit<M: TimeConstantModel>(
    model: &M,
    stated: StatedVariance,
) -> Result<RelaxationFit, Unrelaxed> {
    let holds = model.holds();
    let extent = Extent::new(holds);
    #[expect(clippy::cast_precision_loss, reason = "far fewer readings than 2^53")]
    let (count, parameters) = (extent.count as f64, model.parameters());
    if count <= parameters || holds.is_empty() || extent.longest <= 0.0 {
        return Err(Unrelaxed::TooFew);
    }
    let forces = model.forces();
    let over_tau = OverTimeConstant {
        model,
        forces: &forces,
    };
    let (low, high) = extent.resolvable();
    let (tau, squares) = geometric(low, high, TRIED)
        .map(|tau| (tau, over_tau.squares(tau)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .ok_or(Unrelaxed::TooFew)?;
    let steady = model.steady();
    let floored = |squares: f64| {
        squares
            .max(count * (ROUNDING * extent.largest_force).powi(2))
            .max(count * f64::MIN_POSITIVE)
    };
    let criterion = |squares, parameters| {
        FitSize {
            squares: floored(squares),
            count,
            parameters,
        }
        .bic()
    };
    if criterion(steady.squares, steady.parameters) <= criterion(squares, parameters) {
        return Err(Unrelaxed::Steady);
    }
    let tau = minimize(&over_tau, DVector::from_element(1, tau.ln()))
        .map_or(tau, |parameters| parameters[0].exp());
    if !(tau > 1.01 * low && tau < 0.99 * high) {
        return Err(Unrelaxed::OutOfReach);
    }
    described(&over_tau, tau, count - parameters, stated).ok_or(Unrelaxed::OutOfReach)
}

/// The fit at the optimum τ, with its standard errors.
fn described<M: TimeConstantModel>(
    over_tau: &OverTimeConstant<'_, M>,
    tau: f64,
    degrees: f64,
    stated: StatedVariance,
) -> Option<RelaxationFit> {
    let (model, holds) = (over_tau.model, over_tau.model.holds());
    let solved = model.solve(over_tau.forces, tau)?;
    let by_tau = model.by_time_constant(&solved, tau);
    let squares = model.left(over_tau.forces, &solved, tau).norm_squared();
    // The force does not follow the displacement within a hold.
    let (variance, shown) = stated.counted(squares / degrees, 0.0);
    let tau_error = (variance / over_tau.projected(&by_tau, tau)?.norm_squared()).sqrt();
    let left = |index: usize| {
        let [_, amplitude]: [f64; 2] = solved.holds[index];
        (amplitude * (-holds[index].duration() / tau).exp()).abs()
    };
    let worst = (0..holds.len()).max_by(|a, b| left(*a).total_cmp(&left(*b)))?;
    let optimum = Optimum {
        solved: &solved,
        by_tau: &by_tau,
        tau,
        tau_error,
        variance,
        stated,
    };
    let uncertainty = model.uncertainty(&optimum, worst)?;
    let remaining = remaining(uncertainty.worst, (tau, tau_error), holds[worst].duration());
    Some(RelaxationFit {
        model: M::MODEL,
        time_constant: (tau, tau_error),
        relaxed_stiffness: uncertainty.relaxed_stiffness,
        branch_stiffness: uncertainty.branch_stiffness,
        remaining,
        worst: uncertainty.worst,
        scatter: variance.sqrt(),
        degrees,
        shown,
        holds: solved.holds,
    })
}

/// |A| e^(−t/τ) after `seconds` \[N\], with its standard error by those of A and τ and their covariance.
fn remaining(amplitude: Amplitude, time_constant: (f64, f64), seconds: f64) -> (f64, f64) {
    let (tau, tau_error) = time_constant;
    let fall = (-seconds / tau).exp();
    let by_tau = amplitude.force * fall * seconds / (tau * tau);
    let variance = (fall * amplitude.error).powi(2)
        + (by_tau * tau_error).powi(2)
        + 2.0 * fall * by_tau * amplitude.covariance;
    ((amplitude.force * fall).abs(), variance.max(0.0).sqrt())
}
