//! The position and force of a rig that is found when a run is resumed, compared with those of its run log.

use super::refusal::ResumeRefusal;
use crate::physics::tracking::trajectory::Path;
use crate::plan::{RealLink, RigPlan};
use crate::rig::{Reading, named_axis};
use crate::run::replay::entry::TargetStatus;

/// Longest time for which a rig without a next path continues before it holds \[s\]: 0.25 s of the controller, and the
/// delay of its line and its clock.
const LONGEST_OVERRUN: f64 = 1.0;

/// Largest distance of the rig from its logged position, one entry per axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Bands {
    /// \[m\]
    pub displacement: Vec<f64>,
    /// \[N\], for the relaxation since then.
    pub force: Vec<f64>,
}

impl Bands {
    /// The resolution of a rig. Each axis has a separate one: a band that is negligible for a coarse axis may be half the force of
    /// another.
    #[must_use]
    pub fn of(rig: &RigPlan, link: &RealLink) -> Self {
        let axes = 0..rig.axes().unwrap_or(1);
        let readings = axes.map(|axis| (link.readings_of(axis), link.pretest_check_of(axis)));
        let bands = readings.map(|(read, pretest_check)| {
            (
                rig.settle.band.max(4.0 * read.resolution),
                pretest_check.zero.max(6.0 * read.noise),
            )
        });
        let (displacement, force) = bands.unzip();
        Self {
            displacement,
            force,
        }
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

/// A relaxation beyond its band must be accepted by the operator.
pub(super) fn check_relaxation(
    recorded: Option<&(Vec<f64>, Vec<f64>)>,
    found: &Reading,
    bands: &Bands,
    accept: bool,
) -> Result<(), ResumeRefusal> {
    let Some((_, recorded)) = recorded.filter(|_| !accept) else {
        return Ok(());
    };
    let inside = |(axis, (recorded, found)): (usize, (&f64, &f64))| {
        (found - recorded).abs() <= band(&bands.force, axis)
    };
    let Some(axis_index) = recorded
        .iter()
        .zip(&found.force)
        .enumerate()
        .position(|axis| !inside(axis))
    else {
        return Ok(());
    };
    let (axis, band) = (
        named_axis(axis_index, found.force.len()),
        band(&bands.force, axis_index),
    );
    Err(ResumeRefusal::Relaxed {
        recorded: recorded[axis_index],
        found: found.force[axis_index],
        band,
        axis,
    })
}

/// An interrupted motion with readings during the motion.
pub(super) struct InterruptedMotion<'a> {
    /// The position of its last reading, else its start \[m\].
    pub(super) reached: &'a [f64],
    pub(super) target: &'a [f64],
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
        &self,
        found: FoundPosition<'_>,
        before: &[f64],
    ) -> Result<TargetStatus, ResumeRefusal> {
        match self.paths {
            Some(paths) => {
                let (low, high): (Vec<f64>, Vec<f64>) = paths.iter().map(possible_hold).unzip();
                found.expect_between(&low, &high)?;
            }
            None if mostly_lost(self.samples, self.readings_done)
                && found.is_at(self.target)
                && !found.is_at(self.reached) =>
            {
                return Ok(TargetStatus::Stroke {
                    back_to: before[0],
                    others: before[1..].to_vec(),
                });
            }
            None => {
                found.expect_between(self.reached, self.target)?;
            }
        }
        Ok(TargetStatus::RemainingMotion {
            from: before.to_vec(),
        })
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
    /// \[m\], one per axis.
    pub(super) positions: &'a [f64],
    /// \[m\], one per axis.
    pub(super) bands: &'a [f64],
}

impl FoundPosition<'_> {
    pub(super) fn is_at(self, recorded: &[f64]) -> bool {
        self.first_axis_off(recorded).is_none()
    }

    /// The first axis that is not at its position in `recorded`. An axis without a position counts as not there.
    fn first_axis_off(self, recorded: &[f64]) -> Option<usize> {
        let near = |axis, recorded: &f64, position: &f64| {
            (position - recorded).abs() <= band(self.bands, axis)
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
        let band = band(self.bands, axis_index);
        Err(ResumeRefusal::Elsewhere {
            recorded,
            found,
            band,
            axis: named_axis(axis_index, self.positions.len()),
        })
    }

    /// Whether each axis is between the end of its path and the farthest position at which it may have held.
    pub(super) fn expect_past(self, paths: &[Path]) -> Result<(), ResumeRefusal> {
        let ends: Vec<f64> = paths.iter().map(|path| path.to).collect();
        let farthest: Vec<f64> = paths
            .iter()
            .map(|path| path.to + LONGEST_OVERRUN * path.end_velocity)
            .collect();
        self.expect_between(&ends, &farthest).map(drop)
    }

    pub(super) fn expect_between(
        self,
        from: &[f64],
        to: &[f64],
    ) -> Result<TargetStatus, ResumeRefusal> {
        let axes = self.positions.iter().zip(from.iter().zip(to));
        for (axis_index, (found, (from, to))) in axes.enumerate() {
            let band = band(self.bands, axis_index);
            let (low, high) = (from.min(*to) - band, from.max(*to) + band);
            if !(low <= *found && *found <= high) {
                let axis = named_axis(axis_index, self.positions.len());
                return Err(ResumeRefusal::Lost {
                    from: *from,
                    to: *to,
                    found: *found,
                    axis,
                });
            }
        }
        Ok(TargetStatus::HeldDuringMotion)
    }
}
