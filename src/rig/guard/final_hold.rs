//! The guard at the early end of a run. In: a rig that is to hold finally. Out: the result of that hold, and the limits of the motion
//! that unloads the rig afterwards. It assesses no reading, because the run is over.

use crate::plan::{Interval, Limits};
use crate::rig::{FinalHold, Guard, RigFault};

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

    /// Limits of each axis for the motion back to the start: those of the plan, extended to the displacement \[m\] and the force \[N\] at
    /// which the rig holds. Otherwise the limit that ended the run would also end the motion that removes the load.
    #[must_use]
    pub fn limits_of_unloading(&self, (displacement, force): &(Vec<f64>, Vec<f64>)) -> Vec<Limits> {
        let noise = self.declared_noise();
        let of_axis = |(axis, (x, r)): (usize, (&f64, &f64))| {
            let limits = *self.own.get(axis).unwrap_or(&self.limits);
            Limits {
                displacement: extended(limits.displacement, *x, NOISE * noise.resolution),
                force: extended(limits.force, *r, NOISE * noise.force),
                ..limits
            }
        };
        let found = displacement.iter().zip(force);
        found.enumerate().map(of_axis).collect()
    }

    /// The limits from here on, one entry per axis, also those that the rig itself keeps.
    ///
    /// # Errors
    /// The rig cannot be reached, or does not accept them.
    pub fn set_limits(&mut self, limits: Vec<Limits>) -> Result<(), RigFault> {
        let set = self.rig.set_limits(&limits);
        self.or_hold(set)?;
        self.own = limits;
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
