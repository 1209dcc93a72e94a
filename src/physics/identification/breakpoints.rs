//! Search for the breakpoints of a polyline. In: points in order of x, and the largest number of breakpoints. Out: the best line for each
//! number of breakpoints. It knows no forces, no errors and no criterion.
//!
//! One start is the best division into separate lines, found exactly by dynamic programming; the other adds one breakpoint to the best
//! line with one fewer. Gauss–Newton descends from both ([`Polyline::descended`]), and the better result is used.

use super::polyline::{FEWEST, Polyline};

/// Largest number of positions tried for a breakpoint at the start; from there it moves anywhere.
const MAX_POSITIONS: usize = 200;

/// The best lines with 0, 1, … up to `most` breakpoints, as far as the points determine them. x must rise.
#[must_use]
pub fn best_lines(points: &[(f64, f64)], most: usize) -> Vec<Polyline> {
    let Some(straight) = Polyline::with_breakpoints(points, &[]) else {
        return Vec::new();
    };
    let mut found = vec![straight];
    for divided in divisions(points, most) {
        let fewer = found.last().map_or(&[][..], |line| &line.breakpoints);
        let starts = [
            Polyline::with_breakpoints(points, &divided),
            one_more(points, fewer),
        ];
        let ends = starts
            .into_iter()
            .flatten()
            .map(|start| start.descended(points));
        let Some(best) = ends.min_by(|a, b| a.squares.total_cmp(&b.squares)) else {
            break;
        };
        found.push(best);
    }
    found
}

/// The best line with one more breakpoint; the given ones keep their positions.
fn one_more(points: &[(f64, f64)], breakpoints: &[f64]) -> Option<Polyline> {
    let lines = positions(points.len()).filter_map(|split| {
        let mut more = breakpoints.to_vec();
        more.push(0.5 * (points[split - 1].0 + points[split].0));
        more.sort_by(f64::total_cmp);
        Polyline::with_breakpoints(points, &more)
    });
    lines.min_by(|a, b| a.squares.total_cmp(&b.squares))
}

/// Numbers of points before a breakpoint that are tried.
fn positions(count: usize) -> impl Iterator<Item = usize> + Clone {
    (FEWEST..=count.saturating_sub(FEWEST)).step_by(count.div_ceil(MAX_POSITIONS).max(1))
}

/// The division of the points into 2, 3, … separate lines with the least sum of squares. Each is given by the positions at which its
/// lines meet, or by the middle between the neighbouring points if the lines do not meet between them.
fn divisions(points: &[(f64, f64)], most: usize) -> Vec<Vec<f64>> {
    let ends: Vec<usize> = positions(points.len())
        .chain(std::iter::once(points.len()))
        .collect();
    let sums = CumulativeSums::new(points);
    // By number of lines and last point: the least sum of squares, and the end of the line before.
    let mut left: Vec<(f64, usize)> = ends.iter().map(|end| (sums.squares(0, *end), 0)).collect();
    let mut before: Vec<Vec<(f64, usize)>> = Vec::new();
    let mut found = Vec::new();
    for _ in 0..most {
        let next = ends.iter().map(|end| {
            let divided = ends
                .iter()
                .zip(&left)
                .enumerate()
                .filter(|(_, (split, _))| **split + FEWEST <= *end);
            let each = divided.map(|(index, (split, (squares, _)))| {
                (squares + sums.squares(*split, *end), index)
            });
            each.min_by(|a, b| a.0.total_cmp(&b.0))
                .unwrap_or((f64::INFINITY, 0))
        });
        let next: Vec<(f64, usize)> = next.collect();
        before.push(std::mem::replace(&mut left, next));
        if left
            .last()
            .is_none_or(|(squares, _)| *squares == f64::INFINITY)
        {
            break;
        }
        let (mut index, mut splits, mut table) = (ends.len() - 1, Vec::new(), &left);
        for earlier in before.iter().rev() {
            index = table[index].1;
            splits.push(ends[index]);
            table = earlier;
        }
        splits.reverse();
        found.push(intersections(points, &sums, &splits));
    }
    found
}

