//! The specimen as a run recorded it: force over displacement along the way it went, so that the run can be taken again
//! with an input moved a little and no model of the specimen. In: targets and what was read at them, in order. Out: what
//! would be read at targets near those, step by step.
//!
//! The record is cut into curves (`pieces`), on which the force is interpolated; beyond what was recorded of one it goes on
//! along the tangent there. The way taken again goes from curve to curve at its own turns (`again`). What a curve does when
//! its beginning has moved, the record does not tell: `Rule` says what is supposed. At the recorded targets the recorded
//! readings come back as they were, to the bit.

mod again;
mod map;
mod pieces;

pub use again::Again;

use self::pieces::{Branch, Piece};
use super::tangent::NOISE_MULTIPLE;

/// One step of the record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Commanded, m.
    pub target: f64,
    /// m
    pub displacement: f64,
    /// N
    pub force: f64,
}

/// What a specimen is supposed to do after it turned elsewhere. Where it goes back over the curve it came from it does so
/// after every turn, and where it passes the place of an earlier turn it goes on with the curve that was left there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// Its curve begins at the turn and keeps its shape: exact of elastic specimens and of elastic–plastic elements side by
    /// side (Iwan 1967), however many. One that passed an earlier turn of the record elsewhere than through it, so that no
    /// loop was closed, keeps the line that it settled on.
    Shifted,
    /// Its curve is stretched about where the one before it began, if it came back softer than it first was: exact of those
    /// that lose stiffness and come back to the origin.
    Pivoted,
    /// As `Shifted`, and loops that did not close in the record keep their shape as well: of specimens that forget a turn
    /// only as they flow on (Bouc and Wen) neither is exact.
    Kept,
}

/// How the way differs from the recorded one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distortion {
    /// Newtons in one newton of the record.
    pub force_scale: f64,
    /// Metres in one metre of the record.
    pub displacement_scale: f64,
    /// Added to every force, N.
    pub zero: f64,
    /// Added to every reading with a sign drawn for each: N and m.
    pub noise: Option<Noise>,
}

impl Distortion {
    pub const NONE: Self = Self { force_scale: 1.0, displacement_scale: 1.0, zero: 0.0, noise: None };
}

/// One draw of the errors of all readings: each has its standard deviation, and the sign that the draw gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// N
    pub force: f64,
    /// m
    pub displacement: f64,
    pub draw: u16,
}

impl Noise {
    /// Errors of force (N) and displacement (m) of the reading at `step` of the axis at this place.
    #[must_use]
    pub fn errors(&self, step: u64, axis: u32) -> [f64; 2] {
        // Two bits an axis; past the last of a word, another word.
        let bits = drawn(self.draw, step ^ u64::from(axis / 32) << 40) >> (2 * (axis % 32));
        let signed = |bit: u64, size: f64| if bits & bit == 0 { size } else { -size };
        [signed(1, self.force), signed(2, self.displacement)]
    }
}

/// A way taken again that leaves the recorded one for more than this share of the largest displacement is not known by it.
pub const UNSEEN: f64 = 1e-3;

/// A way back whose stiffness fell by less than this share of what the stiffness of the whole way there fell by, kept it.
const KEPT: f64 = 0.2;

/// Readings along the way, in branches and curves.
#[derive(Clone, Debug)]
pub struct RecordedPath {
    readings: Vec<Reading>,
    branches: Vec<Branch>,
    pieces: Vec<Piece>,
    /// Places no farther apart tell no difference of force, m.
    least: f64,
    rule: Rule,
}

impl RecordedPath {
    /// `stiffness` (N/m) where no branch tells one; `force_noise` (N) and `resolution` (m) say how long a piece must be to
    /// tell. None of no reading.
    #[must_use]
    pub fn new(readings: Vec<Reading>, stiffness: f64, force_noise: f64, resolution: f64) -> Option<Self> {
        if readings.is_empty() {
            return None;
        }
        let least = resolution.max(NOISE_MULTIPLE * force_noise / stiffness);
        let (branches, pieces) = pieces::cut(&readings, stiffness, force_noise, least);
        Some(Self { readings, branches, pieces, least, rule: Rule::Shifted })
    }

    /// The recorded reading of a step; past the end of the record, of its last.
    #[must_use]
    pub fn recorded(&self, step: usize) -> &Reading {
        &self.readings[step.min(self.readings.len() - 1)]
    }

