//! Least squares: linear, and non-linear by damped Gauss–Newton, with covariance and information criteria. In: the residuals of a
//! model. Out: parameters and their covariance. It knows no force, no displacement and no unit.
//!
//! The residuals are rᵢ(p) = yᵢ − f(xᵢ; p), their Jacobian J = ∂r/∂p. A step of Gauss–Newton and the covariance of the parameters
//! at the optimum are
//!
//! ```text
//! δp = −(JᵀJ)⁻¹ Jᵀr            V = s² (JᵀJ)⁻¹,   s² = rᵀr / (n − k)
//! ```
//!
//! with n readings and k parameters (Nocedal & Wright, *Numerical Optimization*, 2006, sec. 10.3; JCGM 100, G.3.3). A model whose
//! other parameters are linear may keep them out of p and give the residuals that their own least squares leave, with J projected
//! likewise (variable projection; Kaufman, BIT 15 (1975) 49–57).

use nalgebra::{DMatrix, DVector};

/// Largest number of steps of one descent.
const MAX_STEPS: usize = 60;
/// Largest number of halvings of a step.
const MAX_HALVINGS: usize = 12;
/// A step shorter than this in every parameter ends the descent. Parameters are therefore chosen of the order of 1.
const SHORTEST_STEP: f64 = 1e-10;

/// A model of readings, given by its residuals.
pub trait Residuals {
    /// r(p), reading minus model; None if the model has no value.
    fn residuals(&self, parameters: &DVector<f64>) -> Option<DVector<f64>>;

    /// J = ∂r/∂p, one column for each parameter.
    fn jacobian(&self, parameters: &DVector<f64>) -> Option<DMatrix<f64>>;

    /// The largest fraction of a step for which the linearisation holds, at most 1.
    fn longest_fraction(&self, _step: &DVector<f64>) -> f64 {
        1.0
    }

    /// The nearest parameters within the bounds of the model.
    fn bounded(&self, parameters: DVector<f64>) -> DVector<f64> {
        parameters
    }
}

/// Damped Gauss–Newton from `start`: every step is halved until the sum of squares falls. Ends where it falls no more, or where the
/// Jacobian is rank-deficient. None if the model has no value at the start.
#[must_use]
pub fn minimize(model: &impl Residuals, start: DVector<f64>) -> Option<DVector<f64>> {
    let mut parameters = start;
    let mut residuals = model.residuals(&parameters)?;
    for _ in 0..MAX_STEPS {
        let Some(step) = gauss_newton_step(model, &parameters, &residuals) else {
            break;
        };
        let mut fraction = model.longest_fraction(&step);
        let squares = residuals.norm_squared();
        let better = (0..MAX_HALVINGS).find_map(|_| {
            let next = model.bounded(&parameters + &step * fraction);
            fraction *= 0.5;
            let left = model.residuals(&next)?;
            (left.norm_squared() < squares).then_some((next, left))
        });
        let Some((next, left)) = better else { break };
        let moved = (&next - &parameters).amax();
        (parameters, residuals) = (next, left);
        if moved < SHORTEST_STEP {
            break;
        }
    }
    Some(parameters)
}

/// δp = −(JᵀJ)⁻¹Jᵀr.
fn gauss_newton_step(
    model: &impl Residuals,
    parameters: &DVector<f64>,
    residuals: &DVector<f64>,
) -> Option<DVector<f64>> {
    let jacobian = model.jacobian(parameters)?;
    let gradient = jacobian.tr_mul(residuals);
    Some(-(inverse_normal(&jacobian.tr_mul(&jacobian))? * gradient))
}

/// ∂r/∂p by central differences over ± `widths`.
#[must_use]
pub fn central_jacobian(
    model: &impl Residuals,
    parameters: &DVector<f64>,
    widths: &[f64],
) -> Option<DMatrix<f64>> {
    let columns = widths.iter().enumerate().map(|(index, width)| {
        let shifted = |by: f64| {
            let mut shifted = parameters.clone();
            shifted[index] += by;
            model.residuals(&shifted)
        };
        Some((shifted(*width)? - shifted(-width)?) / (2.0 * width))
    });
    let columns: Option<Vec<DVector<f64>>> = columns.collect();
    Some(DMatrix::from_columns(&columns?))
}

