//! The virtual rig along a stroke: one axis at constant velocity, read during the motion. In: its ends at the rig and its velocity. Out:
//! readings. It knows no plan.

use super::VirtualRig;
use crate::{EachReading, Rig as _, RigFault};

/// A uniform motion between two positions at the rig.
#[derive(Clone, Copy)]
pub(super) struct Stroke {
    /// \[m\]
    pub from: f64,
    pub aim: f64,
    /// As the plan counts it \[m/s\].
    pub velocity: f64,
}

impl VirtualRig {
    /// The readings of a stroke, of which some may be done.
    pub(super) fn stroke(
        &mut self,
        stroke: Stroke,
        samples: usize,
        done: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        let Stroke {
            from,
            aim,
            velocity,
        } = stroke;
        let seconds = (aim - from) / (self.sign * velocity);
        if samples == 0 || !(seconds > 0.0 && seconds.is_finite()) {
            return Err(RigFault::Device(format!(
                "invalid stroke at {velocity} m/s with {samples} readings"
            )));
        }
        #[expect(clippy::cast_precision_loss, reason = "far fewer samples than 2^53")]
        let fraction = |sample: usize| sample as f64 / samples as f64;
        #[expect(clippy::cast_precision_loss, reason = "the same")]
        let each_takes = seconds / samples as f64;
        let began = self.time - seconds * fraction(done);
        for sample in done + 1..=samples {
            let to = if sample == samples {
                aim
            } else {
                from + (aim - from) * fraction(sample)
            };
            let actuator = &mut self.axes[0].actuator;
            let travel = if sample == done + 1
                && done_already(
                    to - actuator.reference(),
                    (aim - from) / seconds * each_takes,
                ) {
                actuator.pass((aim - from) / seconds)
            } else {
                actuator.advance(to, each_takes)
            };
            self.time = began + seconds * fraction(sample);
            self.travels.clear();
            self.travels.push(travel);
            self.follow();
            let reading = self.reading();
            if let Err(refused) = each(reading) {
                self.hold();
                return Err(refused);
            }
        }
        self.axes[0].actuator.stop();
        Ok(())
    }
}

/// Whether a stroke was interrupted exactly when its next reading was due, one step \[m\] after the previous one: the piston is then `off`
/// \[m\] its position by rounding only, and that reading is repeated during the motion.
fn done_already(off: f64, step: f64) -> bool {
    off.abs() < 1e-6 * step.abs()
}