fn intersections(points: &[(f64, f64)], sums: &CumulativeSums, splits: &[usize]) -> Vec<f64> {
    let ends: Vec<usize> = std::iter::once(0)
        .chain(splits.iter().copied())
        .chain(std::iter::once(points.len()))
        .collect();
    let lines: Vec<(f64, f64)> = ends
        .windows(2)
        .map(|pair| sums.line(pair[0], pair[1]))
        .collect();
    let meet = |(index, split): (usize, &usize)| {
        let (one, other) = (lines[index], lines[index + 1]);
        let (low, high) = (points[split - 1].0, points[*split].0);
        let x = (other.0 - one.0) / (one.1 - other.1);
        if x >= low && x < high {
            x
        } else {
            0.5 * (low + high)
        }
    };
    splits.iter().enumerate().map(meet).collect()
}

/// Sums over the first points, so that a line through any run of points costs the same.
struct CumulativeSums(Vec<[f64; 6]>);

impl CumulativeSums {
    fn new(points: &[(f64, f64)]) -> Self {
        let mut so_far = [0.0; 6];
        let sums = points.iter().map(|(x, y)| {
            for (sum, part) in so_far.iter_mut().zip([1.0, *x, *y, x * x, x * y, y * y]) {
                *sum += part;
            }
            so_far
        });
        Self(std::iter::once([0.0; 6]).chain(sums).collect())
    }

    /// Count, means, and sums of squares and products about them.
    fn moments(&self, from: usize, to: usize) -> [f64; 6] {
        let mut sums = self.0[to];
        sums.iter_mut()
            .zip(self.0[from])
            .for_each(|(sum, before)| *sum -= before);
        let [count, x, y, xx, xy, yy] = sums;
        let (x, y) = (x / count, y / count);
        [
            count,
            x,
            y,
            xx - count * x * x,
            xy - count * x * y,
            yy - count * y * y,
        ]
    }

    /// Sum of squares that the best line through the points `from..to` leaves.
    fn squares(&self, from: usize, to: usize) -> f64 {
        if to < from + FEWEST {
            return f64::INFINITY;
        }
        let [.., xx, xy, yy] = self.moments(from, to);
        if xx > 0.0 {
            (yy - xy * xy / xx).max(0.0)
        } else {
            f64::INFINITY
        }
    }

    /// Intercept and slope of that line.
    fn line(&self, from: usize, to: usize) -> (f64, f64) {
        let [_, x, y, xx, xy, _] = self.moments(from, to);
        (y - xy / xx * x, xy / xx)
    }
}

#[cfg(test)]
mod tests {
    use super::super::polyline::row;
    use super::*;
    use crate::statistics::testing::uniform;

    /// Two breakpoints in thirty noisy points: no pair of positions on a grid of 0.05 leaves less than the pair found.
    #[test]
    fn no_positions_on_a_grid_leave_smaller_squares() {
        let mut state = 11;
        for noise in [0.02, 0.1, 0.3] {
            let points: Vec<(f64, f64)> = (1..=30)
                .map(|step| {
                    let x = f64::from(step) * 0.1;
                    (
                        x,
                        row(x, &[0.9, 2.1])
                            .zip([0.0, 1.0, 0.4, 0.1])
                            .map(|(a, b)| a * b)
                            .sum::<f64>()
                            + noise * (2.0 * uniform(&mut state) - 1.0),
                    )
                })
                .collect();
            let found = best_lines(&points, 2);
            let grid = |index: u32| 0.05 * f64::from(index);
            for one in 6..54 {
                let single = Polyline::with_breakpoints(&points, &[grid(one)]);
                assert!(
                    single.is_none_or(|line| line.squares >= found[1].squares * (1.0 - 1e-12)),
                    "at {}",
                    grid(one)
                );
                for other in one + 1..55 {
                    let line = Polyline::with_breakpoints(&points, &[grid(one), grid(other)]);
                    let least = found[2].squares;
                    let left = line.map_or(f64::INFINITY, |line| line.squares);
                    assert!(
                        left >= least * (1.0 - 1e-12),
                        "{noise}: {left} at {}, {}, not {least}",
                        grid(one),
                        grid(other)
                    );
                }
            }
        }
    }

    #[test]
    fn no_more_breakpoints_than_the_points_determine() {
        let points: Vec<(f64, f64)> = (0..8).map(|x| (f64::from(x), f64::from(x * x))).collect();
        assert_eq!(
            best_lines(&points, 5).len(),
            2,
            "eight points determine two segments of three points, not three"
        );
        assert!(best_lines(&points[..2], 1).is_empty());
    }
}
