//! The position and force of a rig that is found when a run is resumed, compared with those of its run log.

use super::refusal::ResumeRefusal;
use crate::run::replay::entry::{SampleBody, TargetStatus};
use crate::run::replay::logged_run::body;
use psd_physics::tracking::trajectory::Path;
use psd_plan::{Interval, RealLink, RigPlan};
use psd_rig::journal::{EntryKind, Line};
use psd_rig::safety::failpoint::{Guarding, on};
use psd_rig::{Reading, named_axis};

/// Longest time for which a rig without a next path continues before it holds \[s\]: 0.25 s of the controller, and the
/// delay of its line and its clock.
const LONGEST_OVERRUN: f64 = 1.0;

/// Readings before the last one in which its motion is looked for.
const RECENT: usize = 64;

/// \[m\] and \[N\], one entry per degree of freedom.
pub(super) type Measured = (Vec<f64>, Vec<f64>);

/// Largest distance of the rig from its logged position and force, one entry per axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Bands {
    /// Of what the controllers hold: \[m\], or \[N\] of the axial axes.
    pub displacement: Vec<f64>,
    /// Number of axial axes, the last ones.
    pub axial: usize,
    /// \[N\], for the relaxation since then.
    pub force: Vec<f64>,
    /// Stiffness of the pre-test check \[N/m\]: the change of force in a motion since then.
    pub stiffness: Vec<Interval>,
}

impl Bands {
    /// The resolution of a rig. Each axis has a separate one: a band that is negligible for a coarse axis may be half the force of
    /// another.
    #[must_use]
    pub fn of(rig: &RigPlan, link: &RealLink) -> Self {
        let axes = 0..rig.axes().unwrap_or(1);
        let readings = axes.map(|axis| (link.readings_of(axis), link.pretest_check_of(axis)));
        let mut bands = Self {
            displacement: Vec::new(),
            axial: 0,
            force: Vec::new(),
            stiffness: Vec::new(),
        };
        for (axis, (read, pretest_check)) in readings.enumerate() {
            if let Some(axial) = link.axes.get(axis).and_then(|axis| axis.axial) {
                bands.displacement.push(axial.tolerance);
                bands.axial += 1;
                bands.force.push(f64::INFINITY);
                bands.stiffness.push(Interval {
                    low: 0.0,
                    high: 0.0,
                });
                continue;
            }
            bands
                .displacement
                .push(rig.settle.band.max(4.0 * read.resolution));
            bands.force.push(pretest_check.zero.max(6.0 * read.noise));
            bands.stiffness.push(pretest_check.stiffness);
        }
        bands
    }

    /// What the controllers hold at a measured position: displacements \[m\], then the forces of axial axes \[N\].
    pub(super) fn controlled(&self, displacement: &[f64], force: &[f64]) -> Vec<f64> {
        let lateral = displacement.len().saturating_sub(self.axial);
        let axial = force.get(lateral..).unwrap_or_default();
        displacement[..lateral]
            .iter()
            .chain(axial)
            .copied()
            .collect()
    }

    /// The same, for a specimen that was softer in the last logged motion: after yield the force follows its tangent. No stiffness is below
    /// zero: a specimen that loses force must be inspected.
    pub(super) fn softened_by(&self, lines: &[Line]) -> Self {
        let mut bands = self.clone();
        let mut readings = lines
            .iter()
            .rev()
            .filter(|line| line.kind == EntryKind::Sample)
            .map_while(|line| body::<SampleBody>(line).ok());
        let Some(last) = readings.next() else {
            return bands;
        };
        let earlier: Vec<SampleBody> = readings.take(RECENT).collect();
        for (axis, stiffness) in bands.stiffness.iter_mut().enumerate() {
            let of = |sample: &SampleBody| Some((*sample.x.get(axis)?, *sample.r.get(axis)?));
            let Some((x, r)) = of(&last) else { continue };
            let far =
                |(before, _): &(f64, f64)| (x - before).abs() > band(&self.displacement, axis);
            if let Some((before, force)) = earlier.iter().filter_map(of).find(far) {
                let tangent = (r - force) / (x - before);
                stiffness.low = stiffness.low.min(tangent.max(0.0));
            }
        }
        bands
    }
}

