//! Axes of the native firmware in force control. In: the words of `FORCE`, the targets of a `MOVE`. Out: rates and tolerances, forces of the
//! emulated rig, or the code of a refusal. `HELLO`, a hold and a silent host leave the mode as it is.

use super::{Native, decimal, of_axis};
use crate::emulator::{EmulatedRig, ForceControl};
use psd_plan::Interval;

/// Distance of an axial actuator from its displacement target that is none \[mm\]: the rounding of a frame.
const ROUNDING: f64 = 1e-6;

impl Native {
    /// `FORCE {rate tolerance}`
    pub(super) fn control_force(
        &mut self,
        words: &[&str],
        rig: &EmulatedRig,
    ) -> Result<(), String> {
        let numbers: Option<Vec<f64>> = words.iter().map(|word| decimal(word)).collect();
        let numbers = numbers.ok_or("ARG")?;
        let mut given = Vec::with_capacity(self.actuators.len());
        for (axis, pair) in numbers.chunks_exact(2).enumerate() {
            let actuator = self.actuators[axis];
            let control = (pair[0] != 0.0).then_some((pair[0], pair[1]));
            let is_apt = match control {
                Some((rate, tolerance)) => rate > 0.0 && tolerance > 0.0 && rig.is_axial(actuator),
                None => rig.force_control(actuator).is_none(),
            };
            if !is_apt {
                return Err(of_axis("ARG", axis, self.actuators.len()));
            }
            given.push(control);
        }
        self.force = given;
        Ok(())
    }

    pub(super) fn has_force_axis(&self) -> bool {
        self.force.iter().any(Option::is_some)
    }

    /// The limits of a run end, except those of an axis that holds a force.
    pub(super) fn forget_limits(&mut self, rig: &EmulatedRig) {
        let mut own = self.own.clone();
        for (axis, actuator) in self.actuators.iter().enumerate() {
            if rig.force_control(*actuator).is_some() {
                own.axes[axis] = self.run.axes[axis];
            }
        }
        self.run = own;
    }

    /// The actuators that go to displacements, and these \[m\].
    pub(super) fn displacements(&self, targets: &[f64]) -> (Vec<usize>, Vec<f64>) {
        let each = self.actuators.iter().zip(targets).zip(&self.force);
        let moving = each.filter(|(_, force)| force.is_none());
        moving
            .map(|((actuator, target), _)| (*actuator, target / 1e3))
            .unzip()
    }

    /// Whether a target \[mm\], or \[N\] in force control, is within the limits of the run. An axial actuator that holds its displacement
    /// stays there: its column is stiff.
    pub(super) fn allows(&self, axis: usize, target: f64, rig: &EmulatedRig) -> bool {
        let (bounds, actuator) = (self.run.axes[axis], self.actuators[axis]);
        let (low, high) = if self.force[axis].is_some() {
            bounds.force
        } else {
            bounds.displacement
        };
        let stays = (target - rig.commanded_of(actuator) * 1e3).abs() <= ROUNDING;
        low <= target
            && target <= high
            && (self.force[axis].is_some() || !rig.is_axial(actuator) || stays)
    }

    /// The axes in force control go to their targets \[N\].
    pub(super) fn load(&self, targets: &[f64], rig: &mut EmulatedRig) {
        for (axis, target) in targets.iter().enumerate() {
            let Some((rate, tolerance)) = self.force[axis] else {
                continue;
            };
            let (low, high) = self.run.axes[axis].displacement;
            let control = ForceControl {
                target: *target,
                rate,
                tolerance,
                band: Interval {
                    low: low / 1e3,
                    high: high / 1e3,
                },
            };
            rig.control_force(self.actuators[axis], control);
        }
    }

    /// Without the force of an axis all axes hold.
    pub(super) fn hold_without_force(&mut self, rig: &mut EmulatedRig) {
        let has_left = |actuator: &usize| rig.left_force_control(*actuator).is_some();
        if !self.held && self.actuators.iter().any(has_left) {
            self.hold(rig);
        }
    }
}
