//! The readings of the native firmware: medians of forces, displacements, state and flags. In: the bench. Out: the words of an answer.
//! They move nothing.

use super::Native;
use crate::emulator::Bench;

impl Native {
    /// Returns the medians of several readings.
    pub(super) fn measure(&self, count: usize, bench: &mut Bench) -> String {
        let told = |(axis, ram): (usize, &usize)| {
            let ram = *ram;
            let mut forces: Vec<f64> = (0..count).map(|_| bench.force_of(ram)).collect();
            forces.sort_by(f64::total_cmp);
            let force = f64::midpoint(forces[(count - 1) / 2], forces[count / 2]);
            let raw = bench.counts_of(force);
            let displacement = bench.displacement_of(ram) * 1e3;
            let shown = bench.shown_force(ram, format!("{force:.3}"));
            let flags = self.flags(axis, !(-8_388_607..8_388_607).contains(&raw), bench);
            format!("{displacement:.6} {shown} {raw} 0x{flags:04X}")
        };
        let axes: Vec<String> = self.rams.iter().enumerate().map(told).collect();
        format!(
            "{:.0} {} {}",
            (bench.time() * 1e3).floor(),
            axes.join(" "),
            self.state(bench)
        )
    }

    pub(super) fn state(&self, bench: &Bench) -> &'static str {
        match (self.held, self.moves(bench)) {
            (true, _) => "HELD",
            (false, true) => "MOVING",
            (false, false) => "IDLE",
        }
    }

    /// The flags of all axes, combined.
    pub(super) fn all_flags(&self, bench: &Bench) -> u16 {
        (0..self.run.axes.len()).fold(0, |flags, axis| flags | self.flags(axis, false, bench))
    }

    fn flags(&self, axis: usize, saturated: bool, bench: &Bench) -> u16 {
        let (position, (low, high)) = (
            bench.commanded_of(self.rams[axis]) * 1e3,
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
            self.moves(bench),
            self.watchdog_tripped,
        ];
        bits.iter()
            .rev()
            .fold(0, |word, bit| word << 1 | u16::from(*bit))
    }
}
