//! A multilinear curve fitted to a ramp or a backbone: straight stretches that meet at breaks. In: displacements and forces, how
//! many breaks. Out: stiffness of every stretch, the breaks, each with its standard error. It knows no rig and no plan.

use nalgebra::{DMatrix, DVector};

use super::StatedVariance;
use super::breakpoints::{FEWEST, Polyline, best_lines, row};

/// Breaks of one curve, at most.
pub const MOST_BREAKS: usize = 8;

/// How many breaks a curve has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BreakCount {
    Exactly(usize),
    /// As many as leave the least N ln(SSE/N) + p ln N (Schwarz's criterion, BIC), p = 2n + 2 numbers for n breaks.
    ByCriterion {
        most: usize,
    },
}

/// R = `intercept` + K₁·X up to the first break, and on from there with the next stiffness.
#[derive(Clone, Debug, PartialEq)]
pub struct MultilinearFit {
    /// +1 or −1: the way the ramp went.
    pub way: f64,
    /// Force at no displacement, N, with its standard error.
    pub intercept: (f64, f64),
    /// K of each stretch, from the start on, N/m.
    pub stiffnesses: Vec<(f64, f64)>,
    /// Where two stretches meet, m.
    pub breaks: Vec<(f64, f64)>,
    /// Force there, N.
    pub forces: Vec<(f64, f64)>,
    /// Last stiffness over the first.
    pub hardening: (f64, f64),
    /// Standard error of the change of stiffness at each break, N/m.
    pub change_errors: Vec<f64>,
    pub shares: CurveShares,
    pub r_squared: f64,
    /// Degrees of freedom of the scatter about the curve: the points less its numbers.
    pub degrees: f64,
    /// Fraction of the standard errors that the scatter shows; the rest is stated.
    pub shown: f64,
    /// The criterion for 0, 1, … breaks, less its least, where it chose.
    pub criterion: Vec<f64>,
}

/// How much each number has of the independent errors of the fit, in its own unit: those of K₁, of the intercept beyond what it
/// shares with K₁, of each further stiffness and then of each break beyond what they share with all before them. Their squares
/// add up to that of the number's standard error; of points without scatter there is nothing to share.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct CurveShares {
    pub intercept: Vec<f64>,
    pub stiffnesses: Vec<Vec<f64>>,
    pub breaks: Vec<Vec<f64>>,
    pub forces: Vec<Vec<f64>>,
    pub hardening: Vec<f64>,
}

impl MultilinearFit {
    /// Force of the curve at `displacement` (m), N.
    #[must_use]
    pub fn force(&self, displacement: f64) -> f64 {
        let breaks: Vec<f64> = self
            .breaks
            .iter()
            .map(|(place, _)| self.way * place)
            .collect();
        let slopes = std::iter::once(self.way * self.intercept.0)
            .chain(self.stiffnesses.iter().map(|(slope, _)| *slope));
        self.way
            * row(self.way * displacement, &breaks)
                .zip(slopes)
                .map(|(part, by)| part * by)
                .sum::<f64>()
    }

    /// First break at which it softens: place and force, with their standard errors.
    #[must_use]
    pub fn knee(&self) -> Option<[(f64, f64); 2]> {
        let softens = self
            .stiffnesses
            .windows(2)
            .position(|pair| pair[1].0 < pair[0].0)?;
        Some([self.breaks[softens], self.forces[softens]])
    }

    /// Breaks whose change of stiffness is less than twice its standard error: the readings hardly show them.
    #[must_use]
    pub fn doubtful(&self) -> Vec<usize> {
        let changes = self
            .stiffnesses
            .windows(2)
            .map(|pair| (pair[0].0 - pair[1].0).abs());
        changes
            .zip(&self.change_errors)
            .enumerate()
            .filter(|(_, (change, error))| *change < 2.0 * **error)
            .map(|(at, _)| at)
            .collect()
    }