    /// What the specimen may be supposed to do for all the record tells, the likeliest first.
    #[must_use]
    pub fn rules(&self) -> Vec<Rule> {
        let softer = (1..self.branches.len()).any(|branch| self.pivot(branch).is_some());
        let drifts = self.branches.iter().any(|branch| branch.drifts);
        let possible = [(Rule::Shifted, true), (Rule::Pivoted, softer), (Rule::Kept, drifts)];
        possible.into_iter().filter(|(_, possible)| *possible).map(|(rule, _)| rule).collect()
    }

    /// The same record, if the specimen is supposed to keep to a rule.
    #[must_use]
    pub fn supposing(self, rule: Rule) -> Self {
        Self { rule, ..self }
    }

    /// Takes the way again from its beginning.
    #[must_use]
    pub fn again(&self, distortion: Distortion) -> Again<'_> {
        Again::new(self, distortion)
    }

    /// Displacement and force where a branch may be stretched about; None of one that goes back over the curve it came from,
    /// or as stiffly as the specimen first was.
    fn pivot(&self, branch: usize) -> Option<[f64; 2]> {
        let Branch { first_piece, retraces, .. } = self.branches[branch];
        if retraces {
            return None;
        }
        let mut origin = self.pieces[self.branches[branch - 1].last_piece];
        while let Some(before) = origin.before {
            origin = self.pieces[before];
        }
        let (begun, turn) = (self.readings[origin.begin], self.readings[self.pieces[first_piece].begin]);
        let fallen = origin.start_tangent - (turn.force - begun.force) / (turn.target - begun.target);
        let lost = origin.start_tangent - self.pieces[first_piece].start_tangent;
        (fallen > 0.0 && lost > KEPT * fallen).then_some([begun.target, begun.force])
    }

    /// Displacement and force at `place` (m) on the curve of `piece`, looked for from the reading of `step`.
    fn at(&self, piece: usize, step: usize, place: f64) -> (f64, f64) {
        let mut index = piece;
        // Where the curve was left and gone on with, on that side of it.
        let piece = loop {
            let piece = self.pieces[index];
            let direction = self.branches[piece.branch].direction;
            let beyond = |reading: usize| (place - self.readings[reading].target) * direction;
            index = match (piece.before, piece.after) {
                (Some(before), _) if beyond(piece.begin) < 0.0 => before,
                (_, Some(after)) if beyond(piece.last) > 0.0 => after,
                _ => break piece,
            };
        };
        let direction = self.branches[piece.branch].direction;
        let count = piece.last + 1 - piece.first;
        let reading = |point: usize| self.readings[if point == 0 { piece.begin } else { piece.first + point - 1 }];
        let mut from = (step + 1).saturating_sub(piece.first).min(count);
        let here = reading(from);
        if place == here.target {
            return (here.displacement, here.force);
        }
        let onwards = (place - here.target) * direction > 0.0;
        loop {
            let next = if onwards && from < count {
                from + 1
            } else if !onwards && from > 0 {
                from - 1
            } else {
                break;
            };
            let (near, far) = (reading(from), reading(next));
            // Between the two, or at one of them.
            if (place - near.target) * (place - far.target) <= 0.0 && near.target != far.target {
                let share = (place - near.target) / (far.target - near.target);
                let between = |near: f64, far: f64| near + share * (far - near);
                return (between(near.displacement, far.displacement), between(near.force, far.force));
            }
            from = next;
        }
        let end = reading(from);
        let tangent = if from == count { piece.end_tangent } else { piece.start_tangent };
        let beyond = place - end.target;
        (end.displacement + beyond, end.force + tangent * beyond)
    }
}

