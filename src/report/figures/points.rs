//! The points of a curve, collected one by one. A short curve is kept in full. A long curve keeps the visible points: for each segment
//! the first and the last point and the extreme points to the left, right, top and bottom, in their order. A run of ten million steps
//! needs no more memory in a figure than one of several hundred thousand. In: points in SI, in order. Out: points. Segments are far finer
//! than the pixel columns of an image.

use std::ops::Deref;

/// A curve of up to this many points is kept in full.
const WHOLE: usize = 100_000;
/// Segments of a longer curve: between ten and twenty per column of pixels.
const SEGMENTS: usize = 20_000;

/// Points in order, SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Points(Vec<(f64, f64)>);

impl Deref for Points {
    type Target = [(f64, f64)];

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<'a> IntoIterator for &'a Points {
    type Item = &'a (f64, f64);
    type IntoIter = std::slice::Iter<'a, (f64, f64)>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

impl FromIterator<(f64, f64)> for Points {
    fn from_iter<I: IntoIterator<Item = (f64, f64)>>(points: I) -> Self {
        let mut collector = PointCollector::default();
        points.into_iter().for_each(|point| collector.push(point));
        collector.points()
    }
}

impl From<Vec<(f64, f64)>> for Points {
    fn from(points: Vec<(f64, f64)>) -> Self {
        if points.len() <= WHOLE {
            Self(points)
        } else {
            points.into_iter().collect()
        }
    }
}

/// Collects the points of a curve.
#[derive(Debug, Default)]
pub(crate) struct PointCollector {
    whole: Vec<(f64, f64)>,
    segments: Vec<Segment>,
    /// Points of a full segment.
    capacity: usize,
    /// Number of points so far.
    count: usize,
}

impl PointCollector {
    pub fn push(&mut self, point: (f64, f64)) {
        if self.segments.is_empty() && self.whole.len() < WHOLE {
            self.whole.push(point);
            return;
        }
        if self.segments.is_empty() {
            self.capacity = WHOLE.div_ceil(SEGMENTS);
            for point in std::mem::take(&mut self.whole) {
                self.add(point);
            }
        }
        self.add(point);
    }

    pub fn points(self) -> Points {
        if self.segments.is_empty() {
            return Points(self.whole);
        }
        Points(self.segments.iter().flat_map(Segment::kept).collect())
    }

    /// Adds a point to the segments; a point that is not finite is not drawn.
    fn add(&mut self, point: (f64, f64)) {
        let (x, y) = point;
        if !x.is_finite() || !y.is_finite() {
            return;
        }
        let point = Numbered {
            number: self.count,
            x,
            y,
        };
        self.count += 1;
        if let Some(last) = self
            .segments
            .last_mut()
            .filter(|last| last.count < self.capacity)
        {
            last.add(point);
            return;
        }
        if self.segments.len() == 2 * SEGMENTS {
            self.segments = self.segments.chunks(2).map(Segment::merged).collect();
            self.capacity *= 2;
        }
        self.segments.push(Segment {
            count: 1,
            extremes: [point; 6],
        });
    }
}

/// A point and its number in the curve.
#[derive(Clone, Copy, Debug)]
struct Numbered {
    number: usize,
    x: f64,
    y: f64,
}

/// Consecutive points, reduced to the first, the last, and the extreme points to the left, right, top and bottom.
#[derive(Clone, Copy, Debug)]
struct Segment {
    count: usize,
    extremes: [Numbered; 6],
}

impl Segment {
    /// Adds the next point.
    fn add(&mut self, point: Numbered) {
        let [_, last, left, right, low, high] = &mut self.extremes;
        self.count += 1;
        *last = point;
        let beyond = [
            (point.x < left.x, left),
            (point.x > right.x, right),
            (point.y < low.y, low),
            (point.y > high.y, high),
        ];
        for (is_beyond, extreme) in beyond {
            if is_beyond {
                *extreme = point;
            }
        }
    }

    /// This segment joined with the next.
    fn joined(&self, next: &Self) -> Self {
        let [first, _, left, right, low, high] = self.extremes;
        let [_, last, next_left, next_right, next_low, next_high] = next.extremes;
        let extremes = [
            first,
            last,
            if next_left.x < left.x {
                next_left
            } else {
                left
            },
            if next_right.x > right.x {
                next_right
            } else {
                right
            },
            if next_low.y < low.y { next_low } else { low },
            if next_high.y > high.y {
                next_high
            } else {
                high
            },
        ];
        Self {
            count: self.count + next.count,
            extremes,
        }
    }

    /// A pair of segments, or the last one alone, as one.
    fn merged(pair: &[Self]) -> Self {
        pair[1..].iter().fold(pair[0], |one, next| one.joined(next))
    }

    /// The kept points, in order and without repetition.
    fn kept(&self) -> Vec<(f64, f64)> {
        let mut extremes = self.extremes;
        extremes.sort_unstable_by_key(|point| point.number);
        let mut kept: Vec<Numbered> = Vec::with_capacity(extremes.len());
        for point in extremes {
            if kept.last().is_none_or(|last| last.number < point.number) {
                kept.push(point);
            }
        }
        kept.into_iter().map(|point| (point.x, point.y)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn swing(step: u32) -> (f64, f64) {
        let time = f64::from(step) * 1e-4;
        (
            time,
            if step == 61_234 {
                9.0
            } else {
                (37.0 * time).sin()
            },
        )
    }

    #[test]
    fn a_short_curve_is_kept_in_full() {
        let points: Vec<(f64, f64)> = (0..100_000)
            .map(|step| (f64::from(step), f64::NAN))
            .collect();
        let collected: Points = points.iter().copied().collect();
        assert_eq!(
            (collected.len(), collected.last().unwrap().0),
            (100_000, 99_999.0)
        );
        assert!(
            collected
                .iter()
                .zip(&points)
                .all(|(kept, point)| kept.0 == point.0 && kept.1.is_nan())
        );
    }

    /// A long curve keeps its ends, its peaks and its order, and at most 240,000 points.
    #[test]
    fn a_long_curve_keeps_its_ends_and_peaks_in_order() {
        for count in [100_001, 250_000, 1_000_001] {
            let collected: Points = (0..count).map(swing).collect();
            assert!(
                collected.len() <= 6 * 2 * SEGMENTS && collected.len() > SEGMENTS,
                "{count}: {}",
                collected.len()
            );
            assert_eq!(
                (collected[0], *collected.last().unwrap()),
                (swing(0), swing(count - 1))
            );
            assert!(collected.contains(&swing(61_234)));
            assert!(collected.windows(2).all(|pair| pair[0].0 < pair[1].0));
            // The highest point of a pixel column is kept in it, or at most one segment away, a tenth of the column.
            let (width, segment) = (
                count.div_ceil(1244),
                count.div_ceil(u32::try_from(SEGMENTS).unwrap()).max(5),
            );
            for from in (0..count).step_by(usize::try_from(width).unwrap()) {
                let to = (from + width).min(count) - 1;
                let highest = (from..=to)
                    .map(|step| swing(step).1)
                    .fold(f64::MIN, f64::max);
                let (near, far) = (swing(from.saturating_sub(segment)).0, swing(to + segment).0);
                let kept = &collected[collected.partition_point(|point| point.0 < near)..];
                let kept = kept
                    .iter()
                    .take_while(|point| point.0 <= far)
                    .map(|point| point.1)
                    .fold(f64::MIN, f64::max);
                assert!(kept >= highest, "{count}: {highest} and {kept}");
            }
        }
    }

    /// A closed path keeps its extreme points.
    #[test]
    fn a_loop_keeps_its_extreme_points() {
        let corners = [
            (0.0, 0.0),
            (-2.0, 0.5),
            (3.0, -0.5),
            (0.1, -7.0),
            (0.2, 8.0),
            (1.0, 1.0),
        ];
        let collected: Points = corners.iter().copied().cycle().take(600_000).collect();
        assert!(
            corners[1..5]
                .iter()
                .all(|corner| collected.contains(corner))
        );
        assert_eq!(
            (collected[0], *collected.last().unwrap()),
            (corners[0], corners[5])
        );
    }
}
