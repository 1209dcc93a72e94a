//! Identification from measured forces: lines, curves of several segments, loops. In: readings.
//! Out: parameters with standard errors. It knows no rig and no plan.

pub mod bilinear_fit;
pub mod breakpoints;
pub mod cyclic;
pub mod damping_strokes;
pub mod loop_sampling;
pub mod multilinear_fit;
#[cfg(test)]
mod multilinear_fit_tests;
pub mod polyline;

use crate::structure::Matrices;

/// Straight line with standard errors: y = intercept + slope·x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineFit {
    pub slope: f64,
    /// Standard error of the slope; at least that from the stated errors of the readings.
    pub slope_error: f64,
    pub intercept: f64,
    /// Standard error of the intercept, likewise.
    pub intercept_error: f64,
    /// Correlation of slope and intercept, −1 to 1: the line rotates about the mean of the points.
    pub correlation: f64,
    pub r_squared: f64,
    /// Degrees of freedom of the scatter about the line: number of points minus two.
    pub degrees: f64,
    /// Fraction of the standard errors that the scatter shows; the rest is stated.
    pub shown: f64,
}

/// The variance of a reading from its stated errors. A fit uses at least this variance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StatedVariance {
    /// Variance of a force \[N²\].
    pub force: f64,
    /// Variance of a displacement \[m²\].
    pub displacement: f64,
    /// Whether the readings do not have these errors yet: the readings of the run will scatter by them.
    pub expected: bool,
}

impl StatedVariance {
    /// Variance of a force about a curve of this slope \[N/m\].
    #[must_use]
    pub fn about(self, slope: f64) -> f64 {
        self.force + slope * slope * self.displacement
    }

    /// The variance \[N²\] for a fit of this slope \[N/m\], whose readings scatter by `scatter` \[N²\], and the fraction of its standard
    /// errors that the scatter shows.
    #[must_use]
    pub fn counted(self, scatter: f64, slope: f64) -> (f64, f64) {
        let stated = self.about(slope);
        if self.expected {
            (scatter + stated, 1.0)
        } else if stated > scatter {
            (stated, (scatter / stated).sqrt())
        } else {
            (scatter, 1.0)
        }
    }
}

impl LineFit {
    /// The same line through points at these x, with errors that are at least the stated ones; `slope` \[N/m\] is that of the force over
    /// the displacement.
    #[must_use]
    pub fn stated(self, x: &[f64], stated: StatedVariance, slope: f64) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "no test has 2^53 readings")]
        let count = x.len() as f64;
        let mean = x.iter().sum::<f64>() / count;
        let squares: f64 = x.iter().map(|x| (x - mean).powi(2)).sum();
        let scatter = self.slope_error * self.slope_error * squares;
        let (variance, shown) = stated.counted(scatter, slope);
        if variance <= scatter || squares <= 0.0 {
            return self;
        }
        Self {
            slope_error: (variance / squares).sqrt(),
            intercept_error: (variance * (1.0 / count + mean * mean / squares)).sqrt(),
            shown,
            ..self
        }
    }
}

/// Least squares with an intercept, about the means so that no digits are lost. None with fewer than three points, with lists of
/// different length, or if x does not vary.
#[must_use]
pub fn fit_line(x: &[f64], y: &[f64]) -> Option<LineFit> {
    if x.len() != y.len() || x.len() < 3 {
        return None;
    }
    #[expect(clippy::cast_precision_loss, reason = "no test has 2^53 readings")]
    let count = x.len() as f64;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / count;
    let (mean_x, mean_y) = (mean(x), mean(y));
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for (x, y) in x.iter().zip(y) {
        let (dx, dy) = (x - mean_x, y - mean_y);
        xx += dx * dx;
        xy += dx * dy;
        yy += dy * dy;
    }
    let largest = x.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    // The mean of many equal values differs from them by its rounding: a slope cannot be fitted to this spread.
    if xx.is_nan() || xx <= count * (8.0 * f64::EPSILON * largest).powi(2) {
        return None;
    }
    let slope = xy / xx;
    let residual: f64 = x
        .iter()
        .zip(y)
        .map(|(x, y)| (y - mean_y - slope * (x - mean_x)).powi(2))
        .sum();
    let variance = residual / (count - 2.0);
    Some(LineFit {
        slope,
        slope_error: (variance / xx).sqrt(),
        intercept: mean_y - slope * mean_x,
        intercept_error: (variance * (1.0 / count + mean_x * mean_x / xx)).sqrt(),
        // Covariance −x̄ s²/Sxx over both errors (JCGM 100:2008, H.3.3).
        correlation: -mean_x / (xx / count + mean_x * mean_x).sqrt(),
        r_squared: if yy > 0.0 { 1.0 - residual / yy } else { 1.0 },
        degrees: count - 2.0,
        shown: 1.0,
    })
}

/// `F_d = c·v + F_c·sign v`: slope c \[N·s/m\] and intercept `F_c` \[N\], fitted as `F_d·sign v` against |v|. Readings at rest contain no
/// information on it and are left out.
#[must_use]
pub fn fit_damping(velocities: &[f64], damping_forces: &[f64]) -> Option<LineFit> {
    if velocities.len() != damping_forces.len() {
        return None;
    }
    let (speeds, forces): (Vec<f64>, Vec<f64>) = velocities
        .iter()
        .zip(damping_forces)
        .filter(|(velocity, _)| **velocity != 0.0)
        .map(|(velocity, force)| (velocity.abs(), force * velocity.signum()))
        .unzip();
    fit_line(&speeds, &forces)
}

/// ∮R dX by the trapezoidal rule, closed from the last point to the first \[J\]: positive if energy was dissipated.
#[must_use]
pub fn loop_energy(displacements: &[f64], forces: &[f64]) -> f64 {
    let count = displacements.len().min(forces.len());
    (0..count)
        .map(|i| {
            let next = (i + 1) % count;
            0.5 * (forces[i] + forces[next]) * (displacements[next] - displacements[i])
        })
        .sum()
}

/// ζ = c / (2√(KM)).
#[must_use]
pub fn damping_ratio(structure: &Matrices<f64>) -> f64 {
    structure.damping / (2.0 * (structure.stiffness * structure.mass).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_velocity_gives_no_line_whatever_its_mean_rounds_to() {
        let velocities: Vec<f64> = (0..51).map(|_| 0.005).collect();
        let forces: Vec<f64> = (0..51)
            .map(|reading| 2.0 + 0.1 * f64::from(reading % 7))
            .collect();
        assert_eq!(fit_damping(&velocities, &forces), None);
        // A spread of a hundred ulps is a spread that was commanded.
        let apart: Vec<f64> = (0..51)
            .map(|reading| 0.005 + f64::from(reading % 2) * 1e-16)
            .collect();
        assert!(fit_line(&apart, &forces).is_some());
    }
}
