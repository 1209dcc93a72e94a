//! A backbone of two straight lines that meet, fitted to a ramp past yield. In: displacements and forces. Out: initial
//! stiffness, the knee, the stiffness past it, each with its standard error. It knows no rig and no plan.

use nalgebra::{Matrix4, Vector4};

use super::StatedVariance;

/// R = `intercept` + K·X up to the knee, and on from there with `K_p`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BilinearFit {
    /// +1 or −1: the way the ramp went. Knee and force there are on that side.
    pub way: f64,
    /// N
    pub intercept: f64,
    pub intercept_error: f64,
    /// K, N/m
    pub stiffness: f64,
    pub stiffness_error: f64,
    /// `K_p`, N/m
    pub hardened: f64,
    pub hardened_error: f64,
    /// m
    pub yield_displacement: f64,
    pub yield_displacement_error: f64,
    /// Force at the knee, N.
    pub yield_force: f64,
    pub yield_force_error: f64,
    /// `K_p`/K
    pub hardening: f64,
    pub hardening_error: f64,
    /// Each error in [`SHARED`]'s order as a sum of four that are independent of each other: that of the stiffness, then what
    /// goes beyond it of intercept, `K_p` and knee. The same columns in two rows are what the two share.
    pub shares: [[f64; 4]; 6],
    pub r_squared: f64,
    /// Degrees of freedom of the scatter about the two lines: the points less their four numbers.
    pub degrees: f64,
    /// Fraction of the standard errors that the scatter shows; the rest is stated.
    pub shown: f64,
}

/// Results of a bilinear fit in the order of their shares; the first four name the independent errors.
pub const SHARED: [&str; 6] = [
    "stiffness",
    "intercept_force",
    "hardened_stiffness",
    "yield_displacement",
    "yield_force",
    "hardening",
];

impl BilinearFit {
    /// Force of the two lines at `displacement` (m), N.
    #[must_use]
    pub fn force(&self, displacement: f64) -> f64 {
        let beyond = self.way * (self.way * (displacement - self.yield_displacement)).max(0.0);
        self.intercept + self.stiffness * (displacement - beyond) + self.hardened * beyond
    }

    /// Of the same lines through the origin's other side: places and forces change their signs, and what they share with the
    /// stiffnesses, which do not.
    fn mirrored(self) -> Self {
        let [stiffness, intercept, hardened, knee, force, hardening] = self.shares;
        let other = |shares: [f64; 4]| shares.map(|share| -share);
        Self {
            way: -self.way,
            intercept: -self.intercept,
            yield_displacement: -self.yield_displacement,
            yield_force: -self.yield_force,
            shares: [
                stiffness,
                other(intercept),
                hardened,
                other(knee),
                other(force),
                hardening,
            ],
            ..self
        }
    }
}

/// Points on either side of the knee, at least: fewer bear no line.
const FEWEST: usize = 2;

/// Least squares over both lines and the knee together: between two neighbouring points the best knee is
/// where the lines through either side meet, if they meet there, else one of the two points; the best of all is taken.
/// Standard errors are those of the linearised model at the optimum. None of fewer than six points, or where the force
/// shows no knee that softens. A ramp that pulls is fitted as the one it mirrors.
#[must_use]
pub fn fit_bilinear(x: &[f64], y: &[f64]) -> Option<BilinearFit> {
    fit_bilinear_stated(x, y, StatedVariance::default())
}

