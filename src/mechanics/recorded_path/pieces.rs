//! What a record of force over displacement is made of: branches from turn to turn, and on each the pieces of the curves it
//! goes along. In: the readings. Out: branches and pieces with their tangents. It knows no way but the recorded one.
//!
//! A curve begins where the specimen turns. It is left where the specimen turns again, and gone on with once the place of
//! that turn is passed on the way back: the loop is closed and forgotten (Masing 1926; the return-point memory of Iwan's
//! and Preisach's models). So one branch may have pieces of several curves, and one curve pieces on several branches.

use super::Reading;

/// Loops no thicker than this share of the force they span are none: the way back is the way there.
const THIN: f64 = 1e-3;
/// And those that miss the turn where they would close by more than this share of their height do not close.
const OPEN: f64 = 0.02;
/// Noise of a difference that is taken for one, in standard deviations of a reading.
const NOISE_BOUND: f64 = 3.0;

/// Part of a curve that was gone along at a stretch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// The reading it begins at: that of the turn where its curve begins or had been left.
    pub begin: usize,
    /// Readings after that; the first is past the last where there is none.
    pub first: usize,
    pub last: usize,
    pub branch: usize,
    /// The branch whose turn its curve began with.
    pub curve: usize,
    /// The branch at whose end the curve had been left, of a piece that goes on with one.
    pub rejoins: Option<usize>,
    /// Pieces of the same curve.
    pub before: Option<usize>,
    pub after: Option<usize>,
    /// N/m, at its ends.
    pub start_tangent: f64,
    pub end_tangent: f64,
}

/// From one turn to the next.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branch {
    /// 1 or −1; 0 of a record that goes nowhere.
    pub direction: f64,
    /// The reading of the turn at its end, or the last.
    pub end: usize,
    /// Its pieces, one at least.
    pub first_piece: usize,
    pub last_piece: usize,
    /// It goes back over the curve it came from.
    pub retraces: bool,
    /// It passed the place of an earlier turn elsewhere than through it: no loop was closed.
    pub drifts: bool,
    /// Where the force that its curve began with was gone: place (m) and slope (N/m).
    pub gone: Option<[f64; 2]>,
}

/// Branches, and the pieces of their curves.
pub(super) type Cut = (Vec<Branch>, Vec<Piece>);

/// Cuts a record; `least` (m) is how long a piece must be to tell a tangent, `stiffness` (N/m) what holds where none does. Where
/// loops do not close, each branch is one curve.
pub(super) fn cut(readings: &[Reading], stiffness: f64, force_noise: f64, least: f64, loops_close: bool) -> Cut {
    let mut branches: Vec<Branch> = Vec::new();
    let mut pieces: Vec<Piece> = Vec::new();
    // Branches that ended in a turn whose loop is not closed.
    let mut open: Vec<usize> = Vec::new();
    let mut elastic = stiffness;
    for (begin, end, direction) in stretches(readings) {
        let branch = branches.len();
        if branch > 0 && loops_close {
            open.push(branch - 1);
        }
        let own = Piece {
            begin,
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
        let mut drifts = false;
        pieces.push(own);
        for step in begin + 1..=end {
            let (mut rejoined, mut passed) = (None, false);
            while let [.., left, _] = open[..]
                && (readings[step].target - readings[branches[left].end].target) * direction > 0.0
            {
                let turn = readings[branches[left].end];
                let (near, far) = (readings[step - 1], readings[step]);
                let force = near.force + (turn.target - near.target) / (far.target - near.target) * (far.force - near.force);
                let height = (turn.force - readings[begin].force).abs();
                let unsure = NOISE_BOUND * force_noise + 0.5 * (far.force - near.force).abs();
                let closed = (force - turn.force).abs() <= unsure + OPEN * height;
                rejoined = closed.then_some(left);
                passed |= !closed;
                open.truncate(open.len() - 2);
            }
            drifts |= passed;
            if let Some(left) = rejoined {
                let before = branches[left].last_piece;
                let here = pieces.len();
                pieces[here - 1].last = step - 1;
                pieces[before].after = Some(here);
                let curve = pieces[before].curve;
                let begin = branches[left].end;
                pieces.push(Piece { begin, first: step, curve, rejoins: Some(left), before: Some(before), ..own });
            }
        }
        for index in first_piece..pieces.len() {
            let piece = pieces[index];
            let known = piece.before.map_or(elastic, |before| pieces[before].end_tangent);
            let steps = || std::iter::once(piece.begin).chain(piece.first..=piece.last).map(|step| &readings[step]);
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
            first_piece,
            last_piece: pieces.len() - 1,
            retraces: false,
            drifts,
            gone: gone(readings, &pieces[first_piece]),
        });
    }
    for branch in 1..branches.len() {
        branches[branch].retraces = retraces(readings, &pieces, &branches, branch, NOISE_BOUND * force_noise);
    }
    (branches, pieces)
}

