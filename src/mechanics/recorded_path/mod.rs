//! The specimen as a run recorded it: force over displacement along the way it went, so that the run can be taken again
//! with an input moved a little and no model of the specimen. In: targets and what was read at them, in order. Out: what
//! would be read at targets near those, step by step.
//!
//! The record is cut into curves (`pieces`), on which the force is interpolated; beyond what was recorded of one it goes on
//! along the tangent there. The way taken again goes from curve to curve at its own turns (`again`). What a curve does when
//! its beginning has moved, `Rule` says what is supposed, and the record itself refutes some of that (`refuted`). What an
//! actuator under way adds to its readings is taken off them first (`under_way`). At the recorded targets the recorded
//! readings come back as they were, to the bit.

mod again;
mod map;
mod pieces;
mod refuted;
mod under_way;

pub use again::Again;
pub(super) use again::nearest;
pub(super) use under_way::lag;

use self::pieces::{Branch, Cut, Piece};
use self::under_way::UnderWay;
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

/// A curve whose last slope is less than this share of its first has settled on that.
const SETTLED: f64 = 0.9;

/// What a specimen is supposed to do after it turned elsewhere. Where it goes back over the curve it came from it does so
/// after every turn, and where it passes the place of an earlier turn it goes on with the curve that was left there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// Its curve begins at the turn and keeps its shape: exact of elastic specimens and of elastic–plastic elements side by
    /// side (Iwan's model), however many. One that passed an earlier turn of the record elsewhere than through it, so that no
    /// loop was closed, keeps the line that it settled on.
    Shifted,
    /// It slides along the line on which the specimen flows, and no loop is ever closed: exact of one element, elastic–plastic
    /// or of Bouc and Wen's, beside a spring, whose force goes on from what it is and not from how it came to be so.
    Flowing,
    /// Its curve is stretched about where the one before it began, if it came back softer than it first was: exact of those
    /// that lose stiffness and come back to the origin.
    Pivoted,
    /// As `Shifted` until the force is gone; from there it goes to where the record went, as far as that is known: of those
    /// that come back to a place of their own on the far side (pinching, a gap that closes).
    Anchored,
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
    /// Steps for each of the record, 1 or more.
    pub finer: u8,
}

impl Distortion {
    pub const NONE: Self = Self { force_scale: 1.0, displacement_scale: 1.0, zero: 0.0, noise: None, finer: 1 };
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
    /// What may be supposed, the likeliest first; one at least.
    rules: Vec<Rule>,
    /// The record as it is cut where no loop is closed; of `Flowing`, as it is cut where they are.
    otherwise: Cut,
    /// Of the line on which it flows, N/m.
    softest: f64,
    /// Of readings made without a stop: `readings` are those of the specimen at rest.
    under_way: Option<UnderWay>,
}

impl RecordedPath {
    /// `stiffness` (N/m) where no branch tells one; `force_noise` (N) and `resolution` (m) say how long a piece must be to
    /// tell. None of no reading.
    #[must_use]
    pub fn new(readings: Vec<Reading>, stiffness: f64, force_noise: f64, resolution: f64) -> Option<Self> {
        if readings.is_empty() {
            return None;
        }
        Some(Self::of(readings, None, stiffness, (force_noise, resolution)))
    }

    /// The same of readings made under way, `time_step` (s) apart, with the velocities foretold for their targets, m/s.
    #[must_use]
    pub fn under_way(
        readings: Vec<Reading>,
        (velocities, time_step): (&[f64], f64),
        stiffness: f64,
        force_noise: f64,
        resolution: f64,
    ) -> Option<Self> {
        if readings.is_empty() {
            return None;
        }
        let found = UnderWay::of(readings, velocities, time_step, resolution);
        Some(Self::of(found.at_rest(), Some(found), stiffness, (force_noise, resolution)))
    }

    fn of(readings: Vec<Reading>, under_way: Option<UnderWay>, stiffness: f64, (force_noise, resolution): (f64, f64)) -> Self {
        let least = resolution.max(NOISE_MULTIPLE * force_noise / stiffness);
        let unsure = under_way.as_ref().map_or(0.0, |under_way| under_way.unsure(stiffness, resolution));
        let told = (stiffness, force_noise.hypot(unsure), least);
        let (branches, pieces) = pieces::cut(&readings, told, under_way.as_ref(), true);
        let otherwise = pieces::cut(&readings, told, under_way.as_ref(), false);
        let softest = pieces::softest(&readings, &otherwise, least).unwrap_or(pieces[0].start_tangent);
        let rules = vec![Rule::Shifted];
        let mut path = Self { readings, branches, pieces, least, rule: Rule::Shifted, rules, otherwise, softest, under_way };
        path.rules = refuted::left(&path, path.possible());
        path
    }

