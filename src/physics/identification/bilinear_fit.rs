//! Two straight lines that meet, fitted to a ramp past yield. In: displacements and forces. Out: initial stiffness, yield point and
//! post-yield stiffness, each with its standard error. It knows no rig and no plan.

use super::StatedVariance;
use super::multilinear_fit::{MultilinearFit, ScaledCurve};
use super::polyline::Polyline;

/// R = `intercept` + K·X up to the yield point, and on from there with `K_p`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BilinearFit {
    /// +1 or −1: the direction of the ramp. The yield point is on that side.
    pub direction: f64,
    /// Force at zero displacement \[N\].
    pub intercept: f64,
    pub intercept_error: f64,
    /// K \[N/m\]
    pub stiffness: f64,
    pub stiffness_error: f64,
    /// `K_p` \[N/m\]
    pub post_yield_stiffness: f64,
    pub post_yield_stiffness_error: f64,
    /// \[m\]
    pub yield_displacement: f64,
    pub yield_displacement_error: f64,
    /// \[N\]
    pub yield_force: f64,
    pub yield_force_error: f64,
    /// `K_p`/K
    pub post_yield_ratio: f64,
    pub post_yield_ratio_error: f64,
    pub shares: BilinearShares,
    pub r_squared: f64,
    /// Degrees of freedom of the scatter about the two lines: number of points minus four parameters.
    pub degrees: f64,
    /// Fraction of the standard errors that the scatter shows; the rest is stated.
    pub shown: f64,
}

/// The errors of the results of a bilinear fit, each as a sum of four independent contributions: of the stiffness, then of the parts of
/// intercept, `K_p` and yield displacement that are uncorrelated with those before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BilinearShares {
    pub stiffness: [f64; 4],
    pub intercept: [f64; 4],
    pub post_yield_stiffness: [f64; 4],
    pub yield_displacement: [f64; 4],
    pub yield_force: [f64; 4],
    pub post_yield_ratio: [f64; 4],
}

/// Points on either side of the yield point, at least: fewer determine no line.
const FEWEST_ON_A_SIDE: usize = 2;
/// Points of a ramp, at least.
const FEWEST_POINTS: usize = 6;

impl BilinearFit {
    /// Force of the two lines at `displacement` \[m\], in \[N\].
    #[must_use]
    pub fn force(&self, displacement: f64) -> f64 {
        let sign = self.direction;
        let beyond = sign * (sign * (displacement - self.yield_displacement)).max(0.0);
        self.intercept
            + self.stiffness * (displacement - beyond)
            + self.post_yield_stiffness * beyond
    }

    /// The curve of two segments, read as yield point and stiffnesses.
    fn of_segments(fit: &MultilinearFit) -> Self {
        let row = |shares: &[f64]| [shares[0], shares[1], shares[2], shares[3]];
        let [stiffness, post_yield] = [fit.stiffnesses[0], fit.stiffnesses[1]];
        let (displacement, force) = (fit.breakpoints[0], fit.forces[0]);
        Self {
            direction: fit.direction,
            intercept: fit.intercept.0,
            intercept_error: fit.intercept.1,
            stiffness: stiffness.0,
            stiffness_error: stiffness.1,
            post_yield_stiffness: post_yield.0,
            post_yield_stiffness_error: post_yield.1,
            yield_displacement: displacement.0,
            yield_displacement_error: displacement.1,
            yield_force: force.0,
            yield_force_error: force.1,
            post_yield_ratio: fit.post_yield_ratio.0,
            post_yield_ratio_error: fit.post_yield_ratio.1,
            shares: BilinearShares {
                stiffness: row(&fit.shares.stiffnesses[0]),
                intercept: row(&fit.shares.intercept),
                post_yield_stiffness: row(&fit.shares.stiffnesses[1]),
                yield_displacement: row(&fit.shares.breakpoints[0]),
                yield_force: row(&fit.shares.forces[0]),
                post_yield_ratio: row(&fit.shares.post_yield_ratio),
            },
            r_squared: fit.r_squared,
            degrees: fit.degrees,
            shown: fit.shown,
        }
    }
}

/// Least squares over both lines and the yield point together. Standard errors are those of the linearised model at the optimum.
/// None of fewer than six points, or where no yield point softens. A pulling ramp is fitted as the pushing one it mirrors.
#[must_use]
pub fn fit_bilinear(x: &[f64], y: &[f64], stated: StatedVariance) -> Option<BilinearFit> {
    let curve = ScaledCurve::new(x, y).filter(|_| x.len() >= FEWEST_POINTS)?;
    let fit = curve.fit(&best_of_two(&curve.points)?, Vec::new(), stated)?;
    let fit = BilinearFit::of_segments(&fit);
    (fit.stiffness > 0.0 && fit.post_yield_stiffness < fit.stiffness).then_some(fit)
}