/// Inverse of a normal matrix JᵀJ, scaled to a unit diagonal first; None if the columns of J depend on each other.
#[must_use]
pub fn inverse_normal(normal: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scale = DMatrix::from_diagonal(&normal.diagonal().map(|square| 1.0 / square.sqrt()));
    let inverse = (&scale * normal * &scale).cholesky()?.inverse();
    let inverse = &scale * inverse * &scale;
    inverse
        .iter()
        .all(|entry| entry.is_finite())
        .then_some(inverse)
}

/// Parameters of the linear model Σ pⱼ xⱼ, by the normal equations, which Cholesky's decomposition solves alike in any scale of the
/// columns. In: for each reading the row xⱼ of `count` numbers, and the value. None if the columns depend on each other.
#[must_use]
pub fn linear<R: IntoIterator<Item = f64>>(
    readings: impl Iterator<Item = (R, f64)>,
    count: usize,
) -> Option<DVector<f64>> {
    let (mut normal, mut load) = (vec![0.0; count * count], vec![0.0; count]);
    let mut row = Vec::with_capacity(count);
    for (entries, value) in readings {
        row.clear();
        row.extend(entries);
        for (i, one) in row.iter().enumerate() {
            load[i] += one * value;
            for (j, other) in row[..=i].iter().enumerate() {
                normal[i + j * count] += one * other;
            }
        }
    }
    let solved = DMatrix::from_vec(count, count, normal)
        .cholesky()?
        .solve(&DVector::from_vec(load));
    solved
        .iter()
        .all(|entry| entry.is_finite())
        .then_some(solved)
}

/// Covariance matrix V of fitted parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariance(DMatrix<f64>);

impl Covariance {
    /// V = s²(JᵀJ)⁻¹ of the normal matrix JᵀJ and the variance s² of a reading.
    #[must_use]
    pub fn of_normal(normal: &DMatrix<f64>, variance: f64) -> Option<Self> {
        Some(Self(inverse_normal(normal)? * variance))
    }

    /// Covariance gᵀVh of two functions of the parameters with the gradients g and h.
    #[must_use]
    pub fn between(&self, one: &DVector<f64>, other: &DVector<f64>) -> f64 {
        one.dot(&(&self.0 * other))
    }

    /// Standard uncertainty √(gᵀVg) of a function of the parameters with the gradient g (JCGM 100, eq. 13).
    #[must_use]
    pub fn error(&self, gradient: &DVector<f64>) -> f64 {
        self.between(gradient, gradient).max(0.0).sqrt()
    }

    /// The lower triangle L with V = LLᵀ, the parameters in the order `order`: row by row the independent contributions to each of them.
    /// Zero for readings without scatter.
    #[must_use]
    pub fn independent(&self, order: &[usize]) -> DMatrix<f64> {
        let ordered = self.0.select_rows(order).select_columns(order);
        let unit = ordered
            .diagonal()
            .map(|variance| if variance > 0.0 { variance.sqrt() } else { 1.0 });
        let scaled = DMatrix::from_fn(order.len(), order.len(), |row, column| {
            ordered[(row, column)] / (unit[row] * unit[column])
        });
        scaled.cholesky().map_or_else(
            || DMatrix::zeros(order.len(), order.len()),
            |root| DMatrix::from_diagonal(&unit) * root.l(),
        )
    }
}

/// A fit by least squares, as the criteria of model selection see it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitSize {
    /// S, the sum of squares.
    pub squares: f64,
    /// n, the number of readings.
    pub count: f64,
    /// k, the number of parameters.
    pub parameters: f64,
}

impl FitSize {
    /// Schwarz's criterion (BIC) n ln(S/n) + k ln n.
    #[must_use]
    pub fn bic(&self) -> f64 {
        self.likelihood() + self.parameters * self.count.ln()
    }

