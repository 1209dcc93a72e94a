//! A multilinear curve fitted to a ramp or a backbone: straight segments that meet at breakpoints. In: displacements and forces, and the
//! number of breakpoints. Out: the stiffness of every segment and the breakpoints, with standard errors. It knows no rig and no plan.

use nalgebra::{DMatrix, DVector};

use super::StatedVariance;
use super::breakpoints::best_lines;
use super::polyline::{FEWEST, Polyline, row};
use crate::statistics::least_squares::{Covariance, FitSize};

/// Breakpoints of one curve, at most.
pub const MOST_BREAKS: usize = 8;

/// Scatter below this fraction of the largest force is rounding and no reason for another breakpoint.
const ROUNDING: f64 = 1e-9;

/// The number of breakpoints of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BreakCount {
    Exactly(usize),
    /// The number that minimizes Schwarz's criterion (BIC) N ln(S/N) + p ln N, with p = 2n + 2 parameters for n breakpoints.
    ByCriterion {
        most: usize,
    },
}

/// R = `intercept` + K₁·X up to the first breakpoint, and on from there with the next stiffness. Each pair is a value and its
/// standard error.
#[derive(Clone, Debug, PartialEq)]
pub struct MultilinearFit {
    /// +1 or −1: the direction of the ramp.
    pub direction: f64,
    /// Force at zero displacement \[N\].
    pub intercept: (f64, f64),
    /// K of each segment, from the start on \[N/m\].
    pub stiffnesses: Vec<(f64, f64)>,
    /// Displacements at which two segments meet \[m\].
    pub breakpoints: Vec<(f64, f64)>,
    /// Force at each breakpoint \[N\].
    pub forces: Vec<(f64, f64)>,
    /// Post-yield stiffness ratio: the last stiffness over the first.
    pub post_yield_ratio: (f64, f64),
    /// Standard error of the change of stiffness at each breakpoint \[N/m\].
    pub change_errors: Vec<f64>,
    pub shares: CurveShares,
    pub r_squared: f64,
    /// Degrees of freedom of the scatter about the curve: number of points minus number of parameters.
    pub degrees: f64,
    /// Fraction of the standard errors that the scatter shows; the rest is stated.
    pub shown: f64,
    /// BIC for 0, 1, … breakpoints minus its least value; empty if the number was given.
    pub criterion: Vec<f64>,
}

/// Contributions of independent errors to each result, in the unit of the result: of K₁, then of the part of the intercept that is
/// uncorrelated with K₁, then of each further stiffness and of each breakpoint beyond its correlation with all before. Their squares
/// add up to the square of the standard error. Zero for points without scatter.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct CurveShares {
    pub intercept: Vec<f64>,
    pub stiffnesses: Vec<Vec<f64>>,
    pub breakpoints: Vec<Vec<f64>>,
    pub forces: Vec<Vec<f64>>,
    pub post_yield_ratio: Vec<f64>,
}

impl MultilinearFit {
    /// Force of the curve at `displacement` \[m\], in \[N\].
    #[must_use]
    pub fn force(&self, displacement: f64) -> f64 {
        let breakpoints: Vec<f64> = self
            .breakpoints
            .iter()
            .map(|(at, _)| self.direction * at)
            .collect();
        let slopes = std::iter::once(self.direction * self.intercept.0)
            .chain(self.stiffnesses.iter().map(|(slope, _)| *slope));
        self.direction
            * row(self.direction * displacement, &breakpoints)
                .zip(slopes)
                .map(|(part, by)| part * by)
                .sum::<f64>()
    }

    /// Yield point, the first breakpoint at which the curve softens: displacement \[m\] and force \[N\], each with its standard error.
    #[must_use]
    pub fn yield_point(&self) -> Option<[(f64, f64); 2]> {
        let softens = self
            .stiffnesses
            .windows(2)
            .position(|pair| pair[1].0 < pair[0].0)?;
        Some([self.breakpoints[softens], self.forces[softens]])
    }

    /// Indices of the breakpoints whose change of stiffness is less than twice its standard error.
    #[must_use]
    pub fn indistinct_breakpoints(&self) -> Vec<usize> {
        let changes = self
            .stiffnesses
            .windows(2)
            .map(|pair| (pair[0].0 - pair[1].0).abs());
        changes
            .zip(&self.change_errors)
            .enumerate()
            .filter(|(_, (change, error))| *change < 2.0 * **error)
            .map(|(index, _)| index)
            .collect()
    }