/// Bits of a step in a draw, the same in every run: the finaliser of `SplitMix64` (Steele, Lea and Flood 2014).
fn drawn(draw: u16, step: u64) -> u64 {
    let mut bits = (u64::from(draw) << 48 ^ step).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ bits >> 31
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(force: impl Fn(f64) -> f64, targets: &[f64]) -> RecordedPath {
        let reading = |target: &f64| Reading { target: *target, displacement: target + 1e-4, force: force(*target) };
        RecordedPath::new(targets.iter().map(reading).collect(), 1000.0, 0.0, 0.0).unwrap()
    }

    /// Out, back and out again, with a pause at the start.
    const TARGETS: [f64; 9] = [0.0, 0.0, 0.1, 0.3, 0.35, 0.2, 0.05, 0.1, 0.4];

    #[test]
    fn at_the_recorded_targets_the_recorded_readings_come_back_to_the_bit() {
        let path = path(|x| 1000.0 * x + 5.0 * (1e3 * x).sin(), &TARGETS);
        let mut again = path.again(Distortion::NONE);
        assert_eq!(again.start(), (TARGETS[0], path.readings[0].displacement, path.readings[0].force));
        for (target, reading) in TARGETS.iter().zip(&path.readings).skip(1) {
            assert_eq!(again.move_to(*target), (reading.displacement, reading.force));
        }
    }

    /// Wherever it is taken, and past its end, an elastic specimen stays elastic.
    #[test]
    fn an_elastic_way_taken_off_its_targets_is_elastic() {
        let path = path(|x| 1000.0 * x, &TARGETS);
        let mut again = path.again(Distortion { displacement_scale: 1.25, force_scale: 2.0, zero: 3.0, noise: None });
        for (step, target) in (0..).zip(TARGETS.iter().chain(&[0.5, 0.6, -0.2])).skip(1) {
            let off = target + 0.02 * f64::from(step).cos();
            let (displacement, force) = again.move_to(off);
            assert!((force - (1600.0 * off + 3.0)).abs() < 1e-9, "step {step}: {force}");
            assert!((displacement - off - 1.25e-4).abs() < 1e-12);
        }
    }

    /// Yield at 0.2 m, 100 N/m past it, back with 1000 N/m: turned elsewhere, it comes back along R = `R_m` − K(`X_m` − X) of
    /// the new turning point.
    #[test]
    fn turned_elsewhere_a_yielding_specimen_comes_back_on_its_own_line() {
        let loading = |x: f64| if x < 0.2 { 1000.0 * x } else { 200.0 + 100.0 * (x - 0.2) };
        let back = |x: f64| loading(0.5) - 1000.0 * (0.5 - x);
        let readings = [
            (0.0, loading(0.0)),
            (0.2, loading(0.2)),
            (0.4, loading(0.4)),
            (0.5, loading(0.5)),
            (0.45, back(0.45)),
            (0.4, back(0.4)),
        ];
        let readings = readings.map(|(target, force)| Reading { target, displacement: target, force }).to_vec();
        let path = RecordedPath::new(readings, 1000.0, 0.0, 0.0).unwrap();
        for turned in [0.49, 0.5, 0.51, 0.53] {
            let mut again = path.again(Distortion::NONE);
            for target in [0.21, 0.41, turned] {
                assert!((again.move_to(target).1 - loading(target)).abs() < 1e-9, "{turned}");
            }
            for target in [0.46, 0.39] {
                let by_hand = loading(turned) - 1000.0 * (turned - target);
                let (_, force) = again.move_to(target);
                assert!((force - by_hand).abs() < 1e-9, "{turned}: {force} {by_hand}");
            }
        }
    }

    /// Noise on short pieces makes no stiffness: past the end it goes on with the slope of what spans enough.
    #[test]
    fn noise_makes_no_tangent() {
        let readings = |step: u32| {
            let target = 1e-3 * f64::from(step);
            let noise = if step.is_multiple_of(2) { 1.0 } else { -1.0 };
            Reading { target, displacement: target, force: 1000.0 * target + noise }
        };
        let path = RecordedPath::new((0..200).map(readings).collect(), 1000.0, 1.0, 0.0).unwrap();
        let mut again = path.again(Distortion::NONE);
        for step in 1..200 {
            again.move_to(1e-3 * f64::from(step));
        }
        let (_, force) = again.move_to(0.3);
        assert!((force - 300.0).abs() < 12.0, "{force}");
    }

    #[test]
    fn draws_differ_and_have_both_signs_alike() {
        let sum = |draw: u16| (0..1000).map(|step| if drawn(draw, step) & 1 == 0 { 1 } else { -1 }).sum::<i32>();
        for draw in 0..8 {
            assert!(sum(draw).abs() < 110, "draw {draw}: {}", sum(draw));
        }
        let both: i32 = (0..1000).map(|step| if (drawn(3, step) ^ drawn(4, step)) & 1 == 0 { 1 } else { -1 }).sum();
        assert!(both.abs() < 110, "{both}");
    }
}
