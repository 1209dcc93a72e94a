//! The points of a curve, gathered one by one. A short curve is kept as it is. Of a long one only what a picture can show is
//! kept: of each stretch of points the first, the last, and those farthest left, right, down and up, in their order; so that a
//! run of ten million steps takes no more room in a figure than one of some hundred thousand. In: points in SI, in order. Out:
//! points. It knows no picture: stretches are far finer than its columns.

use std::ops::Deref;

/// A curve of so many points is kept whole.
const WHOLE: usize = 100_000;
/// Stretches of a longer one: more than ten for each column of pixels, less than twenty.
const STRETCHES: usize = 20_000;

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
        let mut gathering = Gathering::default();
        points.into_iter().for_each(|point| gathering.push(point));
        gathering.points()
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

/// A curve that is still gathered.
#[derive(Debug, Default)]
pub(crate) struct Gathering {
    whole: Vec<(f64, f64)>,
    stretches: Vec<Stretch>,
    /// Points of a stretch that is full.
    long: usize,
    /// Points so far.
    count: usize,
}

impl Gathering {
    pub fn push(&mut self, point: (f64, f64)) {
        if self.stretches.is_empty() && self.whole.len() < WHOLE {
            self.whole.push(point);
            return;
        }
        if self.stretches.is_empty() {
            self.long = WHOLE.div_ceil(STRETCHES);
            for point in std::mem::take(&mut self.whole) {
                self.gather(point);
            }
        }
        self.gather(point);
    }

    pub fn points(self) -> Points {
        if self.stretches.is_empty() {
            return Points(self.whole);
        }
        Points(self.stretches.iter().flat_map(Stretch::seen).collect())
    }

    /// What is no number is not drawn.
    fn gather(&mut self, (x, y): (f64, f64)) {
        if !x.is_finite() || !y.is_finite() {
            return;
        }
        let one = Stretch {
            count: 1,
            places: [Place {
                at: self.count,
                x,
                y,
            }; 6],
        };
        self.count += 1;
        if let Some(last) = self
            .stretches
            .last_mut()
            .filter(|last| last.count < self.long)
        {
            *last = last.and(&one);
            return;
        }
        if self.stretches.len() == 2 * STRETCHES {
            self.stretches = self.stretches.chunks(2).map(Stretch::together).collect();
            self.long *= 2;
        }
        self.stretches.push(one);
    }
}

/// A point and its number.
#[derive(Clone, Copy, Debug)]
struct Place {
    at: usize,
    x: f64,
    y: f64,
}

/// Points after each other: of them the first, the last, and those farthest left, right, down and up.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    count: usize,
    places: [Place; 6],
}

impl Stretch {
    /// This one and the next.
    fn and(&self, next: &Self) -> Self {
        let [first, _, left, right, low, high] = self.places;
        let [_, last, next_left, next_right, next_low, next_high] = next.places;
        let places = [
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
            places,
        }
    }

    fn together(pair: &[Self]) -> Self {
        pair[1..].iter().fold(pair[0], |one, next| one.and(next))
    }

    /// What of it is seen, in order.
    fn seen(&self) -> Vec<(f64, f64)> {
        let mut places = self.places;
        places.sort_unstable_by_key(|place| place.at);
        let mut seen: Vec<Place> = Vec::with_capacity(places.len());
        for place in places {
            if seen.last().is_none_or(|last| last.at < place.at) {
                seen.push(place);
            }
        }
        seen.into_iter().map(|place| (place.x, place.y)).collect()
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
    fn a_short_curve_is_kept_as_it_is() {
        let points: Vec<(f64, f64)> = (0..100_000)
            .map(|step| (f64::from(step), f64::NAN))
            .collect();
        let gathered: Points = points.iter().copied().collect();
        assert_eq!(
            (gathered.len(), gathered.last().unwrap().0),
            (100_000, 99_999.0)
        );
        assert!(
            gathered
                .iter()
                .zip(&points)
                .all(|(kept, point)| kept.0 == point.0 && kept.1.is_nan())
        );
    }

    /// However long it is: its ends, its peaks and its order stay, and it takes the room of a curve of 240,000 points at most.
    #[test]
    fn a_long_curve_keeps_its_ends_and_peaks_in_order_and_takes_no_more_room() {
        for count in [100_001, 250_000, 1_000_001] {
            let gathered: Points = (0..count).map(swing).collect();
            assert!(
                gathered.len() <= 6 * 2 * STRETCHES && gathered.len() > STRETCHES,
                "{count}: {}",
                gathered.len()
            );
            assert_eq!(
                (gathered[0], *gathered.last().unwrap()),
                (swing(0), swing(count - 1))
            );
            assert!(gathered.contains(&swing(61_234)));
            assert!(gathered.windows(2).all(|pair| pair[0].0 < pair[1].0));
            // Whatever is highest in a column of pixels is kept in it, or at most a stretch away: a tenth of the column.
            let (wide, stretch) = (
                count.div_ceil(1244),
                count.div_ceil(u32::try_from(STRETCHES).unwrap()).max(5),
            );
            for from in (0..count).step_by(usize::try_from(wide).unwrap()) {
                let to = (from + wide).min(count) - 1;
                let highest = (from..=to)
                    .map(|step| swing(step).1)
                    .fold(f64::MIN, f64::max);
                let (near, far) = (swing(from.saturating_sub(stretch)).0, swing(to + stretch).0);
                let kept = &gathered[gathered.partition_point(|point| point.0 < near)..];
                let kept = kept
                    .iter()
                    .take_while(|point| point.0 <= far)
                    .map(|point| point.1)
                    .fold(f64::MIN, f64::max);
                assert!(kept >= highest, "{count}: {highest} and {kept}");
            }
        }
    }

    /// A path that comes back on itself keeps its farthest points to all sides.
    #[test]
    fn a_loop_keeps_its_corners() {
        let corners = [
            (0.0, 0.0),
            (-2.0, 0.5),
            (3.0, -0.5),
            (0.1, -7.0),
            (0.2, 8.0),
            (1.0, 1.0),
        ];
        let gathered: Points = corners.iter().copied().cycle().take(600_000).collect();
        assert!(corners[1..5].iter().all(|corner| gathered.contains(corner)));
        assert_eq!(
            (gathered[0], *gathered.last().unwrap()),
            (corners[0], corners[5])
        );
    }
}