    /// Points of the backbone curve from the origin, displacement \[m\] and force \[N\], the last at `reach` \[m\]. None if a segment
    /// does not soften, or where the force falls.
    #[must_use]
    pub fn backbone_points(&self, reach: f64) -> Option<Vec<[f64; 2]>> {
        let softens = self
            .stiffnesses
            .windows(2)
            .all(|pair| pair[1].0 < pair[0].0);
        let rises =
            self.stiffnesses.iter().all(|(slope, _)| *slope >= 0.0) && self.stiffnesses[0].0 > 0.0;
        let ends = self.breakpoints.iter().map(|(at, _)| self.direction * at);
        let last = self.direction * reach;
        let mut end = [0.0, 0.0];
        let points = ends
            .chain(std::iter::once(last))
            .zip(&self.stiffnesses)
            .map(|(x, (slope, _))| {
                end = [x, end[1] + slope * (x - end[0])];
                end
            });
        let points: Vec<[f64; 2]> = points.collect();
        let onward = points.windows(2).all(|pair| pair[0][0] < pair[1][0]) && points[0][0] > 0.0;
        (softens && rises && onward).then_some(points)
    }
}

/// Least squares over segments and breakpoints together. The standard errors are those of the linearised model at the optimum, with
/// the breakpoints among its parameters; they do not include the choice of their number. None if the points do not determine
/// such a curve.
#[must_use]
pub fn fit_multilinear(
    x: &[f64],
    y: &[f64],
    count: BreakCount,
    errors: StatedVariance,
) -> Option<MultilinearFit> {
    let curve = ScaledCurve::new(x, y)?;
    let most = match count {
        BreakCount::Exactly(breakpoints) => breakpoints,
        BreakCount::ByCriterion { most } => most,
    };
    // One reading more than there are parameters, for their scatter.
    let lines: Vec<Polyline> = best_lines(&curve.points, most.min(MOST_BREAKS))
        .into_iter()
        .take_while(|line| curve.points.len() > 2 * line.breakpoints.len() + 2)
        .collect();
    let (line, criterion) = match count {
        BreakCount::Exactly(breakpoints) => (lines.into_iter().nth(breakpoints)?, Vec::new()),
        BreakCount::ByCriterion { .. } => chosen(lines, curve.points.len())?,
    };
    curve.fit(&line, criterion, errors)
}

/// The line of the least criterion, the one with fewer breakpoints of equals, and the criterion of all minus the least.
fn chosen(lines: Vec<Polyline>, count: usize) -> Option<(Polyline, Vec<f64>)> {
    #[expect(clippy::cast_precision_loss, reason = "far fewer points than 2^53")]
    let criterion = |line: &Polyline| {
        let (count, parameters) = (count as f64, 2.0 * line.breakpoints.len() as f64 + 2.0);
        FitSize {
            squares: line.squares.max(count * ROUNDING * ROUNDING),
            count,
            parameters,
        }
        .bic()
    };
    let all: Vec<f64> = lines.iter().map(criterion).collect();
    let least = all.iter().copied().fold(f64::INFINITY, f64::min);
    let index = all.iter().position(|criterion| *criterion == least)?;
    Some((
        lines.into_iter().nth(index)?,
        all.into_iter().map(|criterion| criterion - least).collect(),
    ))
}

/// Readings of a ramp, scaled so that all sums are of the order of 1 and the ramp has positive x.
pub(super) struct ScaledCurve {
    /// Displacement and force over their scales, in order of displacement.
    pub points: Vec<(f64, f64)>,
    /// +1 or −1: the direction of the ramp.
    direction: f64,
    /// Largest displacement \[m\].
    displacement: f64,
    /// Largest force \[N\].
    force: f64,
}

/// Gradient of a result: indices of parameters with the derivative by each.
type Gradient = Vec<(usize, f64)>;

impl ScaledCurve {
    /// None of fewer than [`FEWEST`] readings, of readings that are not finite, or without displacement.
    pub fn new(x: &[f64], y: &[f64]) -> Option<Self> {
        if x.len() != y.len()
            || x.len() < FEWEST
            || !x.iter().chain(y).all(|value| value.is_finite())
        {
            return None;
        }
        let direction = if x.iter().sum::<f64>() < 0.0 {
            -1.0
        } else {
            1.0
        };
        let largest = |values: &[f64]| {
            values
                .iter()
                .fold(0.0, |most: f64, value| most.max(value.abs()))
        };
        let (displacement, force) = (largest(x), largest(y).max(f64::MIN_POSITIVE));
        if displacement == 0.0 {
            return None;
        }
        let mut points: Vec<(f64, f64)> = x
            .iter()
            .zip(y)
            .map(|(x, y)| (direction * x / displacement, direction * y / force))
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Some(Self {
            points,
            direction,
            displacement,
            force,
        })
    }

