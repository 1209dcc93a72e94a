//! A continuous line of straight segments, and the breakpoints that leave the least squares. In: points in order of x, breakpoints to
//! start from. Out: a [`Polyline`]. It knows no forces, no errors and no criterion.
//!
//! The line is y = c₀ + Σ cᵢ₊₁ sᵢ(x), with sᵢ(x) the part of x that lies on segment i. For given breakpoints it is linear; the
//! breakpoints follow by Gauss–Newton (Muggeo, Statistics in Medicine 22 (2003) 3055–3071).

use nalgebra::{DMatrix, DVector};

use crate::statistics::least_squares::{Residuals, linear, minimize};

/// Points on a segment, at least: two determine a line, the third shows its scatter.
pub const FEWEST: usize = 3;

/// A line of segments that meet at `breakpoints`, and the sum of squares that it leaves.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyline {
    pub breakpoints: Vec<f64>,
    /// y of the first segment, extended to x = 0; then the slope of each segment.
    pub coefficients: Vec<f64>,
    pub squares: f64,
}

/// ∂y/∂c at x: 1, then the part of x on each segment.
pub fn row(x: f64, breakpoints: &[f64]) -> impl Iterator<Item = f64> {
    let part = move |segment: usize| {
        let low = segment
            .checked_sub(1)
            .map_or(0.0, |before| breakpoints[before]);
        let end = breakpoints.get(segment).map_or(x, |high| x.min(*high));
        if segment == 0 {
            end
        } else {
            (end - low).max(0.0)
        }
    };
    std::iter::once(1.0).chain((0..=breakpoints.len()).map(part))
}

impl Polyline {
    /// The best line with these breakpoints; None if they leave a segment fewer than [`FEWEST`] points.
    #[must_use]
    pub fn with_breakpoints(points: &[(f64, f64)], breakpoints: &[f64]) -> Option<Self> {
        Self::through(points, breakpoints).filter(|_| holds_enough(points, breakpoints))
    }

    /// The best line with these breakpoints; None if they leave a segment without a slope.
    #[must_use]
    pub fn through(points: &[(f64, f64)], breakpoints: &[f64]) -> Option<Self> {
        let rows = points.iter().map(|(x, y)| (row(*x, breakpoints), *y));
        let coefficients = linear(rows, breakpoints.len() + 2)?;
        let mut line = Self {
            breakpoints: breakpoints.to_vec(),
            coefficients: coefficients.as_slice().to_vec(),
            squares: 0.0,
        };
        line.squares = points
            .iter()
            .map(|(x, y)| (y - line.value(*x)).powi(2))
            .sum();
        Some(line)
    }

    /// The line of the least squares that Gauss–Newton reaches from this one.
    #[must_use]
    pub fn descended(self, points: &[(f64, f64)]) -> Self {
        let start = DVector::from_column_slice(&self.breakpoints);
        minimize(&Breakpoints { points }, start)
            .and_then(|found| Self::with_breakpoints(points, found.as_slice()))
            .unwrap_or(self)
    }

    /// y at x.
    #[must_use]
    pub fn value(&self, x: f64) -> f64 {
        row(x, &self.breakpoints)
            .zip(&self.coefficients)
            .map(|(part, by)| part * by)
            .sum()
    }

    /// ∂y/∂τ at x for each breakpoint τ: a breakpoint moved by δ moves the line beyond it by (c − c')·δ, with the slopes c before it
    /// and c' behind it.
    pub fn by_breakpoints(&self, x: f64) -> impl Iterator<Item = f64> {
        let changes = self
            .breakpoints
            .iter()
            .zip(self.coefficients[1..].windows(2));
        changes.map(
            move |(at, slopes)| {
                if x > *at { slopes[0] - slopes[1] } else { 0.0 }
            },
        )
    }
}

/// The model whose parameters are the breakpoints; its coefficients are the best for each choice of them.
struct Breakpoints<'a> {
    points: &'a [(f64, f64)],
}

impl Residuals for Breakpoints<'_> {
    fn residuals(&self, parameters: &DVector<f64>) -> Option<DVector<f64>> {
        let line = Polyline::with_breakpoints(self.points, parameters.as_slice())?;
        let left = self.points.iter().map(|(x, y)| y - line.value(*x));
        Some(DVector::from_iterator(self.points.len(), left))
    }

    /// −∂y/∂τ, minus the part that the coefficients explain.
    fn jacobian(&self, parameters: &DVector<f64>) -> Option<DMatrix<f64>> {
        let line = Polyline::with_breakpoints(self.points, parameters.as_slice())?;
        let mut jacobian = DMatrix::zeros(self.points.len(), parameters.len());
        for (index, (x, _)) in self.points.iter().enumerate() {
            for (column, by) in line.by_breakpoints(*x).enumerate() {
                jacobian[(index, column)] = -by;
            }
        }
        for mut column in jacobian.column_iter_mut() {
            let changed: Vec<(f64, f64)> = self
                .points
                .iter()
                .zip(column.iter())
                .map(|((x, _), by)| (*x, *by))
                .collect();
            let fitted = Polyline::through(&changed, &line.breakpoints)?;
            for ((x, _), entry) in self.points.iter().zip(column.iter_mut()) {
                *entry -= fitted.value(*x);
            }
        }
        Some(jacobian)
    }
}

/// Every segment holds enough points, and the breakpoints rise.
fn holds_enough(points: &[(f64, f64)], breakpoints: &[f64]) -> bool {
    let up_to = |x: f64| points.partition_point(|point| point.0 <= x);
    let ends = breakpoints.iter().map(|at| up_to(*at));
    let mut before = 0;
    ends.chain(std::iter::once(points.len()))
        .all(|end| end >= std::mem::replace(&mut before, end) + FEWEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_holds_three_points() {
        let points: Vec<(f64, f64)> = (0..8).map(|x| (f64::from(x), f64::from(x * x))).collect();
        assert!(holds_enough(&points, &[2.0]));
        assert!(holds_enough(&points, &[2.5]));
        assert!(!holds_enough(&points, &[1.9]));
    }
}
