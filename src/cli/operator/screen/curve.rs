//! A curve that is drawn while it grows. In: any number of points. Out: a bounded number of them, evenly thinned, with the newest one. It
//! knows no unit.

use crate::operator::shown::Shown;
use psd::run::StepReport;

/// Largest number of points kept; a terminal has fewer dots.
pub const MOST_POINTS: usize = 1024;

/// A growing curve.
#[derive(Clone, Debug)]
pub struct Curve {
    points: Vec<(f64, f64)>,
    /// One point is kept of every `stride` points.
    stride: u64,
    seen: u64,
    newest: Option<(f64, f64)>,
    /// The bounds of all points, kept or not.
    bounds: Option<Bounds>,
}

/// The smallest and the largest value of each coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub x: [f64; 2],
    pub y: [f64; 2],
}

impl Default for Curve {
    fn default() -> Self {
        Self {
            points: Vec::new(),
            stride: 1,
            seen: 0,
            newest: None,
            bounds: None,
        }
    }
}

/// The two curves of a procedure.
#[derive(Clone, Debug, Default)]
pub struct Curves {
    /// Displacement \[m\] over time \[s\].
    pub displacement: Curve,
    /// Force \[N\] over displacement \[m\].
    pub force: Curve,
}

impl Curves {
    /// Adds the numbers of a step that are shown.
    pub fn push(&mut self, report: &StepReport, shown: &Shown) {
        self.displacement.push(report.time, report.highest());
        self.force
            .push(shown.across(report), shown.force_of(report));
    }
}

impl Bounds {
    /// The bounds of both.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        let both = |one: [f64; 2], other: [f64; 2]| [one[0].min(other[0]), one[1].max(other[1])];
        Self {
            x: both(self.x, other.x),
            y: both(self.y, other.y),
        }
    }
}

impl Curve {
    /// Adds a point; a point that is not a number is ignored.
    pub fn push(&mut self, x: f64, y: f64) {
        if !(x.is_finite() && y.is_finite()) {
            return;
        }
        if self.seen.is_multiple_of(self.stride) {
            if self.points.len() == MOST_POINTS {
                let mut index = 0;
                self.points.retain(|_| {
                    index += 1;
                    index % 2 == 1
                });
                self.stride *= 2;
            }
            if self.seen.is_multiple_of(self.stride) {
                self.points.push((x, y));
            }
        }
        self.seen += 1;
        self.newest = Some((x, y));
        let bounds = self.bounds.get_or_insert(Bounds {
            x: [x, x],
            y: [y, y],
        });
        bounds.x = [bounds.x[0].min(x), bounds.x[1].max(x)];
        bounds.y = [bounds.y[0].min(y), bounds.y[1].max(y)];
    }

    /// The points kept and the newest one.
    pub fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        self.points.iter().copied().chain(self.newest)
    }

    /// None before the first point.
    pub const fn bounds(&self) -> Option<Bounds> {
        self.bounds
    }

    pub const fn newest(&self) -> Option<(f64, f64)> {
        self.newest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_curve_keeps_its_ends_its_extremes_and_an_even_spacing() {
        let mut curve = Curve::default();
        for index in 0..100_000_u32 {
            curve.push(f64::from(index), if index == 777 { 9.0 } else { 0.0 });
        }
        curve.push(f64::NAN, 1.0);
        let points: Vec<_> = curve.points().collect();
        assert!(points.len() <= MOST_POINTS + 1);
        assert_eq!((points[0].0, points[points.len() - 1].0), (0.0, 99_999.0));
        let spacing = points[1].0 - points[0].0;
        assert!(
            points[..points.len() - 1]
                .windows(2)
                .all(|pair| pair[1].0 - pair[0].0 == spacing),
            "even"
        );
        assert_eq!(
            curve.bounds(),
            Some(Bounds {
                x: [0.0, 99_999.0],
                y: [0.0, 9.0]
            }),
            "a peak between kept points counts"
        );
    }
}
