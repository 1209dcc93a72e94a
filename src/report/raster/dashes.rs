//! The dashes of a line. In: its points and a pattern. Out: the points of each dash. It draws nothing.

use crate::shapes::Point;

/// The dashes of a line along its length; a solid line is one piece.
pub(crate) fn dashes(points: &[Point], pattern: &[f64]) -> Vec<Vec<Point>> {
    let Some(&first) = points.first() else {
        return Vec::new();
    };
    if pattern.is_empty() {
        return vec![points.to_vec()];
    }
    let (mut pieces, mut piece, mut part, mut left) = (Vec::new(), vec![first], 0, pattern[0]);
    for ends in points.windows(2) {
        let (from, to) = (ends[0], ends[1]);
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        let mut walked = 0.0;
        while length - walked > left {
            walked += left;
            let end = (
                from.0 + (to.0 - from.0) * walked / length,
                from.1 + (to.1 - from.1) * walked / length,
            );
            if part % 2 == 0 {
                piece.push(end);
                pieces.push(std::mem::take(&mut piece));
            } else {
                piece = vec![end];
            }
            part = (part + 1) % pattern.len();
            left = pattern[part];
        }
        left -= length - walked;
        if part % 2 == 0 {
            piece.push(to);
        }
    }
    if piece.len() > 1 {
        pieces.push(piece);
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_follow_the_length_of_the_line_round_a_corner() {
        let pieces = dashes(&[(0.0, 0.0), (3.0, 0.0), (3.0, 10.0)], &[4.0, 2.0]);
        assert_eq!(
            pieces,
            [
                vec![(0.0, 0.0), (3.0, 0.0), (3.0, 1.0)],
                vec![(3.0, 3.0), (3.0, 7.0)],
                vec![(3.0, 9.0), (3.0, 10.0)]
            ]
        );
    }
}