/// The same of readings with stated errors.
#[must_use]
pub fn fit_bilinear_stated(x: &[f64], y: &[f64], stated: StatedVariance) -> Option<BilinearFit> {
    if x.len() != y.len() || x.len() < 6 {
        return None;
    }
    let way = if x.iter().sum::<f64>() < 0.0 {
        -1.0
    } else {
        1.0
    };
    let mut points: Vec<(f64, f64)> = x.iter().zip(y).map(|(x, y)| (way * x, way * y)).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best: Option<(f64, f64)> = None;
    let mut consider = |knee: f64| {
        if let Some((_, squares)) = at_knee(&points, knee)
            && best.is_none_or(|(_, least)| squares < least)
        {
            best = Some((knee, squares));
        }
    };
    for split in FEWEST..=points.len() - FEWEST {
        let (left, right) = points.split_at(split);
        let (low, high) = (left[split - 1].0, right[0].0);
        consider(low);
        if let (Some(one), Some(other)) = (line(left), line(right)) {
            let meet = (other.0 - one.0) / (one.1 - other.1);
            if meet > low && meet < high {
                consider(meet);
            }
        }
    }
    let (knee, squares) = best?;
    let (found, _) = at_knee(&points, knee)?;
    let fit = fitted(&points, knee, found, (squares, stated))
        .filter(|fit| fit.stiffness > 0.0 && fit.hardened < fit.stiffness)?;
    Some(if way < 0.0 { fit.mirrored() } else { fit })
}

/// Intercept and slope through points of which two differ in x.
fn line(points: &[(f64, f64)]) -> Option<(f64, f64)> {
    #[expect(clippy::cast_precision_loss, reason = "far fewer points than 2^53")]
    let count = points.len() as f64;
    let mean = |read: fn(&(f64, f64)) -> f64| points.iter().map(read).sum::<f64>() / count;
    let (mean_x, mean_y) = (mean(|point| point.0), mean(|point| point.1));
    let xx: f64 = points.iter().map(|point| (point.0 - mean_x).powi(2)).sum();
    let xy: f64 = points
        .iter()
        .map(|point| (point.0 - mean_x) * (point.1 - mean_y))
        .sum();
    (xx > 0.0).then(|| (mean_y - xy / xx * mean_x, xy / xx))
}

/// Intercept, K and `K_p` for a knee, and the sum of squares that is left.
fn at_knee(points: &[(f64, f64)], knee: f64) -> Option<([f64; 3], f64)> {
    // Scaled to the knee, so that the normal equations are well conditioned.
    let scale = points
        .iter()
        .fold(0.0, |most: f64, point| most.max(point.0.abs()));
    let row =
        |x: f64| nalgebra::Vector3::new(1.0, x.min(knee) / scale, (x - knee).max(0.0) / scale);
    let (mut normal, mut load) = (nalgebra::Matrix3::zeros(), nalgebra::Vector3::zeros());
    for (x, y) in points {
        let row = row(*x);
        normal += row * row.transpose();
        load += row * *y;
    }
    let solved = normal.cholesky()?.solve(&load);
    let squares = points
        .iter()
        .map(|(x, y)| (y - row(*x).dot(&solved)).powi(2))
        .sum();
    Some(([solved[0], solved[1] / scale, solved[2] / scale], squares))
}