    /// Corners of the first loading from rest, displacement (m) and force (N), the last at `reach` (m): what a specimen of this
    /// curve is. None where a stretch does not soften, or falls.
    #[must_use]
    pub fn corners(&self, reach: f64) -> Option<Vec<[f64; 2]>> {
        let softer = self
            .stiffnesses
            .windows(2)
            .all(|pair| pair[1].0 < pair[0].0);
        let rises =
            self.stiffnesses.iter().all(|(slope, _)| *slope >= 0.0) && self.stiffnesses[0].0 > 0.0;
        let ends = self.breaks.iter().map(|(place, _)| self.way * place);
        let last = self.way * reach;
        let mut at = [0.0, 0.0];
        let corners = ends
            .chain(std::iter::once(last))
            .zip(&self.stiffnesses)
            .map(|(place, (slope, _))| {
                at = [place, at[1] + slope * (place - at[0])];
                at
            });
        let corners: Vec<[f64; 2]> = corners.collect();
        let onward = corners.windows(2).all(|pair| pair[0][0] < pair[1][0]) && corners[0][0] > 0.0;
        (softer && rises && onward).then_some(corners)
    }
}

/// Least squares over the stretches and their breaks together. Standard errors are those of the linearised model at the
/// optimum, with the breaks counted; that their number was chosen is not in them. None where the points bear no such curve.
#[must_use]
pub fn fit_multilinear(x: &[f64], y: &[f64], count: BreakCount) -> Option<MultilinearFit> {
    fit_multilinear_stated(x, y, count, StatedVariance::default())
}

/// The same of readings with stated errors.
#[must_use]
pub fn fit_multilinear_stated(
    x: &[f64],
    y: &[f64],
    count: BreakCount,
    errors: StatedVariance,
) -> Option<MultilinearFit> {
    if x.len() != y.len() || x.len() < FEWEST || !x.iter().chain(y).all(|value| value.is_finite()) {
        return None;
    }
    let way = if x.iter().sum::<f64>() < 0.0 {
        -1.0
    } else {
        1.0
    };
    let largest = |values: &[f64]| {
        values
            .iter()
            .fold(0.0, |most: f64, value| most.max(value.abs()))
    };
    let (far, strong) = (largest(x), largest(y).max(f64::MIN_POSITIVE));
    if far == 0.0 {
        return None;
    }
    // Of the size of 1 both, so that no sum is of another size than the next.
    let mut points: Vec<(f64, f64)> = x
        .iter()
        .zip(y)
        .map(|(x, y)| (way * x / far, way * y / strong))
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let most = match count {
        BreakCount::Exactly(breaks) => breaks,
        BreakCount::ByCriterion { most } => most,
    };
    // One reading more than there are numbers, for their scatter.
    let most = most.min(MOST_BREAKS);
    let lines: Vec<Polyline> = best_lines(&points, most)
        .into_iter()
        .take_while(|line| points.len() > 2 * line.breaks.len() + 2)
        .collect();
    let (line, criterion) = match count {
        BreakCount::Exactly(breaks) => (lines.into_iter().nth(breaks)?, Vec::new()),
        BreakCount::ByCriterion { .. } => chosen(lines, points.len())?,
    };
    stated(&points, &line, criterion, way, (far, strong), errors)
}

/// Scatter below this share of the largest force is rounding and no reason for another break.
const ROUNDING: f64 = 1e-9;

/// The line of the least criterion, the fewer breaks of equals, and the criterion of all less that.
fn chosen(lines: Vec<Polyline>, count: usize) -> Option<(Polyline, Vec<f64>)> {
    #[expect(clippy::cast_precision_loss, reason = "far fewer points than 2^53")]
    let (count, numbers) = (count as f64, |line: &Polyline| {
        2.0 * line.breaks.len() as f64 + 2.0
    });
    let criterion = |line: &Polyline| {
        count * (line.squares / count).max(ROUNDING * ROUNDING).ln() + numbers(line) * count.ln()
    };
    let all: Vec<f64> = lines.iter().map(criterion).collect();
    let least = all.iter().copied().fold(f64::INFINITY, f64::min);
    let place = all.iter().position(|criterion| *criterion == least)?;
    Some((
        lines.into_iter().nth(place)?,
        all.into_iter().map(|criterion| criterion - least).collect(),
    ))
}

