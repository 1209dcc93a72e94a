//! Thinning of a curve to the resolution of the image. In: points in reference pixels. Out: fewer points.

use super::super::canvas::Point;

/// Keeps the first, the lowest, the highest and the last of the points in one pixel column: a curve of a million points is
/// drawn as fast as one of a thousand, and looks the same.
pub(super) fn columns(points: &[Point], width: f64) -> Vec<Point> {
    let column = |point: &Point| (point.0 / width).floor();
    let mut kept = Vec::new();
    for run in points.chunk_by(|a, b| column(a) == column(b)) {
        if run.len() <= 4 {
            kept.extend_from_slice(run);
            continue;
        }
        let by_height = |a: &usize, b: &usize| run[*a].1.total_cmp(&run[*b].1);
        let lowest = (0..run.len()).min_by(by_height).unwrap_or(0);
        let highest = (0..run.len()).max_by(by_height).unwrap_or(0);
        let mut chosen = [0, lowest, highest, run.len() - 1];
        chosen.sort_unstable();
        kept.extend(chosen.map(|index| run[index]));
    }
    kept
}

/// Drops points nearer than `least` to the last kept point, except the final point and reversal points of the curve: a short impact or a
/// sharp peak is kept.
pub(super) fn thinned(points: &[Point], least: f64) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::new();
    for (index, point) in points.iter().enumerate() {
        let Some(last) = kept.last() else {
            kept.push(*point);
            continue;
        };
        let far = (point.0 - last.0).hypot(point.1 - last.1) >= least;
        let turns = points.get(index + 1).is_none_or(|next| {
            let before = points[index - 1];
            (point.1 - before.1) * (next.1 - point.1) < 0.0
        }) && point != last;
        if far || turns {
            kept.push(*point);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dense_record_keeps_first_lowest_highest_and_last_of_each_column() {
        let points: Vec<Point> = (0..1000)
            .map(|i| (f64::from(i) * 0.001, f64::from(i * 7 % 101)))
            .collect();
        let kept = columns(&points, 0.5);
        assert_eq!(kept.len(), 8);
        assert!(
            kept.contains(&(0.0, 0.0))
                && kept.iter().any(|point| point.1 == 100.0)
                && kept.last() == points.last()
        );
    }

    #[test]
    fn thinning_keeps_ends_and_reversal_points() {
        let mut points: Vec<Point> = (0..100).map(|i| (f64::from(i) * 0.01, 0.0)).collect();
        points[40].1 = 0.3;
        let kept = thinned(&points, 0.5);
        assert!(kept.len() < 12);
        assert!(
            kept.contains(&(0.4, 0.3))
                && kept.first() == points.first()
                && kept.last() == points.last()
        );
    }
}