fn fitted(
    points: &[(f64, f64)],
    knee: f64,
    [intercept, stiffness, hardened]: [f64; 3],
    (squares, stated): (f64, StatedVariance),
) -> Option<BilinearFit> {
    #[expect(clippy::cast_precision_loss, reason = "far fewer points than 2^53")]
    let count = points.len() as f64;
    let scale = points
        .iter()
        .fold(0.0, |most: f64, point| most.max(point.0.abs()));
    // Effects of intercept, K, K_p (both per scale) and of the knee, whose unit is that of the force by the same scale.
    let mut normal = Matrix4::zeros();
    for (x, _) in points {
        let beyond = if *x > knee {
            (stiffness - hardened) * scale
        } else {
            0.0
        };
        let row = Vector4::new(
            1.0,
            x.min(knee) / scale,
            (x - knee).max(0.0) / scale,
            beyond,
        );
        normal += row * row.transpose();
    }
    let size = normal[(3, 3)].sqrt().max(f64::MIN_POSITIVE);
    let unit = Vector4::new(1.0, 1.0, 1.0, 1.0 / size);
    let normal = Matrix4::from_diagonal(&unit) * normal * Matrix4::from_diagonal(&unit);
    let (variance, shown) = stated.counted(squares / (count - 4.0), stiffness);
    let covariance = normal.try_inverse()? * variance;
    let to_si = Vector4::new(1.0, 1.0 / scale, 1.0 / scale, scale / size);
    let covariance = Matrix4::from_diagonal(&to_si) * covariance * Matrix4::from_diagonal(&to_si);
    // Of stiffness, intercept, K_p, knee, in this order; of points without scatter there is no error to share.
    let ordered = covariance
        .select_rows(&[1, 0, 2, 3])
        .select_columns(&[1, 0, 2, 3]);
    let independent = ordered.cholesky().map_or_else(Matrix4::zeros, |root| {
        root.l().fixed_view::<4, 4>(0, 0).into_owned()
    });
    let share = |effect: Vector4<f64>| -> [f64; 4] {
        let row =
            Vector4::new(effect[1], effect[0], effect[2], effect[3]).transpose() * independent;
        [row[0], row[1], row[2], row[3]]
    };
    let (of_force, of_hardening) = (
        Vector4::new(1.0, knee, 0.0, stiffness),
        Vector4::new(
            0.0,
            -hardened / (stiffness * stiffness),
            1.0 / stiffness,
            0.0,
        ),
    );
    let effects = [
        Vector4::y(),
        Vector4::x(),
        Vector4::z(),
        Vector4::w(),
        of_force,
        of_hardening,
    ];
    let error = |effect: Vector4<f64>| {
        (effect.transpose() * covariance * effect)[(0, 0)]
            .max(0.0)
            .sqrt()
    };
    let mean = points.iter().map(|point| point.1).sum::<f64>() / count;
    let total: f64 = points.iter().map(|point| (point.1 - mean).powi(2)).sum();
    Some(BilinearFit {
        way: 1.0,
        intercept,
        intercept_error: error(Vector4::new(1.0, 0.0, 0.0, 0.0)),
        stiffness,
        stiffness_error: error(Vector4::new(0.0, 1.0, 0.0, 0.0)),
        hardened,
        hardened_error: error(Vector4::new(0.0, 0.0, 1.0, 0.0)),
        yield_displacement: knee,
        yield_displacement_error: error(Vector4::new(0.0, 0.0, 0.0, 1.0)),
        yield_force: intercept + stiffness * knee,
        yield_force_error: error(of_force),
        hardening: hardened / stiffness,
        hardening_error: error(of_hardening),
        shares: effects.map(share),
        r_squared: if total > 0.0 {
            1.0 - squares / total
        } else {
            1.0
        },
        degrees: count - 4.0,
        shown,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::testing::normal;

    type Read = fn(&BilinearFit) -> f64;

    /// K 400 kN/m, knee at 10.3 mm and 4.12 kN, `K_p` 32 kN/m.
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
    fn without_noise_it_finds_the_two_lines() {
        let (x, y) = ramp(&mut || 0.0);
        let fit = fit_bilinear(&x, &y).unwrap();
        assert!(
            (fit.stiffness / 4e5 - 1.0).abs() < 1e-9 && (fit.hardened / 3.2e4 - 1.0).abs() < 1e-8
        );
        assert!(
            (fit.yield_displacement - 0.0103).abs() < 1e-11
                && (fit.yield_force - 4120.0).abs() < 1e-5
        );
        assert!(
            (fit.hardening - 0.08).abs() < 1e-9
                && fit.r_squared > 1.0 - 1e-12
                && fit.intercept.abs() < 1e-5
        );
        assert!((fit.force(0.02) - y[39]).abs() < 1e-5);
    }

    /// A ramp that pulls finds the knee of the ramp it mirrors, to the last bit: places and forces on the other side, the same
    /// stiffnesses and errors, and what they share as the mirrored lines have it.
    #[test]
    fn a_pulling_ramp_is_the_mirrored_one() {
        let mut state = 11;
        let (x, y) = ramp(&mut || 40.0 + 15.0 * normal(&mut state));
        let minus = |values: &[f64]| values.iter().map(|value| -value).collect::<Vec<f64>>();
        let (push, pull) = (
            fit_bilinear(&x, &y).unwrap(),
            fit_bilinear(&minus(&x), &minus(&y)).unwrap(),
        );
        assert_eq!((push.way, pull.way), (1.0, -1.0));
        assert!(
            (push.yield_displacement - 0.0103).abs() < 1e-3 && (push.intercept - 40.0).abs() < 30.0,
            "{push:?}"
        );
        let same: [Read; 8] = [
            |fit| fit.stiffness,
            |fit| fit.hardened,
            |fit| fit.hardening,
            |fit| fit.intercept_error,
            |fit| fit.yield_displacement_error,
            |fit| fit.yield_force_error,
            |fit| fit.hardening_error,
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
        let [stiffness, intercept, _, knee, force, _] = pull.shares;
        for column in 0..4 {
            let by_hand = intercept[column]
                + pull.yield_displacement * stiffness[column]
                + pull.stiffness * knee[column];
            assert!((force[column] - by_hand).abs() < 1e-9 * pull.yield_force_error);
        }
        // The share that the stiffness has in the force at no displacement has the other sign.
        assert_eq!(stiffness, push.shares[0]);
        assert_eq!(intercept[0], -push.shares[1][0]);
    }

    /// Errors that share: their sums of squares are the errors themselves, and `F_y` = R₀ + K·`X_y` makes its row of the others.
    #[test]
    fn its_shares_are_its_errors_and_know_what_follows_from_what() {
        let mut at = 0.0_f64;
        let (x, y) = ramp(&mut || {
            at += 1.0;
            20.0 * (at * at).sin()
        });
        let fit = fit_bilinear(&x, &y).unwrap();
        let errors = [
            fit.stiffness_error,
            fit.intercept_error,
            fit.hardened_error,
            fit.yield_displacement_error,
            fit.yield_force_error,
            fit.hardening_error,
        ];
        for (row, error) in fit.shares.iter().zip(errors) {
            let root = row.iter().map(|share| share * share).sum::<f64>().sqrt();
            assert!((root / error - 1.0).abs() < 1e-9, "{root} {error}");
        }
        let [stiffness, intercept, _, knee, force, _] = fit.shares;
        for column in 0..4 {
            let by_hand = intercept[column]
                + fit.yield_displacement * stiffness[column]
                + fit.stiffness * knee[column];
            assert!((force[column] - by_hand).abs() < 1e-9 * fit.yield_force_error);
        }
        assert_eq!(
            stiffness[1..],
            [0.0; 3],
            "the stiffness has its own error alone"
        );
    }

    /// The spread of a thousand fits is the standard error that each of them states.
    #[test]
    fn its_standard_errors_are_the_spread_of_many_fits() {
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
            (|fit| fit.hardened, |fit| fit.hardened_error, 3.2e4),
            (|fit| fit.yield_force, |fit| fit.yield_force_error, 4120.0),
            (|fit| fit.hardening, |fit| fit.hardening_error, 0.08),
        ];
        for (value, error, exact) in readings {
            let mean = fits.iter().map(value).sum::<f64>() / 1000.0;
            let spread = (fits
                .iter()
                .map(|fit| (value(fit) - mean).powi(2))
                .sum::<f64>()
                / 999.0)
                .sqrt();
            let stated = (fits.iter().map(|fit| error(fit).powi(2)).sum::<f64>() / 1000.0).sqrt();
            // 1000 fits tell a spread to 2.2 %.
            assert!(
                (spread / stated - 1.0).abs() < 0.08,
                "{spread} is stated as {stated}"
            );
            assert!(
                (mean - exact).abs() < 4.0 * spread / 1000_f64.sqrt(),
                "{mean} is not {exact}"
            );
        }
    }

    #[test]
    fn a_straight_line_and_too_few_points_have_no_knee() {
        let x: Vec<f64> = (0..20).map(f64::from).collect();
        let stiffening: Vec<f64> = x.iter().map(|x| x.max(3.0 * x - 20.0)).collect();
        assert_eq!(fit_bilinear(&x, &stiffening), None);
        assert_eq!(fit_bilinear(&x[..5], &x[..5]), None);
    }
}
