//! Readings at rest: each inside its limits and, after settling, near its target. In: the request of a procedure. Out: a
//! reading, or the rig on hold.

use super::outside;
use crate::safety::failpoint::{Guarding, on};
use crate::{Guard, LimitedQuantity, Reading, RigFault};

impl Guard<'_> {
    /// Reads once.
    ///
    /// # Errors
    /// The reading is outside a limit or not finite, or the rig fails.
    pub fn read(&mut self) -> Result<Reading, RigFault> {
        let read = self.rig.read();
        let mut reading = self.or_hold(read)?;
        self.checked(&mut reading)?;
        Ok(reading)
    }

    /// The same, with the time of the last move: start and end of the equivalent uniform motion \[s\].
    ///
    /// # Errors
    /// As [`Guard::read`].
    pub fn read_moved(&mut self) -> Result<(Reading, Option<[f64; 2]>), RigFault> {
        let read = self.rig.read_moved();
        let (mut reading, moved) = self.or_hold(read)?;
        self.checked(&mut reading)?;
        Ok((reading, moved))
    }

    /// Checks a reading at rest. The entries of axial axes are taken out of it.
    pub(super) fn checked(&mut self, reading: &mut Reading) -> Result<(), RigFault> {
        self.last_contact = reading.time;
        let of_axial = self.axial.take(reading, true).map_or(Ok(()), Err);
        let checked = self
            .check_limits_and_tracking(reading)
            .and_then(|()| self.or_hold(of_axial));
        checked.inspect_err(|_| {
            self.broken = Some(reading.clone()).filter(Reading::is_finite);
        })
    }

    fn check_limits_and_tracking(&mut self, reading: &Reading) -> Result<(), RigFault> {
        self.check_reading(reading)?;
        if self.settled {
            let errors = reading.displacement.iter().zip(&self.commanded);
            let errors = errors.map(|(measured, target)| (measured - target).abs());
            let limit = self.limits.tracking_error;
            let beyond = (0..).zip(errors).find(|(_, error)| !limit.contains(*error));
            if let Some((index, error)) = beyond {
                return Err(self.breach(LimitedQuantity::TrackingError, Some(index), limit, error));
            }
            if let Some(holds) = &mut self.holds {
                holds.see(&self.commanded, reading);
            }
        }
        Ok(())
    }

    /// The reading that exceeded a limit, at rest or during a motion, given only once.
    pub fn take_broken(&mut self) -> Option<Reading> {
        self.broken.take()
    }

    fn check_reading(&mut self, reading: &Reading) -> Result<(), RigFault> {
        let found =
            outside(&self.limits, &self.own, reading).filter(|_| on(Guarding::ReadingLimits));
        let checked = found.map_or(Ok(()), Err);
        self.or_hold(checked)
    }
}