    /// The fit in SI with its standard errors. The parameters are the intercept, the slopes, then the breakpoints.
    pub fn fit(
        &self,
        line: &Polyline,
        criterion: Vec<f64>,
        errors: StatedVariance,
    ) -> Option<MultilinearFit> {
        let count = line.breakpoints.len();
        let size = 2 * count + 2;
        let slopes = &line.coefficients[1..];
        let mut normal = DMatrix::<f64>::zeros(size, size);
        for (x, _) in &self.points {
            let effects = row(*x, &line.breakpoints).chain(line.by_breakpoints(*x));
            let effects = DVector::from_iterator(size, effects);
            normal += &effects * effects.transpose();
        }
        #[expect(clippy::cast_precision_loss, reason = "far fewer points than 2^53")]
        let degrees = (self.points.len() - size) as f64;
        let stiffness = self.force / self.displacement;
        let (variance, shown) = errors.counted(
            line.squares / degrees * self.force * self.force,
            stiffness * slopes[0],
        );
        let covariance = Covariance::of_normal(&normal, variance / (self.force * self.force))?;
        // K₁ comes before the intercept, so that its error is an independent one.
        let order: Vec<usize> = [1, 0].into_iter().chain(2..size).collect();
        let root = covariance.independent(&order);
        let dense = |gradient: &Gradient| {
            let mut dense = DVector::<f64>::zeros(size);
            for (index, by) in gradient {
                dense[*index] += by;
            }
            dense
        };
        let error = |scale: f64, gradient: &Gradient| scale * covariance.error(&dense(gradient));
        let share = |scale: f64, gradient: &Gradient| -> Vec<f64> {
            let mut dense = dense(gradient);
            dense.swap_rows(0, 1);
            (dense.transpose() * &root)
                .iter()
                .map(|part| scale * part)
                .collect()
        };
        let slope = |segment: usize| vec![(segment + 1, 1.0)];
        let breakpoint = |index: usize| vec![(count + 2 + index, 1.0)];
        let force = |index: usize| force_gradient(line, index);
        let change = |index: usize| vec![(index + 1, 1.0), (index + 2, -1.0)];
        let ratio = slopes[count] / slopes[0];
        let ratio_gradient = vec![(1, -ratio / slopes[0]), (count + 1, 1.0 / slopes[0])];
        let (along, across) = (
            self.direction * self.displacement,
            self.direction * self.force,
        );
        let shares = CurveShares {
            intercept: share(across, &vec![(0, 1.0)]),
            stiffnesses: (0..=count).map(|k| share(stiffness, &slope(k))).collect(),
            breakpoints: (0..count).map(|k| share(along, &breakpoint(k))).collect(),
            forces: (0..count).map(|k| share(across, &force(k))).collect(),
            post_yield_ratio: share(1.0, &ratio_gradient),
        };
        Some(MultilinearFit {
            direction: self.direction,
            intercept: (
                across * line.coefficients[0],
                error(self.force, &vec![(0, 1.0)]),
            ),
            stiffnesses: (0..=count)
                .map(|k| (stiffness * slopes[k], error(stiffness, &slope(k))))
                .collect(),
            breakpoints: (0..count)
                .map(|k| {
                    (
                        along * line.breakpoints[k],
                        error(self.displacement, &breakpoint(k)),
                    )
                })
                .collect(),
            forces: (0..count)
                .map(|k| {
                    (
                        across * line.value(line.breakpoints[k]),
                        error(self.force, &force(k)),
                    )
                })
                .collect(),
            post_yield_ratio: (ratio, error(1.0, &ratio_gradient)),
            change_errors: (0..count).map(|k| error(stiffness, &change(k))).collect(),
            shares,
            r_squared: self.r_squared(line.squares),
            degrees,
            shown,
            criterion,
        })
    }

    /// 1 − S/S₀ for the sum of squares S, with S₀ about the mean.
    fn r_squared(&self, squares: f64) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "far fewer points than 2^53")]
        let mean = self.points.iter().map(|(_, y)| y).sum::<f64>() / self.points.len() as f64;
        let total: f64 = self.points.iter().map(|(_, y)| (y - mean).powi(2)).sum();
        if total > 0.0 {
            1.0 - squares / total
        } else {
            1.0
        }
    }
}

/// ∂R/∂p at a breakpoint: by the coefficients, by the breakpoints before it, and by its own move along the segment that ends there.
fn force_gradient(line: &Polyline, index: usize) -> Gradient {
    let (count, slopes) = (line.breakpoints.len(), &line.coefficients[1..]);
    let by_coefficients = row(line.breakpoints[index], &line.breakpoints).enumerate();
    let by_breakpoints = slopes
        .windows(2)
        .take(index)
        .enumerate()
        .map(|(before, pair)| (count + 2 + before, pair[0] - pair[1]));
    by_coefficients
        .chain(by_breakpoints)
        .chain([(count + 2 + index, slopes[index])])
        .collect()
}
