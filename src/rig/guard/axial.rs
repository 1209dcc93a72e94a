//! Axial axes in force control, behind all others. In: their targets, and complete readings of the rig. Out: readings of the other axes. An
//! axial axis keeps its force while they move: each reading must have it within the tolerance of the axis, and a displacement in its band.

use super::{Guard, inside};
use crate::safety::failpoint::{Guarding, on};
use crate::{LimitedQuantity, Reading, RigFault, named_axis};
use psd_plan::record::AxialReading;
use psd_plan::{AxialAxis, Interval, Limits};
use std::borrow::Cow;

/// The axial axes of a guard.
#[derive(Debug, Default)]
pub(super) struct AxialAxes {
    axes: Vec<Axial>,
    /// The readings since they were taken last.
    readings: Vec<AxialReading>,
}

#[derive(Debug)]
struct Axial {
    axis: AxialAxis,
    /// Its band \[m\], and the limits of its force \[N\].
    limits: Limits,
    /// \[N\]
    target: f64,
}

impl AxialAxes {
    /// Without a force.
    pub(super) fn new(axes: impl Iterator<Item = (AxialAxis, Limits)>) -> Self {
        let target = 0.0;
        let axial = |(axis, limits)| Axial {
            axis,
            limits,
            target,
        };
        Self {
            axes: axes.map(axial).collect(),
            readings: Vec::new(),
        }
    }

    pub(super) const fn count(&self) -> usize {
        self.axes.len()
    }

    /// The targets of all axes of the rig, from those of the others.
    pub(super) fn with_others<'a>(&self, targets: &'a [f64]) -> Cow<'a, [f64]> {
        if self.axes.is_empty() {
            return Cow::Borrowed(targets);
        }
        let own = self.axes.iter().map(|axial| axial.target);
        Cow::Owned(targets.iter().copied().chain(own).collect())
    }

    /// Takes the entries of these axes out of a reading, and keeps them if the reading is new; the first that is outside its limits.
    pub(super) fn take(&mut self, reading: &mut Reading, is_new: bool) -> Option<RigFault> {
        let others = reading.displacement.len().checked_sub(self.axes.len())?;
        let (displacements, forces) = (
            reading.displacement.split_off(others),
            reading.force.split_off(others),
        );
        let mut fault = None;
        let entries = displacements.into_iter().zip(forces);
        for ((index, axial), (displacement, force)) in self.axes.iter().enumerate().zip(entries) {
            let target = axial.target;
            if is_new {
                self.readings.push(AxialReading {
                    storey: axial.axis.storey as u64 + 1,
                    wall_time: reading.time,
                    target,
                    force,
                    displacement,
                });
            }
            let error = Interval {
                low: -axial.axis.tolerance,
                high: axial.axis.tolerance,
            };
            let checks = [
                (
                    LimitedQuantity::MeasuredDisplacement,
                    axial.limits.displacement,
                    displacement,
                ),
                (LimitedQuantity::Force, axial.limits.force, force),
                (LimitedQuantity::ForceError, error, force - target),
            ];
            let total = others + self.axes.len();
            let breach = |(quantity, limit, value): (LimitedQuantity, Interval, f64)| {
                RigFault::LimitBreached {
                    quantity,
                    value,
                    low: limit.low,
                    high: limit.high,
                    axis: named_axis(others + index, total),
                }
            };
            let outside = checks
                .into_iter()
                .find(|(_, limit, value)| !inside(*limit, *value));
            fault = fault.or(outside.map(breach));
        }
        fault.filter(|_| on(Guarding::ReadingLimits))
    }
}

impl Guard<'_> {
    /// The forces of all axial axes become `force` \[N\], or that of the axis at one storey. The other axes stay at their targets.
    ///
    /// # Errors
    /// A limit is exceeded, or the rig fails.
    pub fn load_axially(&mut self, storey: Option<usize>, force: f64) -> Result<(), RigFault> {
        for index in 0..self.axial.count() {
            let axial = &self.axial.axes[index];
            if storey.is_some_and(|storey| storey != axial.axis.storey) {
                continue;
            }
            let limit = axial.limits.force;
            if !inside(limit, force) {
                let others = self.commanded.len();
                return Err(self.breach(
                    LimitedQuantity::TargetForce,
                    Some(others + index),
                    limit,
                    force,
                ));
            }
            self.axial.axes[index].target = force;
        }
        let others = self.commanded.clone();
        self.move_to(&others, None)
    }

    /// Storey (from 0) and force \[N\] of every axial axis that holds a load.
    pub fn axial_loads(&self) -> impl Iterator<Item = (usize, f64)> {
        let loads = self.axial.axes.iter();
        let loads = loads.map(|axial| (axial.axis.storey, axial.target));
        loads.filter(|(_, force)| *force != 0.0)
    }

    /// Largest force of the axial axes as they were read last \[N\]; None without a reading.
    #[must_use]
    pub fn axial_force(&self) -> Option<f64> {
        let last = self.axial.readings.iter().rev().take(self.axial.count());
        last.map(|reading| reading.force).reduce(f64::max)
    }

    /// The readings of the axial axes since they were taken last.
    #[must_use]
    pub fn axial_readings(&self) -> &[AxialReading] {
        &self.axial.readings
    }

    /// The same, once.
    pub fn take_axial_readings(&mut self) -> Vec<AxialReading> {
        std::mem::take(&mut self.axial.readings)
    }
}
