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
mod monotonic;
mod pieces;
mod rate_correction;
mod reintegrated;

pub(crate) use rate_correction::lag;
pub use reintegrated::Retrace;
pub(crate) use reintegrated::nearest;

use self::pieces::{Branch, Piece, Slopes};
use crate::integrator::tangent::NOISE_MULTIPLE;
use crate::reintegration::hysteresis_replay::rate_correction::ContinuousReadings;
use crate::statistics::DeclaredNoise;

/// One step of the record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Commanded displacement \[m\].
    pub target: f64,
    /// Measured \[m\].
    pub displacement: f64,
    /// Measured \[N\].
    pub force: f64,
}

/// The motion of a run whose actuators do not stop at their targets.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContinuousMotion<V> {
    /// Predicted for the targets \[m/s\].
    pub velocities: V,
    /// From one reading to the next, in the same time \[s\].
    pub time_step: f64,
}

/// A re-run that reverses where nothing is recorded departs from the record beyond this fraction of the farthest recorded position.
const UNSEEN: f64 = 1e-3;
/// Curves nearer to their record than this fraction of it lie on it.
const ROUNDING: f64 = 1e-9;
/// A curve whose last slope is less than this fraction of its first has settled on that.
const SETTLED: f64 = 0.9;

/// Readings along the path, in branches and curves.
#[derive(Clone, Debug)]
pub struct RecordedPath {
    readings: Vec<Reading>,
    branches: Vec<Branch>,
    pieces: Vec<Piece>,
    /// Positions closer than this determine no slope \[m\].
    least: f64,
    /// Farthest target from zero \[m\].
    farthest: f64,
    /// Whether its curves satisfy Masing's rule.
    keeps_masing: bool,
    /// Readings of a continuous motion; `readings` are then those of the specimen at rest.
    continuous: Option<ContinuousReadings>,
}

impl RecordedPath {
    /// `motion` is that of a continuous run; without it the specimen rested at each reading. `stiffness` \[N/m\] applies where no branch
    /// determines one. None without readings.
    #[must_use]
    pub fn new(
        readings: Vec<Reading>,
        motion: Option<ContinuousMotion<&[f64]>>,
        stiffness: f64,
        noise: DeclaredNoise,
    ) -> Option<Self> {
        readings.first()?;
        let continuous =
            motion.map(|motion| ContinuousReadings::of(&readings, motion, noise.resolution));
        let readings = continuous
            .as_ref()
            .map_or(readings, ContinuousReadings::at_rest);
        let least = noise
            .resolution
            .max(NOISE_MULTIPLE * noise.force / stiffness);
        let force_uncertainty = continuous.as_ref().map_or(0.0, |continuous| {
            continuous.force_uncertainty(stiffness, noise.resolution)
        });
        let slopes = Slopes {
            stiffness,
            force_noise: noise.force.hypot(force_uncertainty),
            least,
        };
        let (branches, pieces) = pieces::cut(&readings, slopes, continuous.as_ref());
        let keeps_masing = masing::is_kept(
            &readings,
            &branches,
            &pieces,
            noise.force,
            continuous.is_some(),
        );
        let farthest = readings.iter().fold(0.0, |farthest: f64, reading| {
            farthest.max(reading.target.abs())
        });
        Some(Self {
            readings,
            branches,
            pieces,
            least,
            farthest,
            keeps_masing,
            continuous,
        })
    }

    /// The recorded reading of a step; past the end of the record, of its last.
    #[must_use]
    pub fn recorded(&self, step: usize) -> &Reading {
        let step = step.min(self.readings.len() - 1);
        self.continuous
            .as_ref()
            .map_or(&self.readings[step], |continuous| continuous.reading(step))
    }

    /// Retraces it from its begin, in `finer` steps for each of the record.
    #[must_use]
    pub fn retrace(&self, finer: u8) -> Retrace<'_> {
        Retrace::new(self, finer)
    }

    /// Displacement and force at `position` \[m\] on the curve of `piece`, searched from the reading of `step`.
    fn at(&self, piece: usize, step: usize, position: f64) -> (f64, f64) {
        let mut index = piece;
        // On either side of the point at which the curve was left and later continued.
        let piece = loop {
            let piece = self.pieces[index];
            let direction = self.branches[piece.branch].direction;
            let beyond = |reading: &Reading| (position - reading.target) * direction;
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
        if position == here.target {
            return (here.displacement, here.force);
        }
        let onwards = (position - here.target) * direction > 0.0;
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
            // Between the two, or at one of them. Nearby, the noise of this reading applies and not that of its neighbours: the
            // force continues from here to the first reading that is far enough to determine a slope.
            if off(far) >= (position - here.target).abs()
                && off(far) >= self.least
                && off(far) > off(near)
            {
                let near = if off(near) < self.least { here } else { near };
                let share = (position - near.target) / (far.target - near.target);
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
        let beyond = position - end.target;
        (end.displacement + beyond, end.force + tangent * beyond)
    }
}

#[cfg(test)]
mod tests;
