//! The final hold of a run that ends early. In: devices that may not answer. Out: whether the rig was seen at rest after
//! the command, and where. Every wait is bounded. The reason of the hold is not known here.

use super::{DeviceRole, RealRig};
use crate::controllers::{DeviceFault, SLICE};
use crate::safety;
use crate::{FinalHold, RigFault};

/// Longest wait for a rig that still moves after the command to hold \[s\].
const COMES_TO_REST: f64 = 5.0;

/// Readings at rest of which the median is taken: a single one may be a spike.
pub(super) const READINGS: usize = 3;

/// Displacement \[m\] and force \[N\] of every axis, if they could be read, with their bytes.
type Found = (Option<(Vec<f64>, Vec<f64>)>, Vec<Vec<u8>>);

impl RealRig {
    /// Commands a hold and gives whether a device confirmed it. Without a confirmation, sends the bytes that need no
    /// answer.
    pub(super) fn command_hold(&mut self) -> Result<(), String> {
        self.stop_request.acknowledge();
        (self.proposed, self.settled) = (None, None);
        self.axes
            .iter_mut()
            .for_each(|axis| axis.allowed_range = None);
        if !self.deaf {
            let mut confirmed = self.actuator.hold();
            if confirmed == Err(DeviceFault::Interrupted) {
                // Another request to hold, while the hold was in progress.
                self.stop_request.acknowledge();
                confirmed = self.actuator.hold();
            }
            let Err(fault) = confirmed else { return Ok(()) };
            self.hold_failure = self.device_fault(DeviceRole::Actuator, &fault).to_string();
            self.deaf = true;
        }
        safety::hold_everything();
        Err(self.hold_failure.clone())
    }

    /// Commands a hold, waits until the rig is seen at rest, and reads it there.
    pub(super) fn hold_finally(&mut self) -> FinalHold {
        let held = self.command_hold().and_then(|()| self.until_at_rest());
        let (found, raw) = if held.is_ok() {
            self.reading_at_rest()
        } else {
            (None, Vec::new())
        };
        FinalHold {
            time: self.clock.now() - self.began,
            unconfirmed: held.err(),
            found,
            raw,
        }
    }

    /// Waits until the actuator reports that it does not move; an actuator that does not report this must be seen twice at
    /// one position.
    fn until_at_rest(&mut self) -> Result<(), String> {
        let began = self.clock.now();
        // At its own speed it would move by several bands in this time.
        let between = self
            .period()
            .max(4.0 * self.settle.band / self.link.own_speed)
            .min(1.0);
        let mut before: Option<Vec<f64>> = None;
        let mut last = "it is still moving".to_owned();
        while self.clock.now() - began <= COMES_TO_REST {
            match self.actuator.sample() {
                Ok(sample) => {
                    let positions: Vec<f64> = sample
                        .channels
                        .iter()
                        .map(|axis| axis.displacement.unwrap_or(f64::NAN))
                        .collect();
                    let stays = |before: &Vec<f64>| {
                        before
                            .iter()
                            .zip(&positions)
                            .all(|(before, now)| (before - now).abs() <= self.settle.band)
                    };
                    if sample.moving == Some(false)
                        || sample.moving.is_none() && before.as_ref().is_some_and(stays)
                    {
                        return Ok(());
                    }
                    before = Some(positions);
                    "it is still moving".clone_into(&mut last);
                }
                Err(DeviceFault::Interrupted) => self.stop_request.acknowledge(),
                Err(fault @ (DeviceFault::NoReading { .. } | DeviceFault::Impossible { .. })) => {
                    last = self.device_fault(DeviceRole::Actuator, &fault).to_string();
                }
                Err(fault) => {
                    return Err(self.device_fault(DeviceRole::Actuator, &fault).to_string());
                }
            }
            self.sleep(between);
        }
        Err(last)
    }

    /// Displacement \[m\] and force \[N\] of every axis at rest, with their bytes.
    fn reading_at_rest(&mut self) -> Found {
        // Earlier silence does not matter: the device answers now.
        self.last_contact = self.clock.now();
        let _ = self.stop_request.take_line_gap();
        let began = self.last_contact;
        let mut points = Vec::new();
        for reading in 0..READINGS {
            if reading > 0 {
                self.sleep(self.period());
            }
            let mut read = self.poll();
            if matches!(read, Err(RigFault::Interrupted)) {
                self.stop_request.acknowledge();
                read = self.poll();
            }
            let Ok(point) = read else { break };
            points.push(point);
        }
        if points.is_empty() {
            return (None, Vec::new());
        }
        match self.reading_of(points, began) {
            reading if reading.is_finite() => {
                (Some((reading.displacement, reading.force)), reading.raw)
            }
            _ => (None, Vec::new()),
        }
    }

    /// Waits without observing a stop request, because the request is already being executed.
    fn sleep(&mut self, seconds: f64) {
        let until = self.clock.now() + seconds;
        loop {
            let left = until - self.clock.now();
            if left.is_nan() || left <= 1e-6 {
                return;
            }
            self.clock.sleep(left.min(SLICE));
        }
    }
}
