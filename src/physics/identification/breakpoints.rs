//! Where a line of straight stretches breaks: the places that leave the least squares. In: points in order of x, and a number
//! of breaks. Out: the places. It knows no forces, no errors and no criterion.
//!
//! The start is the best division into separate lines, found exactly by dynamic programming; from there, and
//! from the best breaks of one fewer with one more added, Gauss and Newton go to where the stretches meet, every step halved
//! until it leaves less (Muggeo, Statistics in Medicine 22 (2003) 3055–3071). The better end is taken.

use nalgebra::{DMatrix, DVector};

/// Points that a stretch holds, at least: two bear a line, the third says how well.
pub const FEWEST: usize = 3;
/// Places tried for a break at the start, at most; from there it goes anywhere.
const MOST_PLACES: usize = 200;
/// Steps of one descent, at most.
const MOST_STEPS: usize = 60;
/// A step is halved so often, at most.
const MOST_HALVINGS: usize = 12;

/// A line of stretches that meet at `breaks`, and the sum of squares it leaves.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyline {
    pub breaks: Vec<f64>,
    /// y of the first stretch, drawn on to x = 0; then the slope of each.
    pub coefficients: Vec<f64>,
    pub squares: f64,
}

/// What x adds to each coefficient: 1, then its way along each stretch.
pub fn row(x: f64, breaks: &[f64]) -> impl Iterator<Item = f64> {
    let along = move |stretch: usize| {
        let low = stretch.checked_sub(1).map_or(0.0, |before| breaks[before]);
        let end = breaks.get(stretch).map_or(x, |high| x.min(*high));
        if stretch == 0 {
            end
        } else {
            (end - low).max(0.0)
        }
    };
    std::iter::once(1.0).chain((0..=breaks.len()).map(along))
}

/// The best line with these breaks; None where they leave a stretch too few points.
#[must_use]
pub fn with_breaks(points: &[(f64, f64)], breaks: &[f64]) -> Option<Polyline> {
    let coefficients = least_squares(points, |x| row(x, breaks), breaks.len() + 2)
        .filter(|_| holds_enough(points, breaks))?;
    let left = |(x, y): &(f64, f64)| {
        y - row(*x, breaks)
            .zip(coefficients.iter())
            .map(|(part, by)| part * by)
            .sum::<f64>()
    };
    let squares = points.iter().map(|point| left(point).powi(2)).sum();
    Some(Polyline {
        breaks: breaks.to_vec(),
        coefficients: coefficients.as_slice().to_vec(),
        squares,
    })
}

/// The best lines with 0, 1, … up to `most` breaks, as far as the points bear them. x must rise.
#[must_use]
pub fn best_lines(points: &[(f64, f64)], most: usize) -> Vec<Polyline> {
    let Some(straight) = with_breaks(points, &[]) else {
        return Vec::new();
    };
    let mut found = vec![straight];
    for divided in divisions(points, most) {
        let fewer = found.last().map_or(&[][..], |line| &line.breaks);
        let starts = [with_breaks(points, &divided), one_more(points, fewer)];
        let ends = starts
            .into_iter()
            .flatten()
            .map(|start| descend(points, start));
        let Some(best) = ends.min_by(|a, b| a.squares.total_cmp(&b.squares)) else {
            break;
        };
        found.push(best);
    }
    found
}

/// Every stretch holds enough points, and the breaks rise.
fn holds_enough(points: &[(f64, f64)], breaks: &[f64]) -> bool {
    let up_to = |place: f64| points.partition_point(|(x, _)| *x <= place);
    let ends = breaks
        .iter()
        .map(|place| up_to(*place))
        .chain(std::iter::once(points.len()));
    let mut before = 0;
    ends.into_iter()
        .all(|end| end >= std::mem::replace(&mut before, end) + FEWEST)
}

/// Coefficients of least squares for rows of `count` numbers.
fn least_squares<R: Iterator<Item = f64>>(
    points: &[(f64, f64)],
    row: impl Fn(f64) -> R,
    count: usize,
) -> Option<DVector<f64>> {
    let (mut normal, mut load) = (vec![0.0; count * count], vec![0.0; count]);
    let mut parts = Vec::with_capacity(count);
    for (x, y) in points {
        parts.clear();
        parts.extend(row(*x));
        for (i, one) in parts.iter().enumerate() {
            load[i] += one * y;
            for (j, other) in parts[..=i].iter().enumerate() {
                normal[i + j * count] += one * other;
            }
        }
    }
    Some(
        DMatrix::from_vec(count, count, normal)
            .cholesky()?
            .solve(&DVector::from_vec(load)),
    )
}