    /// BIC with the correction of McQuarrie (*A small-sample correction for the Schwarz SIC model selection criterion*, Statistics &
    /// Probability Letters 44 (1999) 79–86): n ln(S/n) + k ln n · n/(n − k − 2). Infinite for too few readings.
    #[must_use]
    pub fn corrected_bic(&self) -> f64 {
        let left = self.count - self.parameters - 2.0;
        if left <= 0.0 {
            f64::INFINITY
        } else {
            self.likelihood() + self.parameters * self.count.ln() * self.count / left
        }
    }

    /// n ln(S/n)
    fn likelihood(&self) -> f64 {
        self.count * (self.squares / self.count).ln()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::testing::normal;

    /// y = p₀ e^(−p₁ x).
    struct Decay(Vec<(f64, f64)>);

    impl Residuals for Decay {
        fn residuals(&self, parameters: &DVector<f64>) -> Option<DVector<f64>> {
            let model = |x: f64| parameters[0] * (-parameters[1] * x).exp();
            let left = self.0.iter().map(|(x, y)| y - model(*x));
            Some(DVector::from_iterator(self.0.len(), left))
        }

        fn jacobian(&self, parameters: &DVector<f64>) -> Option<DMatrix<f64>> {
            central_jacobian(self, parameters, &[1e-5, 1e-5])
        }
    }

    fn decay(noise: &mut dyn FnMut() -> f64) -> Decay {
        let reading = |index: u32| {
            let x = 0.1 * f64::from(index);
            (x, 2.0 * (-1.5 * x).exp() + noise())
        };
        Decay((0..30).map(reading).collect())
    }

    #[test]
    fn exact_readings_give_the_parameters() {
        let found = minimize(&decay(&mut || 0.0), DVector::from_vec(vec![1.0, 0.5])).unwrap();
        assert!(
            (found[0] - 2.0).abs() < 1e-9 && (found[1] - 1.5).abs() < 1e-9,
            "{found}"
        );
    }

    /// 400 fits scatter by the standard uncertainties that each of them states, and are correlated likewise.
    #[test]
    fn the_covariance_is_that_of_many_fits() {
        let mut state = 17;
        let mut noise = || 0.02 * normal(&mut state);
        let fits: Vec<DVector<f64>> = (0..400)
            .map(|_| minimize(&decay(&mut noise), DVector::from_vec(vec![1.0, 0.5])).unwrap())
            .collect();
        let exact = DVector::from_vec(vec![2.0, 1.5]);
        let jacobian = decay(&mut || 0.0).jacobian(&exact).unwrap();
        let stated = Covariance::of_normal(&jacobian.tr_mul(&jacobian), 4e-4).unwrap();
        let axis =
            |index: usize| DVector::from_fn(2, |row, _| if row == index { 1.0 } else { 0.0 });
        for (one, other) in [(0, 0), (1, 1), (0, 1)] {
            let found = fits
                .iter()
                .map(|fit| (fit[one] - exact[one]) * (fit[other] - exact[other]))
                .sum::<f64>()
                / 400.0;
            let stated = stated.between(&axis(one), &axis(other));
            assert!(
                (found / stated - 1.0).abs() < 0.2,
                "{one}, {other}: {found}, stated {stated}"
            );
        }
        let root = stated.independent(&[1, 0]);
        assert!((root[(0, 0)] / stated.error(&axis(1)) - 1.0).abs() < 1e-12);
        assert!((root.row(1).norm() / stated.error(&axis(0)) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn dependent_columns_have_no_solution() {
        let readings = || (0..5).map(|x| ([f64::from(x), 2.0 * f64::from(x)], f64::from(x)));
        assert_eq!(linear(readings(), 2), None);
        let line = linear((0..5).map(|x| ([1.0, f64::from(x)], 3.0 - f64::from(x))), 2).unwrap();
        assert!((line[0] - 3.0).abs() < 1e-14 && (line[1] + 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_criterion_counts_parameters() {
        let fit = FitSize {
            squares: 10.0,
            count: 10.0,
            parameters: 3.0,
        };
        assert!((fit.bic() - 3.0 * 10.0_f64.ln()).abs() < 1e-12);
        assert!(fit.corrected_bic() > fit.bic());
        let short = FitSize { count: 5.0, ..fit };
        assert_eq!(short.corrected_bic(), f64::INFINITY);
    }
}