/// Readings at the ends of each stretch without a turn, and its direction.
fn stretches(readings: &[Reading]) -> Vec<(usize, usize, f64)> {
    let mut found = Vec::new();
    let (mut begin, mut direction) = (0, 0.0);
    for step in 1..readings.len() {
        let moved = readings[step].target - readings[step - 1].target;
        if moved * direction < 0.0 {
            found.push((begin, step - 1, direction));
            begin = step - 1;
        }
        if moved != 0.0 {
            direction = moved.signum();
        }
    }
    found.push((begin, readings.len().saturating_sub(1), direction));
    found
}

/// Whether the branch goes back over the curve it turned from, as far as both reach.
fn retraces(readings: &[Reading], pieces: &[Piece], branches: &[Branch], branch: usize, noise: f64) -> bool {
    let own = pieces[branches[branch].first_piece];
    let from = branches[branch - 1].last_piece;
    let turn = readings[own.begin];
    let (mut thickness, mut span) = (0.0_f64, 0.0_f64);
    for reading in readings.iter().take(own.last + 1).skip(own.first) {
        let Some((_, force)) = within(readings, pieces, branches, from, reading.target) else { break };
        thickness = thickness.max((reading.force - force).abs());
        span = span.max((reading.force - turn.force).abs());
    }
    thickness <= noise + THIN * span
}

/// Where the force is none, and how fast it changes there.
fn gone(readings: &[Reading], piece: &Piece) -> Option<[f64; 2]> {
    let begun = readings[piece.begin].force;
    let step = (piece.first..=piece.last).find(|step| readings[*step].force * begun < 0.0)?;
    let near = readings[if step == piece.first { piece.begin } else { step - 1 }];
    let slope = (readings[step].force - near.force) / (readings[step].target - near.target);
    (slope.is_finite() && slope != 0.0).then(|| [near.target - near.force / slope, slope])
}

/// Displacement and force at a place on the curve of a piece, where the record went there before.
pub(super) fn within(readings: &[Reading], pieces: &[Piece], branches: &[Branch], piece: usize, place: f64) -> Option<(f64, f64)> {
    let mut piece = piece;
    while (place - readings[pieces[piece].begin].target) * branches[pieces[piece].branch].direction < 0.0 {
        piece = pieces[piece].before?;
    }
    let Piece { begin, first, last, .. } = pieces[piece];
    let direction = branches[pieces[piece].branch].direction;
    let reached = readings[first..=last].partition_point(|reading| (reading.target - place) * direction < 0.0);
    let far = readings.get(first + reached).filter(|_| first + reached <= last)?;
    let near = readings[if reached == 0 { begin } else { first + reached - 1 }];
    let share = if far.target == near.target { 1.0 } else { (place - near.target) / (far.target - near.target) };
    Some((near.displacement + share * (far.displacement - near.displacement), near.force + share * (far.force - near.force)))
}

/// Slope of the least squares over the fewest readings that span more than `least` (m), two at least; None where all of
/// them do not.
fn tangent<'a>(readings: impl Iterator<Item = &'a Reading>, least: f64) -> Option<f64> {
    let mut taken: Vec<(f64, f64)> = Vec::new();
    for reading in readings {
        taken.push((reading.target, reading.force));
        if (reading.target - taken[0].0).abs() > least && taken.len() > 1 {
            return slope(&taken);
        }
    }
    None
}

/// Of least squares through places (m) and forces (N) there; None of one place.
fn slope(points: &[(f64, f64)]) -> Option<f64> {
    #[expect(clippy::cast_precision_loss, reason = "far fewer readings than 2^53")]
    let count = points.len() as f64;
    let (x, r) = points.iter().fold((0.0, 0.0), |sum, point| (sum.0 + point.0 / count, sum.1 + point.1 / count));
    let (both, own) = points.iter().fold((0.0, 0.0), |(both, own), point| {
        (both + (point.0 - x) * (point.1 - r), own + (point.0 - x) * (point.0 - x))
    });
    (own > 0.0).then(|| both / own)
}

/// Slope of the line on which the specimen flows (N/m): the least that a branch has over the last quarter of its way.
pub(super) fn softest(readings: &[Reading], branches: &[Branch], pieces: &[Piece], least: f64) -> Option<f64> {
    const QUARTER: f64 = 0.25;
    let of_end = |branch: &Branch| {
        let begin = readings[pieces[branch.first_piece].begin].target;
        let end = readings[branch.end].target;
        let late = |reading: &&Reading| (end - reading.target) / (end - begin) <= QUARTER;
        let points = readings[..=branch.end].iter().rev().take_while(late);
        let points: Vec<(f64, f64)> = points.map(|reading| (reading.target, reading.force)).collect();
        let enough = points.len() > 2 && QUARTER * (end - begin).abs() > least;
        enough.then(|| slope(&points)).flatten()
    };
    branches.iter().filter(|branch| !branch.retraces).filter_map(of_end).min_by(f64::total_cmp)
}
