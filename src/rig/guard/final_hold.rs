//! The guard at the early end of a run. In: a rig that is to hold finally. Out: the result of that hold, and the limits of the motion
//! that unloads the rig afterwards. It assesses no reading, because the run is over.

use crate::{FinalHold, Guard, RigFault};
use psd_plan::{Interval, Limits, ReadingRules};

/// Number of standard deviations of the noise by which a reading may exceed the value at the hold.
const NOISE: f64 = 6.0;

impl Guard<'_> {
    /// Holds finally and gives the result, for a rig with moving parts. A proposed move is discarded.
    pub fn halt(&mut self) -> Option<FinalHold> {
        self.proposed = None;
        self.going.clear();
        let halted = self.rig.halt();
        if let Some(halted) = &halted {
            self.last_contact = halted.time;
        }
        halted
    }

    /// The limits of each axis.
    #[must_use]
    pub fn limits_of_axes(&self) -> Vec<Limits> {
        let of_axis = |axis| *self.own.get(axis).unwrap_or(&self.limits);
        (0..self.commanded.len()).map(of_axis).collect()
    }

    /// Extends the limits of each axis to the displacement \[m\] and the force \[N\] at which the rig holds, also those that the rig
    /// itself keeps. Otherwise the limit that ended the run would also end the motion that removes the load, and the wait before it.
    /// `rules` are those of the readings of each axis.
    ///
    /// # Errors
    /// The rig cannot be reached, or does not accept them.
    pub fn extend_limits(
        &mut self,
        (displacement, force): &(Vec<f64>, Vec<f64>),
        rules: impl Fn(usize) -> ReadingRules,
    ) -> Result<(), RigFault> {
        let before = self.limits_of_axes();
        let found = displacement.iter().zip(force);
        let extended: Vec<Limits> = before
            .iter()
            .zip(found)
            .enumerate()
            .map(|(axis, (limits, (x, r)))| {
                let ReadingRules {
                    resolution, noise, ..
                } = rules(axis);
                Limits {
                    displacement: extended(limits.displacement, *x, NOISE * resolution),
                    force: extended(limits.force, *r, NOISE * noise),
                    ..*limits
                }
            })
            .collect();
        if extended == before {
            return Ok(());
        }
        let set = self.rig.set_limits(&extended);
        self.or_hold(set)?;
        self.own = extended;
        Ok(())
    }
}

/// The same interval with `found` inside. Beyond it the margin is the distance of `found` from the limit, at least `noise`.
fn extended(Interval { low, high }: Interval, found: f64, noise: f64) -> Interval {
    Interval {
        low: low.min(found - (low - found).max(noise)),
        high: high.max(found + (found - high).max(noise)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_extended_to_what_was_found_and_a_margin_beyond_it() {
        let limit = Interval {
            low: -100.0,
            high: 400.0,
        };
        let with = |found| extended(limit, found, 6.0);
        let ends = |interval: Interval| (interval.low, interval.high);
        assert_eq!(ends(with(200.0)), (-100.0, 400.0), "far inside");
        assert_eq!(ends(with(433.0)), (-100.0, 466.0), "beyond by 33");
        assert_eq!(
            ends(with(401.0)),
            (-100.0, 407.0),
            "beyond by less than the noise"
        );
        assert_eq!(
            ends(with(399.0)),
            (-100.0, 405.0),
            "inside by less than the noise"
        );
        assert_eq!(ends(with(-110.0)), (-120.0, 400.0));
        let none = extended(Limits::NONE.force, 1.0, 6.0);
        assert!(!none.is_bounded(), "no limit stays none: {none:?}");
    }
}
