//! Whether a record keeps Masing's rule: a curve that begins at a load reversal is the initial loading curve, twice as large, until it
//! closes its loop (G. Masing, 1926). In: the branches and pieces of a record. Out: whether they agree with each other. A specimen that
//! pinches, degrades or follows the Bouc–Wen equation does not keep the rule. A specimen that was loaded before the record may not
//! either.

use super::Reading;
use super::pieces::{Branch, NOISE_BOUND, Piece};

/// Displacement \[m\] and force \[N\] from the begin of a curve, both positive in its direction.
type Curve = Vec<[f64; 2]>;

/// Compares every curve with the longest one before it. The initial loading counts twice; a record that begins under load begins at a
/// reversal. In continuous motion the reversals lie between two readings: there only linear parts of a specimen keep to its record.
/// `noise` is the standard deviation of one force \[N\].
pub(super) fn is_kept(
    readings: &[Reading],
    branches: &[Branch],
    pieces: &[Piece],
    noise: f64,
    continuous: bool,
) -> bool {
    let off = |reading: &Reading| (reading.target - readings[0].target).abs();
    let strongest = readings
        .iter()
        .fold(0.0, |most: f64, reading| most.max(reading.force.abs()));
    let times = if readings[0].force.abs() > (NOISE_BOUND * noise).max(AGREED * strongest) {
        1.0
    } else {
        2.0
    };
    let mut longest: Curve = curve(readings, branches, pieces, 0, f64::INFINITY)
        .into_iter()
        .map(|[x, r]| [times * x, times * r])
        .collect();
    // Past its peak displacement so far a specimen continues along its initial loading curve.
    let mut largest = 0.0;
    for branch in 1..branches.len() {
        largest = f64::max(largest, off(&branches[branch - 1].reversal));
        if branches[branch].retraces {
            continue;
        }
        let found = curve(readings, branches, pieces, branch, largest);
        let line: Curve = found
            .iter()
            .map(|[x, _]| [*x, pieces[0].start_tangent * x])
            .collect();
        let known = if continuous { &line } else { &longest };
        if !agrees(
            &found,
            known,
            DOUBLED * NOISE_BOUND * noise,
            LEAST * strongest,
        ) {
            return false;
        }
        let length = |curve: &Curve| curve.last().map_or(0.0, |[x, _]| *x);
        if length(&found) > length(&longest) {
            longest = found;
        }
    }
    true
}

/// The curve that begins with a branch, on all its pieces, as long as it closes its loops, and at most to this distance from the first
/// reading \[m\].
fn curve(
    readings: &[Reading],
    branches: &[Branch],
    pieces: &[Piece],
    branch: usize,
    farthest: f64,
) -> Curve {
    let Branch {
        first_piece,
        direction,
        drifts,
        ..
    } = branches[branch];
    let end = drifts.unwrap_or(readings.len());
    let begin = pieces[first_piece].begin;
    let mut points = vec![[0.0; 2]];
    let mut next = Some(first_piece);
    while let Some(piece) = next.map(|piece| pieces[piece]) {
        let on = readings
            .iter()
            .take(end.min(piece.last + 1))
            .skip(piece.first);
        let near = on.take_while(|on| (on.target - readings[0].target).abs() <= farthest);
        points.extend(near.map(|on| {
            [
                direction * (on.target - begin.target),
                direction * (on.force - begin.force),
            ]
        }));
        next = piece.after;
    }
    points
}

/// Noise of a difference to twice a curve, and of the readings that both begin with, over that of a reading.
const DOUBLED: f64 = 3.2;
/// Curves of less height than this fraction of the largest force are not compared.
const LEAST: f64 = 0.05;
/// Curves agree to this fraction of their height.
const AGREED: f64 = 0.005;
/// Yield points between two readings, two for each curve: interpolation cuts each by a quarter of a step at most.
const CUT: f64 = 4.0;

/// Whether a curve agrees with a known one as far as that reaches, by the root mean square; `noise` in N. A curve with less height than
/// `least` \[N\], or than noise, is not compared.
fn agrees(curve: &Curve, known: &Curve, noise: f64, least: f64) -> bool {
    let least = least.max(2.0 * noise);
    let (mut off, mut count, mut height, mut step) = (0.0, 0.0, 0.0_f64, 0.0_f64);
    for pair in curve.windows(2) {
        let ([_, before], [x, r]) = (pair[0], pair[1]);
        let after = known.partition_point(|[position, _]| *position < x);
        let (Some(low), Some(high)) =
            (after.checked_sub(1).map(|low| known[low]), known.get(after))
        else {
            break;
        };
        let share = (x - low[0]) / (high[0] - low[0]);
        off += (r - (low[1] + share * (high[1] - low[1]))).powi(2);
        count += 1.0;
        height = height.max(r.abs());
        step = step.max((r - before).abs()).max((high[1] - low[1]).abs());
    }
    height <= least
        || off <= count * (noise + AGREED * height).powi(2) + CUT * (0.25 * step).powi(2)
}
