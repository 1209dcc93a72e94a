//! Motion of a real rig. In: a move that was offered. Out: the rig at its target and settled, or why not; readings on the
//! way. Every wait is bounded, sees a wish to hold, and keeps the devices hearing that the program lives.

use super::poll::Point;
use super::settle::Settling;
use super::{Part, Proposed, RealRig};
use crate::rig::device::SLICE;
use crate::rig::failpoint::{Guarding, on};
use crate::rig::{EachReading, LimitedQuantity, Rig as _, RigFault};

impl RealRig {
    /// Sends the offered move and waits until settled.
    pub(super) fn carry_out(&mut self) -> Result<(), RigFault> {
        let (target, seconds) = self.set_off()?;
        let arrival = self.clock.now() + seconds;
        let mut settling = Settling::new(self.settle, target);
        let mut rested = None;
        loop {
            let point = self.poll()?;
            let now = self.clock.now();
            self.watch(&point)?;
            // One that cannot say whether it moves, or says so before it has begun, is given the time that the way takes.
            let there = point.moving == Some(false) && settling.in_position(point.displacement);
            let rests = there || point.moving != Some(true) && now >= arrival;
            if rests {
                rested.get_or_insert(now);
            }
            let steady = rests && !point.unsettled;
            if !on(Guarding::Settling) && rests {
                return Ok(());
            }
            if settling.met(now, point.displacement, point.force, steady) {
                return Ok(());
            }
            if now - rested.unwrap_or(arrival) > self.settle.timeout {
                let error = (point.displacement - target).abs();
                return match rested {
                    Some(_) if settling.in_position(point.displacement) => Err(self.unsettled()),
                    Some(_) if on(Guarding::Following) => Err(RigFault::Following { error, band: self.settle.band }),
                    Some(_) => Ok(()),
                    None => Err(self.unsettled()),
                };
            }
            self.wait_until(now + self.period())?;
        }
    }

    /// Moves evenly to `targets` and gives `samples` readings at equal times on the way.
    pub(super) fn stroke(
        &mut self,
        targets: &[f64],
        velocity: f64,
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        let from = self.poll()?.displacement;
        self.propose(targets, Some(velocity.abs()))?;
        let ahead = targets.iter().all(|target| (target - from) * velocity > 0.0);
        if samples == 0 || !ahead {
            return Err(RigFault::Device(format!("a traverse at {velocity} m/s with {samples} samples leads nowhere")));
        }
        let (_, seconds) = self.set_off()?;
        let began = self.clock.now();
        #[expect(clippy::cast_precision_loss, reason = "far fewer samples than 2^53")]
        for sample in 1..=samples {
            let interval = seconds / samples as f64;
            let due = began + interval * sample as f64;
            self.stay_until(due)?;
            let late = self.clock.now() - due;
            if late > interval {
                let reason = format!("the readings cannot keep up: sample {sample} of {samples} came {late:.3} s late");
                return Err(RigFault::Device(reason));
            }
            each(self.reading_now()?)?;
        }
        let deadline = self.clock.now() + self.settle.timeout;
        while self.poll()?.moving == Some(true) {
            if self.clock.now() > deadline {
                return Err(self.unsettled());
            }
            self.wait_until(self.heard + self.period())?;
        }
        Ok(())
    }

    /// Stays until the moment `until` (s, by the clock), and asks often enough that the devices hear that the program
    /// lives.
    pub(super) fn stay_until(&mut self, until: f64) -> Result<(), RigFault> {
        loop {
            // Counted from when they were last heard: many short stays one after the other are a long one.
            let due = self.heard + self.link.watchdog / 4.0;
            if until < due {
                break;
            }
            self.wait_until(due)?;
            let point = self.poll()?;
            self.watch(&point)?;
        }
        self.wait_until(until)
    }

    /// Holds a reading on the way against the limits: the settled one would come too late. One alone may be a spike.
    fn watch(&mut self, point: &Point) -> Result<(), RigFault> {
        let displacement = (LimitedQuantity::MeasuredDisplacement, self.limits.displacement, point.displacement);
        let force = (LimitedQuantity::Force, self.limits.force, point.force);
        let breach = [displacement, force].into_iter().find(|(_, limit, value)| !limit.contains(*value));
        let again = std::mem::replace(&mut self.outside, breach.is_some());
        match breach {
            Some((quantity, limit, value)) if again && on(Guarding::ReadingLimits) => {
                Err(RigFault::LimitBreached { quantity, value, low: limit.low, high: limit.high })
            }
            _ => Ok(()),
        }
    }

    /// Waits without asking anything.
    pub(super) fn wait_until(&mut self, until: f64) -> Result<(), RigFault> {
        loop {
            if self.wish.wants_hold() {
                return Err(RigFault::Interrupted);
            }
            let left = until - self.clock.now();
            // A microsecond is nothing, and the rounding of a clock in nanoseconds is less.
            if left.is_nan() || left <= 1e-6 {
                return Ok(());
            }
            self.clock.sleep(left.min(SLICE));
        }
    }

    /// Sends the offered move. Gives its target (m) and the time the way takes, s.
    fn set_off(&mut self) -> Result<(f64, f64), RigFault> {
        let nothing = || RigFault::Device("nothing was proposed to execute".to_owned());
        let Proposed { going, target, from } = self.proposed.take().ok_or_else(nothing)?;
        self.actuator.start(&going).map_err(|fault| self.told(Part::Actuator, &fault))?;
        self.deaf = false;
        self.outside = false;
        self.look_up()?;
        Ok((target, (target - from).abs() / going.speed))
    }

    const fn unsettled(&self) -> RigFault {
        RigFault::NotSettled { timeout: self.settle.timeout }
    }
}
