//! A constant-velocity stroke of a real rig, with readings during the motion. In: a target, a velocity, the number of
//! readings requested. Out: as many readings as the line can carry, each with its own time and position, and the rig at
//! rest at the end of the stroke.

use super::motion::first_astray;
use super::{ProposedMove, RealRig};
use crate::safety::failpoint::{Guarding, on};
use crate::{CutOff, EachReading, Rig as _, RigFault};

/// Readings that a stroke must give at least, if more than one are requested.
const LEAST: usize = 2;

impl RealRig {
    /// Moves uniformly to `targets` and reads at up to `samples` equally spaced times. A time that passed while a reading
    /// was on the line is skipped: a late reading is made immediately, and not twice.
    pub(super) fn stroke(
        &mut self,
        targets: &[f64],
        velocity: f64,
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        if self.axes.len() > 1 {
            return Err(RigFault::Device(
                "the axes of a frame move to targets: they are not read during a motion".to_owned(),
            ));
        }
        self.propose(targets, Some(velocity.abs()))?;
        let ahead = self
            .proposed
            .as_ref()
            .is_some_and(|ProposedMove { targets, from, .. }| {
                (targets[0] - from[0]) * velocity > 0.0
            });
        if samples == 0 || !ahead {
            return Err(RigFault::Device(format!(
                "invalid stroke at {velocity} m/s with {samples} readings"
            )));
        }
        let (targets, seconds) = self.set_off()?;
        let began = self.clock.now();
        #[expect(clippy::cast_precision_loss, reason = "far fewer samples than 2^53")]
        let interval = seconds / samples as f64;
        let (mut sample, mut readings_done) = (1, 0);
        while sample <= samples {
            #[expect(clippy::cast_precision_loss, reason = "far fewer samples than 2^53")]
            let due = interval * sample as f64;
            self.stay_until(began + due)?;
            each(self.reading_now()?)?;
            readings_done += 1;
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "saturates, and ends the stroke"
            )]
            let passed = ((self.clock.now() - began) / interval).floor() as usize;
            sample = passed.max(sample + 1);
        }
        if readings_done < LEAST.min(samples) {
            let reason = format!(
                "the readings are too slow: {readings_done} in a stroke of {seconds:.3} s (required: {samples})"
            );
            return Err(RigFault::Device(reason));
        }
        self.come_to_rest(&targets, began + seconds)
    }

    /// The rest of a stroke, from the present position. At its end one late reading is made at rest, if any is left.
    pub(super) fn rest_of_stroke(
        &mut self,
        cut_off: &CutOff<'_>,
        velocity: f64,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        let (targets, left) = (cut_off.to, cut_off.left());
        self.propose(targets, Some(velocity.abs()))?;
        let travel = self
            .proposed
            .as_ref()
            .map_or(0.0, |ProposedMove { targets, from, .. }| {
                (targets[0] - from[0]) * velocity.signum()
            });
        if left > 0 && travel > self.settle.band {
            return self.stroke(targets, velocity, left, each);
        }
        self.carry_out()?;
        if left > 0 {
            each(self.reading_now()?)
        } else {
            Ok(())
        }
    }

    /// Waits at the end of a stroke until the rig is at rest there, so that the next one begins from rest. The settling of the force is
    /// not relevant for a stroke.
    fn come_to_rest(&mut self, targets: &[f64], arrival: f64) -> Result<(), RigFault> {
        let settling = self.settling(targets);
        let deadline = arrival + self.settle.timeout;
        loop {
            let point = self.poll()?;
            let now = self.clock.now();
            self.watch(&point)?;
            let rests = point.moving != Some(true) && now >= arrival;
            let astray = first_astray(&settling, &self.controlled(&point));
            let Some(axis) = astray.or((!rests).then_some(0)) else {
                return Ok(());
            };
            if now > deadline {
                return match rests {
                    true if on(Guarding::Following) => Err(self.following(axis, &point, targets)),
                    true => Ok(()),
                    false => Err(self.unsettled(None)),
                };
            }
            self.wait_until(self.last_contact + self.period())?;
        }
    }
}