/// The band of the axis with this index; zero for an axis without a band.
fn band(bands: &[f64], axis: usize) -> f64 {
    bands.get(axis).copied().unwrap_or(0.0)
}

/// A single missing reading is made late, at the end of the stroke.
pub(super) const fn mostly_lost(samples: usize, readings_done: usize) -> bool {
    readings_done + 1 < samples && 2 * readings_done < samples
}

/// The position in which the run log allows the rig to move again \[m\], one entry per axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Place {
    At(Vec<f64>),
    /// On the way of a motion, ends included.
    Between(Vec<f64>, Vec<f64>),
}

impl Place {
    /// Between the end of each path and the farthest position at which its axis may have held.
    pub(super) fn past(paths: &[Path]) -> Self {
        let farthest = |path: &Path| path.to + LONGEST_OVERRUN * path.end_velocity;
        Self::Between(
            paths.iter().map(|path| path.to).collect(),
            paths.iter().map(farthest).collect(),
        )
    }
}

/// Every way back into motion passes here. The rig must be in a place that the run log allows, with a force that follows from the last
/// logged reading, `reference` (\[m\], \[N\]).
pub(super) fn may_move(
    place: &Place,
    reference: Option<&Measured>,
    found: &Reading,
    bands: &Bands,
    accept_relaxation: bool,
) -> Result<(), ResumeRefusal> {
    let controlled = bands.controlled(&found.displacement, &found.force);
    let position = FoundPosition {
        positions: &controlled,
        bands,
    };
    match place {
        Place::At(at) => position.expect_at(at)?,
        Place::Between(from, to) => position.expect_between(from, to)?,
    }
    let Some(reference) = reference.filter(|_| !accept_relaxation && on(Guarding::ForceFound))
    else {
        return Ok(());
    };
    let axes = found.force.len();
    for (axis, force) in found.force.iter().enumerate() {
        let Interval { low, high } = allowed_force(axis, reference, &found.displacement, bands);
        if !(low..=high).contains(force) {
            return Err(ResumeRefusal::Relaxed {
                recorded: reference.1.get(axis).copied().unwrap_or(f64::NAN),
                found: *force,
                low,
                high,
                axis: named_axis(axis, axes),
            });
        }
    }
    Ok(())
}

/// The force of one axis at `positions` \[N\], if the specimen is that of the logged reading: r + k Δ ± band. k is the stiffness of the
/// axis. The other axes add at most √(kᵢ kⱼ) Δⱼ each, because the stiffness matrix is symmetric and positive.
fn allowed_force(
    axis: usize,
    (from, forces): &Measured,
    positions: &[f64],
    bands: &Bands,
) -> Interval {
    let travel = |axis: usize| match (positions.get(axis), from.get(axis)) {
        (Some(to), Some(from)) => to - from,
        _ => f64::NAN,
    };
    let stiffness = |axis: usize| bands.stiffness.get(axis).copied().unwrap_or(Interval::ALL);
    // A stiffness without a bound times no travel is no force.
    let product = |stiffness: f64, travel: f64| {
        if travel == 0.0 {
            0.0
        } else {
            stiffness * travel
        }
    };
    let own = stiffness(axis);
    let ends = [own.low, own.high].map(|end| product(end, travel(axis)));
    let others: f64 = (0..positions.len())
        .filter(|other| *other != axis)
        .map(|other| {
            let coupling = (own.high * stiffness(other).high).sqrt();
            product(coupling, travel(other).abs())
        })
        .sum();
    let margin = band(&bands.force, axis) + others;
    let force = forces.get(axis).copied().unwrap_or(f64::NAN);
    Interval {
        low: force + ends[0].min(ends[1]) - margin,
        high: force + ends[0].max(ends[1]) + margin,
    }
}

/// An interrupted motion with readings during the motion.
pub(super) struct InterruptedMotion<'a> {
    /// The position of its last reading, else its start \[m\].
    pub(super) reached: Vec<f64>,
    pub(super) target: Vec<f64>,
    /// For a motion along smooth paths.
    pub(super) paths: Option<&'a [Path]>,
    /// Readings that were requested, and those that were logged.
    pub(super) samples: usize,
    pub(super) readings_done: usize,
}