/// The fit in SI with its standard errors.
fn stated(
    points: &[(f64, f64)],
    line: &Polyline,
    criterion: Vec<f64>,
    way: f64,
    (far, strong): (f64, f64),
    errors: StatedVariance,
) -> Option<MultilinearFit> {
    let count = line.breaks.len();
    let slopes = &line.coefficients[1..];
    // A move of a break by δ moves the force of all beyond it by (K − K')·δ.
    let beyond = |x: f64| {
        let falls = line.breaks.iter().zip(slopes.windows(2));
        falls
            .map(move |(place, pair)| if x > *place { pair[0] - pair[1] } else { 0.0 })
            .collect::<Vec<f64>>()
    };
    let size = 2 * count + 2;
    let mut normal = DMatrix::<f64>::zeros(size, size);
    for (x, _) in points {
        let parts = DVector::from_iterator(size, row(*x, &line.breaks).chain(beyond(*x)));
        normal += &parts * parts.transpose();
    }
    #[expect(clippy::cast_precision_loss, reason = "far fewer points than 2^53")]
    let freedom = (points.len() - size) as f64;
    let stiffness = strong / far;
    let (variance, shown) = errors.counted(
        line.squares / freedom * strong * strong,
        stiffness * slopes[0],
    );
    let covariance = scaled_inverse(&normal)? * (variance / (strong * strong));
    let whole = |effect: &[(usize, f64)]| {
        let mut all = DVector::<f64>::zeros(size);
        for (index, by) in effect {
            all[*index] += by;
        }
        all
    };
    let error = |effect: &[(usize, f64)]| {
        let all = whole(effect);
        (all.transpose() * &covariance * all)[(0, 0)]
            .max(0.0)
            .sqrt()
    };
    // K₁ stands before the intercept, so that an error of it is one of its own.
    let mut ordered = covariance.clone();
    ordered.swap_rows(0, 1);
    ordered.swap_columns(0, 1);
    let unit = ordered
        .diagonal()
        .map(|variance| if variance > 0.0 { variance.sqrt() } else { 1.0 });
    let scaled = DMatrix::from_fn(size, size, |row, column| {
        ordered[(row, column)] / (unit[row] * unit[column])
    });
    let root = scaled
        .cholesky()
        .map(|root| DMatrix::from_diagonal(&unit) * root.l());
    let share = |times: f64, effect: &[(usize, f64)]| -> Vec<f64> {
        let Some(root) = &root else {
            return vec![0.0; size];
        };
        let mut all = whole(effect);
        all.swap_rows(0, 1);
        (all.transpose() * root)
            .iter()
            .map(|part| times * part)
            .collect()
    };
    let first_last = (slopes[0], slopes[count]);
    let hardening = first_last.1 / first_last.0;
    let of_force = |index: usize| -> Vec<(usize, f64)> {
        let place = line.breaks[index];
        // ∂R/∂τ of the breaks before this one, and along the stretch that ends here.
        let by_slopes = row(place, &line.breaks).enumerate();
        let by_breaks = slopes
            .windows(2)
            .take(index)
            .enumerate()
            .map(|(before, pair)| (count + 2 + before, pair[0] - pair[1]));
        by_slopes
            .chain(by_breaks)
            .chain([(count + 2 + index, slopes[index])])
            .collect()
    };
    let at_break = |index: usize| {
        let parts = row(line.breaks[index], &line.breaks).zip(&line.coefficients);
        let force: f64 = parts.map(|(part, by)| part * by).sum();
        (way * strong * force, strong * error(&of_force(index)))
    };
    let of_hardening = [
        (1, -hardening / first_last.0),
        (count + 1, 1.0 / first_last.0),
    ];
    let shares = CurveShares {
        intercept: share(way * strong, &[(0, 1.0)]),
        stiffnesses: (0..=count)
            .map(|k| share(stiffness, &[(k + 1, 1.0)]))
            .collect(),
        breaks: (0..count)
            .map(|k| share(way * far, &[(count + 2 + k, 1.0)]))
            .collect(),
        forces: (0..count)
            .map(|index| share(way * strong, &of_force(index)))
            .collect(),
        hardening: share(1.0, &of_hardening),
    };
    let total = {
        #[expect(clippy::cast_precision_loss, reason = "far fewer points than 2^53")]
        let mean = points.iter().map(|(_, y)| y).sum::<f64>() / points.len() as f64;
        points.iter().map(|(_, y)| (y - mean).powi(2)).sum::<f64>()
    };
    Some(MultilinearFit {
        way,
        intercept: (
            way * strong * line.coefficients[0],
            strong * error(&[(0, 1.0)]),
        ),
        stiffnesses: (0..=count)
            .map(|k| (stiffness * slopes[k], stiffness * error(&[(k + 1, 1.0)])))
            .collect(),
        breaks: (0..count)
            .map(|k| {
                (
                    way * far * line.breaks[k],
                    far * error(&[(count + 2 + k, 1.0)]),
                )
            })
            .collect(),
        forces: (0..count).map(at_break).collect(),
        // A curve of one stretch has one stiffness, known to be its own.
        hardening: (hardening, error(&of_hardening)),
        change_errors: (0..count)
            .map(|k| stiffness * error(&[(k + 1, 1.0), (k + 2, -1.0)]))
            .collect(),
        shares,
        r_squared: if total > 0.0 {
            1.0 - line.squares / total
        } else {
            1.0
        },
        degrees: freedom,
        shown,
        criterion,
    })
}