/// The best line of two segments, exactly: between two neighbouring points the best breakpoint is where the lines through either side
/// meet, if they meet there, else one of the two points.
fn best_of_two(points: &[(f64, f64)]) -> Option<Polyline> {
    let splits = FEWEST_ON_A_SIDE..=points.len() - FEWEST_ON_A_SIDE;
    let candidates = splits.flat_map(|split| {
        let (left, right) = points.split_at(split);
        let (low, high) = (left[split - 1].0, right[0].0);
        let lines = Polyline::through(left, &[]).zip(Polyline::through(right, &[]));
        let meeting = lines
            .map(|(one, other)| {
                let [one, other] = [one.coefficients, other.coefficients];
                (other[0] - one[0]) / (one[1] - other[1])
            })
            .filter(|at| *at > low && *at < high);
        [Some(low), meeting]
    });
    candidates
        .flatten()
        .filter_map(|at| Polyline::through(points, &[at]))
        .min_by(|a, b| a.squares.total_cmp(&b.squares))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::testing::normal;

    /// Of readings without stated errors.
    fn fit_bilinear(x: &[f64], y: &[f64]) -> Option<BilinearFit> {
        super::fit_bilinear(x, y, StatedVariance::default())
    }

    type Read = fn(&BilinearFit) -> f64;

    /// K 400 kN/m, yield point at 10.3 mm and 4.12 kN, `K_p` 32 kN/m.
    fn ramp(noise: &mut dyn FnMut() -> f64) -> (Vec<f64>, Vec<f64>) {
        (1..=40)
            .map(|step| {
                let x = f64::from(step) * 0.5e-3;
                (
                    x,
                    4e5 * x.min(0.0103) + 3.2e4 * (x - 0.0103).max(0.0) + noise(),
                )
            })
            .unzip()
    }

    #[test]
    fn without_noise_the_two_lines_are_exact() {
        let (x, y) = ramp(&mut || 0.0);
        let fit = fit_bilinear(&x, &y).unwrap();
        assert!(
            (fit.stiffness / 4e5 - 1.0).abs() < 1e-9
                && (fit.post_yield_stiffness / 3.2e4 - 1.0).abs() < 1e-8
        );
        assert!(
            (fit.yield_displacement - 0.0103).abs() < 1e-11
                && (fit.yield_force - 4120.0).abs() < 1e-5
        );
        assert!(
            (fit.post_yield_ratio - 0.08).abs() < 1e-9
                && fit.r_squared > 1.0 - 1e-12
                && fit.intercept.abs() < 1e-5
        );
        assert!((fit.force(0.02) - y[39]).abs() < 1e-5);
    }

    /// A pulling ramp gives the mirrored yield point, bit-identical: opposite displacement and force, the same stiffnesses and errors,
    /// mirrored shares.
    #[test]
    fn a_pulling_ramp_is_the_mirrored_one() {
        let mut state = 11;
        let (x, y) = ramp(&mut || 40.0 + 15.0 * normal(&mut state));
        let minus = |values: &[f64]| values.iter().map(|value| -value).collect::<Vec<f64>>();
        let (push, pull) = (
            fit_bilinear(&x, &y).unwrap(),
            fit_bilinear(&minus(&x), &minus(&y)).unwrap(),
        );
        assert_eq!((push.direction, pull.direction), (1.0, -1.0));
        assert!(
            (push.yield_displacement - 0.0103).abs() < 1e-3 && (push.intercept - 40.0).abs() < 30.0,
            "{push:?}"
        );
        let same: [Read; 8] = [
            |fit| fit.stiffness,
            |fit| fit.post_yield_stiffness,
            |fit| fit.post_yield_ratio,
            |fit| fit.intercept_error,
            |fit| fit.yield_displacement_error,
            |fit| fit.yield_force_error,
            |fit| fit.post_yield_ratio_error,
            |fit| fit.r_squared,
        ];
        let opposite: [Read; 3] = [
            |fit| fit.intercept,
            |fit| fit.yield_displacement,
            |fit| fit.yield_force,
        ];
        assert!(same.iter().all(|read| read(&push) == read(&pull)));
        assert!(opposite.iter().all(|read| read(&push) == -read(&pull)));
        for x in &x {
            assert_eq!(push.force(*x), -pull.force(-x));
        }
        let BilinearShares {
            stiffness,
            intercept,
            yield_displacement: yield_point,
            yield_force: force,
            ..
        } = pull.shares;
        for column in 0..4 {
            let by_hand = intercept[column]
                + pull.yield_displacement * stiffness[column]
                + pull.stiffness * yield_point[column];
            assert!((force[column] - by_hand).abs() < 1e-9 * pull.yield_force_error);
        }
        // The contribution of the stiffness to the intercept has the opposite sign.
        assert_eq!(stiffness, push.shares.stiffness);
        assert_eq!(intercept[0], -push.shares.intercept[0]);
    }

    /// The squares of the shares add up to the square of the error, and `F_y` = R₀ + K·`X_y` gives its row from the others.
    #[test]
    fn the_shares_add_up_to_the_errors_and_give_the_correlations() {
        let mut index = 0.0_f64;
        let (x, y) = ramp(&mut || {
            index += 1.0;
            20.0 * (index * index).sin()
        });
        let fit = fit_bilinear(&x, &y).unwrap();
        let BilinearShares {
            stiffness,
            intercept,
            post_yield_stiffness,
            yield_displacement,
            yield_force,
            post_yield_ratio,
        } = fit.shares;
        for (row, error) in [
            (stiffness, fit.stiffness_error),
            (intercept, fit.intercept_error),
            (post_yield_stiffness, fit.post_yield_stiffness_error),
            (yield_displacement, fit.yield_displacement_error),
            (yield_force, fit.yield_force_error),
            (post_yield_ratio, fit.post_yield_ratio_error),
        ] {
            let size = row.iter().map(|share| share * share).sum::<f64>().sqrt();
            assert!((size / error - 1.0).abs() < 1e-9, "{size} {error}");
        }
        for column in 0..4 {
            let by_hand = intercept[column]
                + fit.yield_displacement * stiffness[column]
                + fit.stiffness * yield_displacement[column];
            assert!((yield_force[column] - by_hand).abs() < 1e-9 * fit.yield_force_error);
        }
        assert_eq!(
            stiffness[1..],
            [0.0; 3],
            "the stiffness is the first independent error"
        );
    }

    /// The standard deviation of 1000 fits is the standard error that each of them states.
    #[test]
    fn the_standard_errors_are_the_scatter_of_many_fits() {
        let mut state = 3;
        let mut noise = || 15.0 * normal(&mut state);
        let fits: Vec<BilinearFit> = (0..1000)
            .map(|_| {
                let (x, y) = ramp(&mut noise);
                fit_bilinear(&x, &y).unwrap()
            })
            .collect();
        let readings: [(Read, Read, f64); 4] = [
            (|fit| fit.stiffness, |fit| fit.stiffness_error, 4e5),
            (
                |fit| fit.post_yield_stiffness,
                |fit| fit.post_yield_stiffness_error,
                3.2e4,
            ),
            (|fit| fit.yield_force, |fit| fit.yield_force_error, 4120.0),
            (
                |fit| fit.post_yield_ratio,
                |fit| fit.post_yield_ratio_error,
                0.08,
            ),
        ];
        for (value, error, exact) in readings {
            let mean = fits.iter().map(value).sum::<f64>() / 1000.0;
            let deviation = (fits
                .iter()
                .map(|fit| (value(fit) - mean).powi(2))
                .sum::<f64>()
                / 999.0)
                .sqrt();
            let stated = (fits.iter().map(|fit| error(fit).powi(2)).sum::<f64>() / 1000.0).sqrt();
            // The standard deviation of 1000 fits has a relative uncertainty of 2.2 %.
            assert!(
                (deviation / stated - 1.0).abs() < 0.08,
                "{deviation} is stated as {stated}"
            );
            assert!(
                (mean - exact).abs() < 4.0 * deviation / 1000_f64.sqrt(),
                "{mean} is not {exact}"
            );
        }
    }

    #[test]
    fn a_straight_line_and_too_few_points_have_no_yield_point() {
        let x: Vec<f64> = (0..20).map(f64::from).collect();
        let stiffening: Vec<f64> = x.iter().map(|x| x.max(3.0 * x - 20.0)).collect();
        assert_eq!(fit_bilinear(&x, &stiffening), None);
        assert_eq!(fit_bilinear(&x[..5], &x[..5]), None);
    }
}
