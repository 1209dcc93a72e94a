//! Continuous motion of a real rig along smooth paths, read during the motion and not stopped at its end. In: a path per
//! axis, the number of readings requested. Out: as many readings as the line can carry, each with its own time and
//! position, the last at the end or immediately after it. The rig itself reports when a path ends, so that two clocks do
//! not diverge over a long run.

use super::RealRig;
use super::{DeviceRole, WIRE_ROUNDING};
use crate::controllers::metres;
use crate::safety::failpoint::{Guarding, on};
use crate::{EachReading, Reading, Rig as _, RigFault, named_axis};
use psd_physics::tracking::trajectory::Path;

impl RealRig {
    /// Follows `paths` and reads at up to `samples` equally spaced times, the last at their end. A time that passed during an earlier
    /// reading is omitted.
    pub(super) fn follow(
        &mut self,
        paths: &[Path],
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        self.proposed = None;
        self.axes
            .iter_mut()
            .for_each(|axis| axis.allowed_range = None);
        if let Some(reason) = &self.untrusted {
            return Err(RigFault::Device(format!("no further motion: {reason}")));
        }
        if self.axes.iter().any(|axis| axis.axial.is_some()) {
            return Err(RigFault::Device(
                "no continuous motion beside an axis in force control".to_owned(),
            ));
        }
        let seconds = paths.first().map_or(0.0, |path| path.seconds);
        let together = paths
            .iter()
            .all(|path| path.seconds.to_bits() == seconds.to_bits());
        if samples == 0
            || paths.len() != self.axes.len()
            || !together
            || !(seconds > 0.0 && seconds.is_finite())
        {
            let reason = format!(
                "{} invalid paths of {seconds} s with {samples} readings",
                paths.len()
            );
            return Err(RigFault::Device(reason));
        }
        let end = self.begin(paths)?;
        let mut sample = 1;
        loop {
            #[expect(clippy::cast_precision_loss, reason = "far fewer samples than 2^53")]
            let due = end - seconds * (samples - sample) as f64 / samples as f64;
            self.stay_until(due)?;
            let reading = self.reading_now()?;
            if sample == samples {
                self.keeps_up(paths, &reading)?;
                return each(reading);
            }
            each(reading)?;
            #[expect(clippy::cast_precision_loss, reason = "far fewer samples than 2^53")]
            let passed = (self.clock.now() - (end - seconds)) / seconds * samples as f64;
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "saturates, and ends the way"
            )]
            let passed = passed.floor() as usize;
            sample = (passed + 1).max(sample + 1).min(samples);
        }
    }

    /// The rest of an interrupted motion. The rig has passed it or holds on it, and cannot continue at its former velocity:
    /// it moves to the end as to any target, and one late reading is made there at rest, if any is left.
    pub(super) fn rest_of_path(
        &mut self,
        paths: &[Path],
        left: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        let ends: Vec<f64> = paths.iter().map(|path| path.to).collect();
        self.propose(&ends, None)?;
        self.carry_out()?;
        if left > 0 {
            each(self.reading_now()?)
        } else {
            Ok(())
        }
    }

    /// Sends the paths. Gives the time of their end \[s\], by the clock.
    fn begin(&mut self, paths: &[Path]) -> Result<f64, RigFault> {
        let turned = |(axis, path): (&super::Axis, &Path)| Path {
            from: axis.coordinate.at_device(path.from),
            to: axis.coordinate.at_device(path.to),
            start_velocity: axis.coordinate.turned(path.start_velocity),
            end_velocity: axis.coordinate.turned(path.end_velocity),
            seconds: path.seconds,
        };
        let turned: Vec<Path> = self.axes.iter().zip(paths).map(turned).collect();
        let going = self
            .actuator
            .encode_path(&turned)
            .map_err(|fault| self.device_fault(DeviceRole::Actuator, &fault))?;
        let ends = going.targets.iter().zip(&turned);
        let apt = |(axis, (encoded, path)): (&super::Axis, (&f64, &Path))| {
            (encoded - path.to).abs()
                <= WIRE_ROUNDING.max(axis.rules.resolution / 2.0) * (1.0 + 1e-6)
        };
        if on(Guarding::WireNumber)
            && (going.targets.len() != paths.len() || !self.axes.iter().zip(ends).all(apt))
        {
            let ends: Vec<f64> = turned.iter().map(|path| path.to).collect();
            let [asked, encoded] = [&ends, &going.targets].map(|ends| metres(ends));
            return Err(RigFault::Device(format!(
                "requested: {asked}; encoded: {encoded}; not sent"
            )));
        }
        self.moved = true;
        let left = self
            .actuator
            .start_path(&going)
            .map_err(|fault| self.device_fault(DeviceRole::Actuator, &fault))?;
        (self.deaf, self.settled, self.broken) = (false, None, None);
        self.look_up()?;
        Ok(self.clock.now() + left)
    }

    /// Whether every axis follows its path. An axis does not follow if it lags by more than its whole travel on this path and the
    /// previous one. The tracking limits check the effect of a lag on the test.
    fn keeps_up(&mut self, paths: &[Path], reading: &Reading) -> Result<(), RigFault> {
        let count = self.axes.len();
        for (index, (axis, path)) in self.axes.iter_mut().zip(paths).enumerate() {
            let (low, high) = path.reach();
            let span = high - low;
            let band = self.settle.band + span + std::mem::replace(&mut axis.span, span);
            let error = (reading.displacement[index] - path.to).abs();
            if on(Guarding::Following) && (error.is_nan() || error > band) {
                return Err(RigFault::Following {
                    error,
                    band,
                    axis: named_axis(index, count),
                });
            }
        }
        Ok(())
    }
}
