//! The measured force–displacement path of a specimen, used as its model. In: targets and the
//! forces read there, in order. Out: the force at targets near them, so that a run can be
//! re-integrated with a perturbed input. At the recorded targets it returns the recorded readings
//! bit for bit.
//!
//! `pieces` cuts the path into branches. Beyond the end of a branch the force follows its tangent. A branch that begins elsewhere
//! keeps its shape (Masing's rule): exact for elastic specimens and for elastic–plastic elements in parallel (Iwan's model).
//! `masing` compares the record with that rule. `rate_correction` removes lag and damping of a moving actuator from the readings. At
//! the recorded targets the recorded readings come back bit-identical.

mod masing;
mod pieces;
mod rate_correction;
mod reintegrated;

pub(crate) use rate_correction::lag;
pub use reintegrated::Retrace;
pub(crate) use reintegrated::nearest;

use self::pieces::{Branch, Piece};
use crate::integrator::tangent::NOISE_MULTIPLE;
use crate::reintegration::hysteresis_replay::rate_correction::ContinuousReadings;

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

/// A re-run that goes back where nothing is recorded departs from the record beyond this fraction of the farthest recorded place.
const UNSEEN: f64 = 1e-3;
/// Curves that lie nearer to their record, of the same, lie there.
const ROUNDING: f64 = 1e-9;
/// A curve whose last slope is less than this fraction of its first has settled on that.
const SETTLED: f64 = 0.9;

/// Readings along the way, in branches and curves.
#[derive(Clone, Debug)]
pub struct RecordedPath {
    readings: Vec<Reading>,
    branches: Vec<Branch>,
    pieces: Vec<Piece>,
    /// Places no farther apart tell no difference of force, m.
    least: f64,
    /// Farthest target from zero, m.
    farthest: f64,
    /// Whether its curves keep Masing's rule.
    keeps_masing: bool,
    /// Of readings made without a stop: `readings` are those of the specimen at rest.
    under_way: Option<ContinuousReadings>,
}

impl RecordedPath {
    /// `stiffness` (N/m) where no branch tells one; `force_noise` (N) and `resolution` (m) say how long a piece must be to
    /// tell. None of no reading.
    #[must_use]
    pub fn new(
        readings: Vec<Reading>,
        stiffness: f64,
        force_noise: f64,
        resolution: f64,
    ) -> Option<Self> {
        if readings.is_empty() {
            return None;
        }
        Some(Self::of(
            readings,
            None,
            stiffness,
            (force_noise, resolution),
        ))
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
        let found = ContinuousReadings::of(readings, velocities, time_step, resolution);
        Some(Self::of(
            found.at_rest(),
            Some(found),
            stiffness,
            (force_noise, resolution),
        ))
    }

    fn of(
        readings: Vec<Reading>,
        under_way: Option<ContinuousReadings>,
        stiffness: f64,
        (force_noise, resolution): (f64, f64),
    ) -> Self {
        let least = resolution.max(NOISE_MULTIPLE * force_noise / stiffness);
        let unsure = under_way
            .as_ref()
            .map_or(0.0, |under_way| under_way.unsure(stiffness, resolution));
        let told = (stiffness, force_noise.hypot(unsure), least);
        let (branches, pieces) = pieces::cut(&readings, told, under_way.as_ref());
        let keeps_masing = masing::is_kept(
            &readings,
            &branches,
            &pieces,
            force_noise,
            under_way.is_some(),
        );
        let farthest = readings.iter().fold(0.0, |farthest: f64, reading| {
            farthest.max(reading.target.abs())
        });
        Self {
            readings,
            branches,
            pieces,
            least,
            farthest,
            keeps_masing,
            under_way,
        }
    }

    /// The recorded reading of a step; past the end of the record, of its last.
    #[must_use]
    pub fn recorded(&self, step: usize) -> &Reading {
        let step = step.min(self.readings.len() - 1);
        self.under_way
            .as_ref()
            .map_or(&self.readings[step], |under_way| under_way.reading(step))
    }

    /// Goes along it again from its beginning, in `finer` steps for each of the record.
    #[must_use]
    pub fn retrace(&self, finer: u8) -> Retrace<'_> {
        Retrace::new(self, finer)
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
        let reading = |point: usize| {
            if point == 0 {
                piece.begin
            } else {
                self.readings[piece.first + point - 1]
            }
        };
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
            if off(far) >= (place - here.target).abs()
                && off(far) >= self.least
                && off(far) > off(near)
            {
                let near = if off(near) < self.least { here } else { near };
                let share = (place - near.target) / (far.target - near.target);
                let between = |near: f64, far: f64| near + share * (far - near);
                return (
                    between(near.displacement, far.displacement),
                    between(near.force, far.force),
                );
            }
            from = next;
        }
        let tangent = if from == count {
            piece.end_tangent
        } else {
            piece.start_tangent
        };
        let end = reading(from);
        let end = if (end.target - here.target).abs() < self.least {
            here
        } else {
            end
        };
        let beyond = place - end.target;
        (end.displacement + beyond, end.force + tangent * beyond)
    }
}

#[cfg(test)]
mod tests;
