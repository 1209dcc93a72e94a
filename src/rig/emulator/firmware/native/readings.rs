//! The readings of the native firmware: medians of forces, displacements, state and flags. In: the emulated rig. Out: the words of an answer.
//! They move nothing.

use super::Native;
use crate::emulator::{EmulatedRig, LeftForceControl};

impl Native {
    /// Returns the medians of several readings.
    pub(super) fn measure(&self, count: usize, rig: &mut EmulatedRig) -> String {
        let axis_words = |(axis, actuator): (usize, &usize)| {
            let actuator = *actuator;
            let mut forces: Vec<f64> = (0..count).map(|_| rig.force_of(actuator)).collect();
            forces.sort_by(f64::total_cmp);
            let force = f64::midpoint(forces[(count - 1) / 2], forces[count / 2]);
            let raw = rig.counts_of(force);
            let displacement = rig.displacement_of(actuator) * 1e3;
            let shown = rig.shown_force(actuator, format!("{force:.3}"));
            let flags = self.flags(axis, !(-8_388_607..8_388_607).contains(&raw), rig);
            format!("{displacement:.6} {shown} {raw} 0x{flags:04X}")
        };
        let axes: Vec<String> = self.actuators.iter().enumerate().map(axis_words).collect();
        format!(
            "{:.0} {} {}",
            (rig.time() * 1e3).floor(),
            axes.join(" "),
            self.state(rig)
        )
    }

    pub(super) fn state(&self, rig: &EmulatedRig) -> &'static str {
        match (self.held, self.moves(rig)) {
            (true, _) => "HELD",
            (false, true) => "MOVING",
            (false, false) => "IDLE",
        }
    }

    /// The flags of all axes, combined.
    pub(super) fn all_flags(&self, rig: &EmulatedRig) -> u16 {
        (0..self.run.axes.len()).fold(0, |flags, axis| flags | self.flags(axis, false, rig))
    }

    fn flags(&self, axis: usize, saturated: bool, rig: &EmulatedRig) -> u16 {
        let (position, (low, high)) = (
            rig.commanded_of(self.actuators[axis]) * 1e3,
            self.run.axes[axis].displacement,
        );
        // A position on a limit is within it. The conversion to mm has rounding errors.
        let beyond = |excess: f64| excess > 1e-6;
        let bits = [
            saturated,
            false,
            beyond(position - high),
            beyond(low - position),
            false,
            !self.referenced,
            self.moves(rig),
            self.watchdog_tripped,
            rig.force_control(self.actuators[axis]).is_some(),
            rig.left_force_control(self.actuators[axis]) == Some(LeftForceControl::Band),
            rig.left_force_control(self.actuators[axis]) == Some(LeftForceControl::Cell),
        ];
        bits.iter()
            .rev()
            .fold(0, |word, bit| word << 1 | u16::from(*bit))
    }
}