/// The inverse of a normal matrix, taken with a diagonal of ones.
fn scaled_inverse(normal: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let unit = normal.diagonal().map(|size| 1.0 / size.sqrt());
    let scale = DMatrix::from_diagonal(&unit);
    let inverse = (&scale * normal * &scale).cholesky()?.inverse();
    Some(&scale * inverse * &scale)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::testing::normal;

    const BY_CRITERION: BreakCount = BreakCount::ByCriterion { most: 4 };

    /// 400 kN/m to 10.3 mm, 120 kN/m to 16.2 mm, 20 kN/m on; 12 N at no displacement.
    fn curve(x: f64) -> f64 {
        12.0 + row(x, &[0.0103, 0.0162])
            .zip([0.0, 4e5, 1.2e5, 2e4])
            .map(|(part, by)| part * by)
            .sum::<f64>()
    }

    fn ramp(noise: &mut dyn FnMut() -> f64) -> (Vec<f64>, Vec<f64>) {
        (1..=50)
            .map(|step| f64::from(step) * 0.5e-3)
            .map(|x| (x, curve(x) + noise()))
            .unzip()
    }

    #[test]
    fn without_noise_it_finds_the_stretches_and_their_number() {
        let (x, y) = ramp(&mut || 0.0);
        for count in [BY_CRITERION, BreakCount::Exactly(2)] {
            let fit = fit_multilinear(&x, &y, count).unwrap();
            for ((found, _), exact) in fit.stiffnesses.iter().zip([4e5, 1.2e5, 2e4]) {
                assert!(
                    (found / exact - 1.0).abs() < 1e-8,
                    "{found} N/m is not {exact}"
                );
            }
            for ((found, force), exact) in fit
                .breaks
                .iter()
                .map(|(place, _)| (*place, fit.force(*place)))
                .zip([0.0103, 0.0162])
            {
                assert!(
                    (found - exact).abs() < 1e-10 && (force - curve(exact)).abs() < 1e-5,
                    "{found} m is not {exact}"
                );
            }
            assert!(
                (fit.forces[1].0 - curve(0.0162)).abs() < 1e-5
                    && (fit.intercept.0 - 12.0).abs() < 1e-5
            );
            assert!((fit.hardening.0 - 0.05).abs() < 1e-9 && fit.r_squared > 1.0 - 1e-12);
            assert!((fit.knee().unwrap()[0].0 - 0.0103).abs() < 1e-10);
        }
    }

    #[test]
    fn a_pull_is_the_push_mirrored_and_its_corners_are_a_specimen() {
        let (x, y) = ramp(&mut || 0.0);
        let turned = |values: &[f64]| values.iter().map(|value| -value).collect::<Vec<f64>>();
        let (push, pull) = (
            fit_multilinear(&x, &y, BY_CRITERION).unwrap(),
            fit_multilinear(&turned(&x), &turned(&y), BY_CRITERION).unwrap(),
        );
        assert_eq!(push.stiffnesses, pull.stiffnesses);
        assert_eq!(
            (pull.breaks[0].0, pull.forces[1].0, pull.intercept.0),
            (-push.breaks[0].0, -push.forces[1].0, -push.intercept.0)
        );
        assert_eq!(pull.force(-0.013), -push.force(0.013));
        let (corners, same) = (push.corners(0.025).unwrap(), pull.corners(-0.025).unwrap());
        assert_eq!(corners, same);
        // Without the offset of the cell: 4120 N, 708 N more, 176 N more.
        for (corner, force) in corners.iter().zip([4120.0, 4828.0, 5004.0]) {
            assert!((corner[1] - force).abs() < 1e-4, "{corner:?}");
        }
    }

    #[test]
    fn an_elastic_ramp_has_no_break_and_a_toe_is_no_knee() {
        let x: Vec<f64> = (1..=30).map(|step| f64::from(step) * 1e-3).collect();
        let straight: Vec<f64> = x.iter().map(|x| 3e5 * x - 7.0).collect();
        let fit = fit_multilinear(&x, &straight, BY_CRITERION).unwrap();
        assert!(fit.breaks.is_empty() && fit.knee().is_none() && fit.doubtful().is_empty());
        assert!(
            (fit.stiffnesses[0].0 / 3e5 - 1.0).abs() < 1e-12
                && (fit.hardening.0 - 1.0).abs() < 1e-12
        );
        assert_eq!(fit.criterion.len(), 5);
        let toe: Vec<f64> = x
            .iter()
            .map(|x| 1e5 * x.min(0.0055) + 3e5 * (x - 0.0055).max(0.0))
            .collect();
        let fit = fit_multilinear(&x, &toe, BY_CRITERION).unwrap();
        assert!(
            (fit.breaks[0].0 - 0.0055).abs() < 1e-10
                && fit.knee().is_none()
                && fit.corners(0.03).is_none()
        );
    }

    #[test]
    fn what_the_points_do_not_bear_is_not_found() {
        let x: Vec<f64> = (0..8).map(f64::from).collect();
        assert_eq!(
            fit_multilinear(&x, &x, BreakCount::Exactly(2)),
            None,
            "three stretches of three points"
        );
        assert_eq!(fit_multilinear(&x[..2], &x[..2], BY_CRITERION), None);
        assert_eq!(fit_multilinear(&[0.0; 8], &x, BY_CRITERION), None);
        assert_eq!(fit_multilinear(&x, &[f64::NAN; 8], BY_CRITERION), None);
    }

    type Read = fn(&MultilinearFit) -> (f64, f64);

    /// The spread of 400 fits, of two breaks by the plan, is the standard error that each of them states, and twice that error
    /// holds the truth in 95 of a hundred.
    #[test]
    fn its_standard_errors_are_the_spread_of_many_fits() {
        let mut state = 5;
        let mut noise = || 15.0 * normal(&mut state);
        let fits: Vec<MultilinearFit> = (0..400)
            .map(|_| {
                let (x, y) = ramp(&mut noise);
                fit_multilinear(&x, &y, BreakCount::Exactly(2)).unwrap()
            })
            .collect();
        let readings: [(Read, f64); 8] = [
            (|fit| fit.stiffnesses[0], 4e5),
            (|fit| fit.stiffnesses[1], 1.2e5),
            (|fit| fit.stiffnesses[2], 2e4),
            (|fit| fit.breaks[0], 0.0103),
            (|fit| fit.breaks[1], 0.0162),
            (|fit| fit.forces[0], curve(0.0103)),
            (|fit| fit.forces[1], curve(0.0162)),
            (|fit| fit.hardening, 0.05),
        ];
        for (index, (read, exact)) in readings.into_iter().enumerate() {
            let values: Vec<(f64, f64)> = fits.iter().map(read).collect();
            let mean = values.iter().map(|(value, _)| value).sum::<f64>() / 400.0;
            let spread = (values
                .iter()
                .map(|(value, _)| (value - mean).powi(2))
                .sum::<f64>()
                / 399.0)
                .sqrt();
            let stated =
                (values.iter().map(|(_, error)| error.powi(2)).sum::<f64>() / 400.0).sqrt();
            // 400 fits tell a spread to 3.5 %.
            assert!(
                (spread / stated - 1.0).abs() < 0.12,
                "{index}: {spread} is stated as {stated}"
            );
            assert!(
                (mean - exact).abs() < 4.0 * spread / 20.0,
                "{index}: {mean} is not {exact}"
            );
            let held = values
                .iter()
                .filter(|(value, error)| (value - exact).abs() < 2.0 * error)
                .count();
            // 382 by the normal law, three binomial deviations 13.
            assert!(
                (366..=397).contains(&held),
                "{index}: twice the error holds the truth {held} times of 400"
            );
        }
    }

    /// The squares of the shares of a number add up to that of its standard error, and two numbers are correlated as 400 fits are:
    /// the first stiffness and the first break, whose force is hardly one of either.
    #[test]
    fn its_shares_are_its_errors_and_know_what_follows_from_what() {
        let mut state = 7;
        let mut noise = || 15.0 * normal(&mut state);
        let mut fit = || {
            let (x, y) = ramp(&mut noise);
            fit_multilinear(&x, &y, BreakCount::Exactly(2)).unwrap()
        };
        let one = fit();
        let shares = &one.shares;
        let size = |share: &[f64]| share.iter().map(|part| part * part).sum::<f64>().sqrt();
        let lists = [
            (&one.stiffnesses, &shares.stiffnesses),
            (&one.breaks, &shares.breaks),
            (&one.forces, &shares.forces),
        ];
        let listed = lists
            .into_iter()
            .flat_map(|(numbers, shares)| numbers.iter().zip(shares));
        for ((value, error), share) in listed.chain([
            (&one.intercept, &shares.intercept),
            (&one.hardening, &shares.hardening),
        ]) {
            assert!(
                (size(share) / error - 1.0).abs() < 1e-6,
                "{value} ± {error}: {share:?}"
            );
        }
        assert!(
            shares.stiffnesses[0][1..]
                .iter()
                .all(|part| part.abs() < 1e-9 * one.stiffnesses[0].1),
            "K₁ is its own"
        );
        let together = |a: &[f64], b: &[f64]| {
            a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / (size(a) * size(b))
        };
        let fits: Vec<MultilinearFit> = (0..400).map(|_| fit()).collect();
        let pairs: [(Read, Read, f64); 4] = [
            (
                |fit| fit.stiffnesses[0],
                |fit| fit.breaks[0],
                together(&shares.stiffnesses[0], &shares.breaks[0]),
            ),
            (
                |fit| fit.stiffnesses[0],
                |fit| fit.intercept,
                together(&shares.stiffnesses[0], &shares.intercept),
            ),
            (
                |fit| fit.breaks[0],
                |fit| fit.forces[0],
                together(&shares.breaks[0], &shares.forces[0]),
            ),
            (
                |fit| fit.stiffnesses[1],
                |fit| fit.breaks[1],
                together(&shares.stiffnesses[1], &shares.breaks[1]),
            ),
        ];
        for (index, (first, second, stated)) in pairs.into_iter().enumerate() {
            let mean = |read: Read| fits.iter().map(|fit| read(fit).0).sum::<f64>() / 400.0;
            let product = |a: Read, b: Read| {
                let (of_a, of_b) = (mean(a), mean(b));
                fits.iter()
                    .map(|fit| (a(fit).0 - of_a) * (b(fit).0 - of_b))
                    .sum::<f64>()
            };
            let found =
                product(first, second) / (product(first, first) * product(second, second)).sqrt();
            // A correlation of 400 pairs is known to (1 − r²)/√400; three of them, and what one fit is off the mean of all.
            assert!(
                (found - stated).abs() < 3.0 / 20.0 * (1.0 - stated * stated) + 0.02,
                "pair {index}: {found}, stated {stated}"
            );
        }
    }

    /// Of noisy ramps the criterion finds the number of breaks in most: a straight one has rarely more than none.
    #[test]
    fn the_criterion_seldom_finds_a_break_that_is_none() {
        let mut state = 9;
        let (mut straight, mut two) = (0, 0);
        for _ in 0..100 {
            let mut noise = || 15.0 * normal(&mut state);
            let (x, y) = ramp(&mut noise);
            two += usize::from(fit_multilinear(&x, &y, BY_CRITERION).unwrap().breaks.len() == 2);
            let y: Vec<f64> = x.iter().map(|x| 4e5 * x + noise()).collect();
            straight += usize::from(
                fit_multilinear(&x, &y, BY_CRITERION)
                    .unwrap()
                    .breaks
                    .is_empty(),
            );
        }
        assert!(
            straight >= 85 && two >= 85,
            "{straight} straight, {two} of two breaks"
        );
    }
}