impl InterruptedMotion<'_> {
    /// A specimen with a memory travels no path twice: the rest is travelled from the present position. A stroke is repeated only if it
    /// continued to its end and most of its readings are missing.
    pub(super) fn target_status(
        self,
        found: FoundPosition<'_>,
        before: &[f64],
    ) -> (TargetStatus, Place) {
        if self.paths.is_none()
            && mostly_lost(self.samples, self.readings_done)
            && found.is_at(&self.target)
            && !found.is_at(&self.reached)
        {
            let status = TargetStatus::Stroke {
                back_to: before[0],
                others: before[1..].to_vec(),
            };
            return (status, Place::At(self.target));
        }
        let (low, high) = match self.paths {
            Some(paths) => paths.iter().map(possible_hold).unzip(),
            None => (self.reached, self.target),
        };
        let from = before.to_vec();
        (
            TargetStatus::RemainingMotion { from },
            Place::Between(low, high),
        )
    }
}

/// The range in which an axis on a path may hold, on the path, before it or beyond it \[m\]: at either end it continues at
/// the velocity of that end.
fn possible_hold(path: &Path) -> (f64, f64) {
    let (low, high) = path.reach();
    let (short, past) = (
        path.from + LONGEST_OVERRUN * path.start_velocity,
        path.to + LONGEST_OVERRUN * path.end_velocity,
    );
    (low.min(short).min(past), high.max(short).max(past))
}

#[derive(Clone, Copy)]
pub(super) struct FoundPosition<'a> {
    /// What the controllers hold, one per axis: \[m\], or \[N\] of axial axes.
    pub(super) positions: &'a [f64],
    pub(super) bands: &'a Bands,
}

impl FoundPosition<'_> {
    const fn is_axial(self, axis: usize) -> bool {
        axis + self.bands.axial >= self.positions.len()
    }

    fn without_load(self, axis: usize, low: f64, high: f64) -> ResumeRefusal {
        ResumeRefusal::WithoutLoad {
            found: self.positions[axis],
            low,
            high,
            axis: named_axis(axis, self.positions.len()),
        }
    }

    pub(super) fn is_at(self, recorded: &[f64]) -> bool {
        self.first_axis_off(recorded).is_none()
    }

    /// The first axis that is not at its position in `recorded`. An axis without a position counts as not there.
    fn first_axis_off(self, recorded: &[f64]) -> Option<usize> {
        let near = |axis, recorded: &f64, position: &f64| {
            (position - recorded).abs() <= band(&self.bands.displacement, axis)
        };
        let at = |(axis, position): (usize, &f64)| {
            recorded
                .get(axis)
                .is_some_and(|recorded| near(axis, recorded, position))
        };
        self.positions.iter().enumerate().position(|axis| !at(axis))
    }

    pub(super) fn expect_at(self, recorded: &[f64]) -> Result<(), ResumeRefusal> {
        let Some(axis_index) = self.first_axis_off(recorded) else {
            return Ok(());
        };
        let (found, recorded) = (
            self.positions[axis_index],
            recorded.get(axis_index).copied().unwrap_or(f64::NAN),
        );
        let band = band(&self.bands.displacement, axis_index);
        if self.is_axial(axis_index) {
            return Err(self.without_load(axis_index, recorded - band, recorded + band));
        }
        Err(ResumeRefusal::Elsewhere {
            recorded,
            found,
            band,
            axis: named_axis(axis_index, self.positions.len()),
        })
    }

    pub(super) fn expect_between(self, from: &[f64], to: &[f64]) -> Result<(), ResumeRefusal> {
        let axes = self.positions.iter().zip(from.iter().zip(to));
        for (axis_index, (found, (from, to))) in axes.enumerate() {
            let band = band(&self.bands.displacement, axis_index);
            let (low, high) = (from.min(*to) - band, from.max(*to) + band);
            if !(low <= *found && *found <= high) {
                if self.is_axial(axis_index) {
                    return Err(self.without_load(axis_index, low, high));
                }
                let axis = named_axis(axis_index, self.positions.len());
                return Err(ResumeRefusal::Lost {
                    from: *from,
                    to: *to,
                    found: *found,
                    axis,
                });
            }
        }
        Ok(())
    }
}
