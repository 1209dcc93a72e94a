//! A recorded force–displacement path in branches, from reversal to reversal, and on each the pieces of its curves. In: the readings. Out:
//! branches and pieces with their tangents, and whether they keep Masing's rule. It knows only the recorded path.
//!
//! A curve begins at a reversal. It is left at the next reversal, and continued once the position of that reversal is passed again: the
//! loop is closed and erased (Masing's rule; the return-point memory of Iwan's and Preisach's models). One branch may therefore have
//! pieces of several curves, and one curve pieces on several branches.

use super::rate_correction::ContinuousReadings;
use super::{Reading, branches_of};

/// A loop thinner than this fraction of its force range is not a loop: unloading follows the loading branch.
const THIN: f64 = 1e-3;
/// A loop that misses its reversal point by more than this fraction of its height does not close.
const OPEN: f64 = 0.02;
/// Smallest significant difference, in standard deviations of a reading.
pub(super) const NOISE_BOUND: f64 = 3.0;
/// Noise of a difference to twice a curve, and of the readings that both begin with, over that of a reading.
const DOUBLED: f64 = 3.2;
/// Least height that the agreement of a curve is relative to, as a fraction of the largest force.
const LEAST: f64 = 0.05;
/// Curves agree to this fraction of their height.
const AGREED: f64 = 0.005;
/// Yield points between two readings, two for each curve: interpolation cuts each by a quarter of a step at most.
const CUT: f64 = 4.0;

/// Part of a curve that was followed without interruption.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// Its begin: the reversal at which its curve begins or had been left.
    pub begin: Reading,
    /// Indices of its readings; `first` is past `last` where there is none.
    pub first: usize,
    pub last: usize,
    pub branch: usize,
    /// The branch at whose reversal its curve began.
    pub curve: usize,
    /// For a continued curve, the branch at whose end it had been left.
    pub rejoins: Option<usize>,
    /// Pieces of the same curve.
    pub before: Option<usize>,
    pub after: Option<usize>,
    /// Tangent stiffnesses at its ends \[N/m\].
    pub start_tangent: f64,
    pub end_tangent: f64,
}

/// The path from one reversal to the next.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branch {
    /// 1 or −1; 0 for a record without motion.
    pub direction: f64,
    /// The reading before the reversal at its end, or the last.
    pub end: usize,
    /// That reversal, the begin of the next branch: a reading, or a point between two.
    pub reversal: Reading,
    /// Force there by its own curve \[N\].
    pub led_to: f64,
    /// Its pieces, at least one.
    pub first_piece: usize,
    pub last_piece: usize,
    /// Whether it follows the curve of the branch before it.
    pub retraces: bool,
    /// The first reading past the position of an earlier reversal that it missed: no loop was closed.
    pub drifts: Option<usize>,
}

/// The slopes that readings can determine.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slopes {
    /// The slope where no piece determines one \[N/m\].
    pub stiffness: f64,
    /// Standard deviation of a force \[N\].
    pub force_noise: f64,
    /// Length of a piece that determines a tangent \[m\].
    pub least: f64,
}

