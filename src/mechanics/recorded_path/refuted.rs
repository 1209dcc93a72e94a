//! Which suppositions about a specimen its own record refutes. In: a record, and the rules that it may keep to. Out: those that
//! are left, the likeliest first. It knows no way but the recorded one.
//!
//! A rule says what becomes of a curve that begins elsewhere. A record that went forth and back more than once has curves that
//! began at several places, and each is foretold by those of the same direction that began nearest to it. What counts is how far
//! off the foretold force is at the end of what both tell, for that is what the next curve begins with; it is measured in how far
//! apart the two began. It is summed up twice: by squares, in which the curves count that are off most, and by square
//! roots, in which all count alike. A specimen that one rule describes is foretold by that to the width of its knees, and by the others
//! to a few tenths; where none is right, all are off alike, and all are left.

use super::again::Again;
use super::pieces::Branch;
use super::{Distortion, RecordedPath, Rule};

/// Curves that each is foretold by, and how many of its direction to either side are looked through for them.
const NEAREST: usize = 3;
const AROUND: usize = 50;
/// Of the largest change of force on a branch: those that change it by less tell no rule.
const LEAST_BRANCH: f64 = 0.05;
/// And two that began so near to each other tell none apart.
const LEAST_APART: f64 = 0.02;
/// Places along a branch at which it is foretold, and the part of those that are told which counts, at its end.
const PLACES: usize = 16;
const END: usize = 4;
/// A rule that is this much farther off than the best is refuted by very many curves; the fewer they are, the farther it must
/// be, by so much over their number.
const WORSE: f64 = 1.5;
const WORSE_OF_FEW: f64 = 20.0;
/// Curves without which nothing says that a specimen is of one element that flows.
const FLOWING_OF: f64 = 8.0;
/// What knees between two readings leave, in how far apart two curves began: of the mean square, and of the mean root.
const EXACT: Off = Off { square: 0.01, root: 0.002 };

/// How far off a rule foretells curves, in how far apart they and those that they are foretold by began.
#[derive(Clone, Copy, Debug)]
struct Off {
    square: f64,
    root: f64,
}

/// The rules that the record does not refute, in their order.
pub(super) fn left(path: &RecordedPath, possible: Vec<Rule>) -> Vec<Rule> {
    if possible.len() < 2 {
        return possible;
    }
    let supposed: Vec<RecordedPath> = possible.iter().map(|rule| path.clone().keeping_to(*rule)).collect();
    let (count, off) = off(path, &supposed);
    if count == 0.0 {
        return possible.into_iter().filter(|rule| *rule != Rule::Flowing).collect();
    }
    // Where each curve keeps its shape, that is so of many elements side by side, and not of one alone.
    let keeps = off[0].square <= EXACT.square && off[0].root <= EXACT.root;
    let held = possible.into_iter().zip(off).filter(|(rule, _)| *rule != Rule::Flowing || !keeps && count >= FLOWING_OF);
    let held: Vec<(Rule, Off)> = held.collect();
    let most = |read: fn(&Off) -> f64| {
        let best = held.iter().map(|(_, off)| read(off)).fold(f64::INFINITY, f64::min);
        (best * (WORSE + WORSE_OF_FEW / count)).max(read(&EXACT))
    };
    let (square, root) = (most(|off| off.square), most(|off| off.root));
    let by_squares: Vec<(Rule, Off)> = held.into_iter().filter(|(_, off)| off.square <= square).collect();
    let by_both: Vec<Rule> = by_squares.iter().filter(|(_, off)| off.root <= root).map(|(rule, _)| *rule).collect();
    if by_both.is_empty() { by_squares.into_iter().map(|(rule, _)| rule).collect() } else { by_both }
}

/// How many pairs of curves there are, and how far off each supposition foretells one by the other, of how far apart they began.
fn off(path: &RecordedPath, supposed: &[RecordedPath]) -> (f64, Vec<Off>) {
    let mut walks: Vec<Again<'_>> = supposed.iter().map(|path| path.again(Distortion::NONE)).collect();
    let begin = |branch: usize| path.pieces[path.branches[branch].first_piece].begin;
    let height = |branch: usize| (path.branches[branch].turn.force - begin(branch).force).abs();
    let all = 1..path.branches.len();
    let highest = all.clone().map(height).fold(0.0, f64::max);
    let tells = |branch: &usize| !path.branches[*branch].retraces && height(*branch) > LEAST_BRANCH * highest;
    let stiffness = path.pieces[0].start_tangent;
    let apart = |one: usize, other: usize| {
        let (one, other) = (begin(one), begin(other));
        (stiffness * (one.target - other.target)).hypot(one.force - other.force)
    };
    let least = (LEAST_APART * highest).max(stiffness * path.least);
    let (mut count, mut begun) = (0.0, 0.0);
    let mut sums = vec![Off { square: 0.0, root: 0.0 }; supposed.len()];
    for direction in [1.0, -1.0] {
        let goes = |branch: &usize| path.branches[*branch].direction == direction;
        let branches: Vec<usize> = all.clone().filter(tells).filter(goes).collect();
        for (place, branch) in branches.iter().enumerate() {
            let around = &branches[place.saturating_sub(AROUND)..branches.len().min(place + AROUND)];
            let mut others: Vec<(f64, usize)> = around.iter().map(|other| (apart(*branch, *other), *other)).collect();
            others.retain(|(apart, _)| *apart > least);
            others.sort_by(|one, other| one.0.total_cmp(&other.0));
            for (apart, other) in others.into_iter().take(NEAREST) {
                let (to, from) = (begin(*branch), begin(other));
                for walk in &mut walks {
                    walk.turn_elsewhere(other, to.target - from.target, to.force - from.force);
                }
                if let Some(found) = at_the_end(path, &path.branches[*branch], &walks) {
                    count += 1.0;
                    begun += apart * apart;
                    for (sum, square) in sums.iter_mut().zip(found) {
                        sum.square += square;
                        sum.root += (square.sqrt() / apart).sqrt();
                    }
                }
            }
        }
    }
    let mean = |sum: Off| Off { square: (sum.square / begun).sqrt(), root: (sum.root / count).powi(2) };
    (count, sums.into_iter().map(mean).collect())
}

/// Mean squares of how far off a branch each way foretells it, N², at the end of what all of them tell; None where they tell nothing.
fn at_the_end(path: &RecordedPath, branch: &Branch, walks: &[Again<'_>]) -> Option<Vec<f64>> {
    let piece = path.pieces[branch.first_piece];
    let readings = path.readings.get(piece.first..=piece.last)?;
    let count = readings.len().min(PLACES);
    let mut told: Vec<Vec<f64>> = Vec::with_capacity(count);
    for place in 1..=count {
        let reading = readings[place * readings.len() / count - 1];
        let foretold: Option<Vec<f64>> = walks.iter().map(|walk| walk.foretold(reading.target)).collect();
        match foretold {
            Some(forces) => told.push(forces.into_iter().map(|force| (force - reading.force).powi(2)).collect()),
            // What began later on the curve than the other did is told from there on.
            None if told.is_empty() => {}
            None => break,
        }
    }
    let end = &told[told.len() - told.len().div_ceil(END)..];
    #[expect(clippy::cast_precision_loss, reason = "a few")]
    let mean = |walk: usize| end.iter().map(|squares| squares[walk]).sum::<f64>() / end.len() as f64;
    (!end.is_empty()).then(|| (0..walks.len()).map(mean).collect())
}