    /// The recorded reading of a step; past the end of the record, of its last.
    #[must_use]
    pub fn recorded(&self, step: usize) -> &Reading {
        let step = step.min(self.readings.len() - 1);
        self.under_way.as_ref().map_or(&self.readings[step], |under_way| under_way.reading(step))
    }

    /// Whether it swung through no force and back after it flowed: what came then rests on more than one supposition.
    #[must_use]
    pub fn swung_back(&self) -> bool {
        self.swings().count() > 1
    }

    /// Branches that do not go back over the one before and on which the force changes its sign.
    fn swings(&self) -> impl Iterator<Item = &Branch> {
        self.branches.iter().skip(1).filter(|branch| branch.gone.is_some() && !branch.retraces)
    }

    /// What the specimen may be supposed to do for all the record tells, the likeliest first.
    #[must_use]
    pub fn rules(&self) -> &[Rule] {
        &self.rules
    }

    /// What it may be supposed to do by the look of its curves.
    fn possible(&self) -> Vec<Rule> {
        let softer = (1..self.branches.len()).any(|branch| self.pivot(branch).is_some());
        let drifts = self.branches.iter().any(|branch| branch.drifts);
        let swings = self.swings().next().is_some();
        let flows =
            self.softest.abs() < SETTLED * self.pieces[0].start_tangent && self.branches.iter().skip(1).any(|it| !it.retraces);
        let possible = [
            (Rule::Shifted, true),
            (Rule::Flowing, flows),
            (Rule::Pivoted, softer),
            (Rule::Anchored, swings),
            (Rule::Kept, drifts),
        ];
        possible.into_iter().filter(|(_, possible)| *possible).map(|(rule, _)| rule).collect()
    }

    /// The same record, if the specimen is supposed to keep to a rule; to its likeliest where it cannot be that one.
    #[must_use]
    pub fn supposing(self, rule: Rule) -> Self {
        let rule = if self.rules.contains(&rule) { rule } else { self.rules[0] };
        self.keeping_to(rule)
    }

    fn keeping_to(mut self, rule: Rule) -> Self {
        if (rule == Rule::Flowing) != (self.rule == Rule::Flowing) {
            std::mem::swap(&mut self.branches, &mut self.otherwise.0);
            std::mem::swap(&mut self.pieces, &mut self.otherwise.1);
        }
        Self { rule, ..self }
    }

    /// Force at a place (m) of the curve of a piece, where the record went there, N.
    fn recorded_at(&self, piece: usize, place: f64) -> Option<f64> {
        pieces::within(&self.readings, &self.pieces, &self.branches, piece, place).map(|(_, force)| force)
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
        let (begun, turn) = (origin.begin, self.pieces[first_piece].begin);
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
            let beyond = |reading: &Reading| (place - reading.target) * direction;
            index = match (piece.before, piece.after) {
                (Some(before), _) if beyond(&piece.begin) < 0.0 => before,
                (_, Some(after)) if beyond(&self.pieces[after].begin) > 0.0 => after,
                _ => break piece,
            };
        };
        let direction = self.branches[piece.branch].direction;
        let count = piece.last + 1 - piece.first;
        let reading = |point: usize| if point == 0 { piece.begin } else { self.readings[piece.first + point - 1] };
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
            let off = |reading: Reading| (reading.target - here.target).abs();
            // Between the two, or at one of them. Near by, the noise of this reading counts and not that of its neighbours, which
            // the way as it was had at other places: the force goes on from here to the first that is far enough to tell a slope.
            if off(far) >= (place - here.target).abs() && off(far) >= self.least && off(far) > off(near) {
                let near = if off(near) < self.least { here } else { near };
                let share = (place - near.target) / (far.target - near.target);
                let between = |near: f64, far: f64| near + share * (far - near);
                return (between(near.displacement, far.displacement), between(near.force, far.force));
            }
            from = next;
        }
        let tangent = if from == count { piece.end_tangent } else { piece.start_tangent };
        let end = reading(from);
        let end = if (end.target - here.target).abs() < self.least { here } else { end };
        let beyond = place - end.target;
        (end.displacement + beyond, end.force + tangent * beyond)
    }
}

/// Bits of a step in a draw, the same in every run: the finaliser of `SplitMix64`.
fn drawn(draw: u16, step: u64) -> u64 {
    let mut bits = (u64::from(draw) << 48 ^ step).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ bits >> 31
}

#[cfg(test)]
mod tests;