/// Divides a record into branches and the pieces of their curves. A continuous motion reverses between two readings.
pub(super) fn cut(
    readings: &[Reading],
    slopes: Slopes,
    continuous: Option<&ContinuousReadings>,
) -> (Vec<Branch>, Vec<Piece>) {
    let Slopes {
        stiffness,
        force_noise,
        least,
    } = slopes;
    let mut branches: Vec<Branch> = Vec::new();
    let mut pieces: Vec<Piece> = Vec::new();
    // Branches that ended in a reversal whose loop is not closed.
    let mut open: Vec<usize> = Vec::new();
    let mut elastic = stiffness;
    let found = continuous.map_or_else(
        || monotonic_branches(readings),
        |continuous| branches_of(continuous.velocities()),
    );
    for (begin, end, direction) in found {
        let branch = branches.len();
        let mut reversal = readings[begin];
        if let Some(before) = branch.checked_sub(1) {
            if let Some(position) = continuous.and_then(|continuous| continuous.turned(begin)) {
                let onto = readings[begin + 1];
                let tangent = tangent(readings[begin + 1..=end].iter(), least).unwrap_or(elastic);
                let displacement = onto.displacement + (position - onto.target);
                branches[before].led_to +=
                    pieces[branches[before].last_piece].end_tangent * (position - reversal.target);
                reversal = Reading {
                    target: position,
                    displacement,
                    force: onto.force + tangent * (position - onto.target),
                };
                branches[before].reversal = reversal;
            }
            open.push(before);
        }
        let own = Piece {
            begin: reversal,
            first: begin + 1,
            last: end,
            branch,
            curve: branch,
            rejoins: None,
            before: None,
            after: None,
            start_tangent: elastic,
            end_tangent: elastic,
        };
        let first_piece = pieces.len();
        let mut drifts = None;
        pieces.push(own);
        for step in begin + 1..=end {
            let mut rejoined = None;
            while let [.., left, _] = open[..]
                && (readings[step].target - branches[left].reversal.target) * direction > 0.0
            {
                let (near, far) = (
                    if step == begin + 1 {
                        own.begin
                    } else {
                        readings[step - 1]
                    },
                    readings[step],
                );
                let reversal = branches[left].reversal;
                let force = near.force
                    + (reversal.target - near.target) / (far.target - near.target)
                        * (far.force - near.force);
                let height = (reversal.force - own.begin.force).abs();
                let force_uncertainty =
                    NOISE_BOUND * force_noise + 0.5 * (far.force - near.force).abs();
                let closed = (force - reversal.force).abs() <= force_uncertainty + OPEN * height;
                rejoined = closed.then_some(left);
                drifts = drifts.or((!closed).then_some(step));
                open.truncate(open.len() - 2);
            }
            if let Some(left) = rejoined {
                let before = branches[left].last_piece;
                let here = pieces.len();
                pieces[here - 1].last = step - 1;
                pieces[before].after = Some(here);
                let curve = pieces[before].curve;
                let begin = branches[left].reversal;
                pieces.push(Piece {
                    begin,
                    first: step,
                    curve,
                    rejoins: Some(left),
                    before: Some(before),
                    ..own
                });
            }
        }
        for index in first_piece..pieces.len() {
            let piece = pieces[index];
            let known = piece
                .before
                .map_or(elastic, |before| pieces[before].end_tangent);
            let steps =
                || std::iter::once(&piece.begin).chain(readings[piece.first..=piece.last].iter());
            let start = tangent(steps(), least);
            pieces[index].start_tangent = start.unwrap_or(known);
            pieces[index].end_tangent = tangent(steps().rev(), least).or(start).unwrap_or(known);
        }
        if branch == 0 {
            elastic = pieces[0].start_tangent;
        }
        branches.push(Branch {
            direction,
            end,
            reversal: readings[end],
            led_to: readings[end].force,
            first_piece,
            last_piece: pieces.len() - 1,
            retraces: false,
            drifts,
        });
    }
    for branch in 1..branches.len() {
        branches[branch].retraces = retraces(
            readings,
            &pieces,
            &branches,
            branch,
            NOISE_BOUND * force_noise,
        );
    }
    (branches, pieces)
}

/// Whether the branch follows the curve from which it reversed, as far as both reach.
fn retraces(
    readings: &[Reading],
    pieces: &[Piece],
    branches: &[Branch],
    branch: usize,
    noise: f64,
) -> bool {
    let own = pieces[branches[branch].first_piece];
    let from = branches[branch - 1].last_piece;
    let reversal = own.begin;
    let (mut thickness, mut span) = (0.0_f64, 0.0_f64);
    for reading in readings.iter().take(own.last + 1).skip(own.first) {
        let Some((_, force)) = within(readings, pieces, branches, from, reading.target) else {
            break;
        };
        thickness = thickness.max((reading.force - force).abs());
        span = span.max((reading.force - reversal.force).abs());
    }
    thickness <= noise + THIN * span
}