/// Goes from a line to the nearest one that leaves the least.
fn descend(points: &[(f64, f64)], start: Polyline) -> Polyline {
    let mut best = start;
    for _ in 0..MOST_STEPS {
        let Some(aim) = linearised(points, &best.breaks) else {
            break;
        };
        let mut share = 1.0;
        let better = (0..MOST_HALVINGS).find_map(|_| {
            let places: Vec<f64> = best
                .breaks
                .iter()
                .zip(&aim)
                .map(|(from, to)| from + share * (to - from))
                .collect();
            share *= 0.5;
            with_breaks(points, &places).filter(|line| line.squares < best.squares)
        });
        let Some(better) = better else { break };
        let gained = best.squares - better.squares;
        let done = gained <= 1e-13 * best.squares;
        best = better;
        if done {
            break;
        }
    }
    best
}

/// Where the breaks would be if a move of them were a jump there: f + γ·1[x > τ] with a slope that falls by d there is, to
/// first order, a break moved on by γ/d.
fn linearised(points: &[(f64, f64)], breaks: &[f64]) -> Option<Vec<f64>> {
    let count = breaks.len();
    let jumps = |x: f64| {
        breaks
            .iter()
            .map(move |place| if x > *place { 1.0 } else { 0.0 })
    };
    let solved = least_squares(points, |x| row(x, breaks).chain(jumps(x)), 2 * count + 2)?;
    let moved = |index: usize| {
        let fall = solved[index + 1] - solved[index + 2];
        let by = solved[count + 2 + index] / fall;
        if by.is_finite() {
            breaks[index] + by
        } else {
            breaks[index]
        }
    };
    Some((0..count).map(moved).collect())
}

/// The best line with one break more than `breaks`, which stay.
fn one_more(points: &[(f64, f64)], breaks: &[f64]) -> Option<Polyline> {
    let lines = places(points.len()).filter_map(|place| {
        let mut more = breaks.to_vec();
        more.push(0.5 * (points[place - 1].0 + points[place].0));
        more.sort_by(f64::total_cmp);
        with_breaks(points, &more)
    });
    lines.min_by(|a, b| a.squares.total_cmp(&b.squares))
}

/// Numbers of points before a break that are tried.
fn places(count: usize) -> impl Iterator<Item = usize> + Clone {
    (FEWEST..=count.saturating_sub(FEWEST)).step_by(count.div_ceil(MOST_PLACES).max(1))
}

/// The division of the points into 2, 3, … separate lines that leaves the least, each as the places where its lines meet, or
/// the middle between the neighbouring points where they do not meet there.
fn divisions(points: &[(f64, f64)], most: usize) -> Vec<Vec<f64>> {
    let ends: Vec<usize> = places(points.len())
        .chain(std::iter::once(points.len()))
        .collect();
    let sums = Sums::of(points);
    // By number of lines and last point: the least that is left, and the end of the line before.
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
        found.push(meeting(points, &sums, &splits));
    }
    found
}

fn meeting(points: &[(f64, f64)], sums: &Sums, splits: &[usize]) -> Vec<f64> {
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
        let place = (other.0 - one.0) / (one.1 - other.1);
        if place >= low && place < high {
            place
        } else {
            0.5 * (low + high)
        }
    };
    splits.iter().enumerate().map(meet).collect()
}

/// Sums over the first points, so that a line through any of them costs the same.
struct Sums(Vec<[f64; 6]>);

impl Sums {
    fn of(points: &[(f64, f64)]) -> Self {
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
        let mut of = self.0[to];
        of.iter_mut()
            .zip(self.0[from])
            .for_each(|(sum, before)| *sum -= before);
        let [count, x, y, xx, xy, yy] = of;
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

    /// What the best line through the points `from..to` leaves.
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

    /// Its y at x = 0 and its slope.
    fn line(&self, from: usize, to: usize) -> (f64, f64) {
        let [_, x, y, xx, xy, _] = self.moments(from, to);
        (y - xy / xx * x, xy / xx)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::testing::uniform;

    /// Two breaks in thirty noisy points: no pair of places on a grid of 0.05 leaves less than what was found.
    #[test]
    fn no_places_on_a_grid_leave_less() {
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
                let single = with_breaks(&points, &[grid(one)]);
                assert!(
                    single.is_none_or(|line| line.squares >= found[1].squares * (1.0 - 1e-12)),
                    "at {}",
                    grid(one)
                );
                for other in one + 1..55 {
                    let line = with_breaks(&points, &[grid(one), grid(other)]);
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
    fn stretches_hold_three_points_and_more_breaks_than_they_bear_are_not_found() {
        let points: Vec<(f64, f64)> = (0..8).map(|x| (f64::from(x), f64::from(x * x))).collect();
        assert_eq!(
            best_lines(&points, 5).len(),
            2,
            "eight points bear two stretches of three, not three"
        );
        assert!(
            holds_enough(&points, &[2.0])
                && holds_enough(&points, &[2.5])
                && !holds_enough(&points, &[1.9])
        );
        assert!(best_lines(&points[..2], 1).is_empty());
    }
}