/// Displacement and force at a position on the curve of a piece that the record passed there before.
fn within(
    readings: &[Reading],
    pieces: &[Piece],
    branches: &[Branch],
    piece: usize,
    position: f64,
) -> Option<(f64, f64)> {
    let mut piece = piece;
    while (position - pieces[piece].begin.target) * branches[pieces[piece].branch].direction < 0.0 {
        piece = pieces[piece].before?;
    }
    let Piece {
        begin,
        first,
        last,
        branch,
        ..
    } = pieces[piece];
    let Branch {
        direction,
        reversal,
        led_to,
        last_piece,
        ..
    } = branches[branch];
    let reached = readings[first..=last]
        .partition_point(|reading| (reading.target - position) * direction < 0.0);
    let far = if first + reached <= last {
        readings[first + reached]
    } else if piece == last_piece && (reversal.target - position) * direction >= 0.0 {
        Reading {
            force: led_to,
            ..reversal
        }
    } else {
        return None;
    };
    let near = if reached == 0 {
        begin
    } else {
        readings[first + reached - 1]
    };
    let share = if far.target == near.target {
        1.0
    } else {
        (position - near.target) / (far.target - near.target)
    };
    Some((
        near.displacement + share * (far.displacement - near.displacement),
        near.force + share * (far.force - near.force),
    ))
}

/// Least-squares slope over the fewest readings that span more than `least` \[m\], at least two; None if all of them span less.
fn tangent<'a>(readings: impl Iterator<Item = &'a Reading>, least: f64) -> Option<f64> {
    let mut selected: Vec<(f64, f64)> = Vec::new();
    for reading in readings {
        selected.push((reading.target, reading.force));
        if (reading.target - selected[0].0).abs() > least && selected.len() > 1 {
            return slope(&selected);
        }
    }
    None
}

/// Least-squares slope of forces \[N\] over positions \[m\]; None for a single position.
fn slope(points: &[(f64, f64)]) -> Option<f64> {
    #[expect(clippy::cast_precision_loss, reason = "far fewer readings than 2^53")]
    let count = points.len() as f64;
    let (x, r) = points.iter().fold((0.0, 0.0), |sum, point| {
        (sum.0 + point.0 / count, sum.1 + point.1 / count)
    });
    let (both, own) = points.iter().fold((0.0, 0.0), |(both, own), point| {
        (
            both + (point.0 - x) * (point.1 - r),
            own + (point.0 - x) * (point.0 - x),
        )
    });
    (own > 0.0).then(|| both / own)
}

/// Readings at the ends of each segment without a reversal, and its direction.
pub(super) fn monotonic_branches(readings: &[Reading]) -> Vec<(usize, usize, f64)> {
    let moved = readings.windows(2).map(|two| two[1].target - two[0].target);
    branches_of(std::iter::once(0.0).chain(moved))
}

/// Displacement \[m\] and force \[N\] from the begin of a curve, both positive in its direction.
type Curve = Vec<[f64; 2]>;

/// Whether a record keeps Masing's rule: a curve that begins at a load reversal is the initial loading curve, twice as large, until it
/// closes its loop (G. Masing, 1926). A specimen that pinches, degrades or follows the Bouc–Wen equation does not keep the rule. A
/// specimen that was loaded before the record may not either.
///
/// Compares every curve with the longest one before it. The initial loading counts twice; a record that begins under load begins at a
/// reversal. In continuous motion the reversals lie between two readings: there only linear parts of a specimen keep to its record.
/// `noise` is the standard deviation of one force \[N\].
pub(super) fn keeps_masing_rule(
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

/// Whether a curve agrees with a known one as far as that reaches, by the root mean square; `noise` in N. It agrees to a fraction of its
/// height, or of `least` \[N\] if that is more. A curve with less height than noise is not compared.
fn agrees(curve: &Curve, known: &Curve, noise: f64, least: f64) -> bool {
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
    height <= 2.0 * noise
        || off <= count * (noise + AGREED * height.max(least)).powi(2) + CUT * (0.25 * step).powi(2)
}
