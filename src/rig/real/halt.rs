//! The last hold of a run that ends early. In: devices that may be deaf, or dead. Out: whether the rig was seen at rest after it was
//! told to hold, and where; every wait is bounded. What it is held for is not its business.

use super::{Part, RealRig};
use crate::rig::controllers::{DeviceFault, SLICE};
use crate::rig::safety;
use crate::rig::{Halted, RigFault};

/// A rig that was told to hold and still moves is waited for so long, s.
const COMES_TO_REST: f64 = 5.0;

/// Displacement (m) and force (N) of every axis, where they could be read, with their bytes.
type Found = (Option<(Vec<f64>, Vec<f64>)>, Vec<Vec<u8>>);

impl RealRig {
    /// Tells it to hold, and gives whether it heard; where that finds no ear, sends what needs no answer.
    pub(super) fn tell_to_hold(&mut self) -> Result<(), String> {
        self.wish.heed();
        (self.proposed, self.settled) = (None, None);
        self.axes.iter_mut().for_each(|axis| axis.way = None);
        if !self.deaf {
            let mut heard = self.actuator.hold();
            if heard == Err(DeviceFault::Interrupted) {
                // Another wish to hold, while it was being held.
                self.wish.heed();
                heard = self.actuator.hold();
            }
            let Err(fault) = heard else { return Ok(()) };
            self.unheard = self.told(Part::Actuator, &fault).to_string();
            self.deaf = true;
        }
        safety::hold_everything();
        Err(self.unheard.clone())
    }

    /// Tells it to hold, waits until it is seen at rest, and reads it once.
    pub(super) fn held_for_good(&mut self) -> Halted {
        let held = self.tell_to_hold().and_then(|()| self.until_at_rest());
        let (found, raw) = if held.is_ok() {
            self.reading_at_rest()
        } else {
            (None, Vec::new())
        };
        Halted {
            time: self.clock.now() - self.began,
            doubt: held.err(),
            found,
            raw,
        }
    }

    /// Until the actuator says that it does not move; of one that does not say so, until it is seen twice at one place.
    fn until_at_rest(&mut self) -> Result<(), String> {
        let began = self.clock.now();
        // At its own speed it would be several bands farther.
        let between = self
            .period()
            .max(4.0 * self.settle.band / self.link.own_speed)
            .min(1.0);
        let mut before: Option<Vec<f64>> = None;
        let mut last = "it still moves".to_owned();
        while self.clock.now() - began <= COMES_TO_REST {
            match self.actuator.sample() {
                Ok(sample) => {
                    let places: Vec<f64> = sample
                        .axes()
                        .map(|axis| axis.displacement.unwrap_or(f64::NAN))
                        .collect();
                    let stays = |before: &Vec<f64>| {
                        before
                            .iter()
                            .zip(&places)
                            .all(|(before, now)| (before - now).abs() <= self.settle.band)
                    };
                    if sample.moving == Some(false)
                        || sample.moving.is_none() && before.as_ref().is_some_and(stays)
                    {
                        return Ok(());
                    }
                    before = Some(places);
                    "it still moves".clone_into(&mut last);
                }
                Err(DeviceFault::Interrupted) => self.wish.heed(),
                Err(fault @ (DeviceFault::NoReading { .. } | DeviceFault::Impossible { .. })) => {
                    last = self.told(Part::Actuator, &fault).to_string();
                }
                Err(fault) => return Err(self.told(Part::Actuator, &fault).to_string()),
            }
            self.sleep(between);
        }
        Err(last)
    }

    /// Displacement (m) and force (N) of every axis where it stands, with their bytes.
    fn reading_at_rest(&mut self) -> Found {
        // However long it was silent before: what counts is that it answers now.
        self.heard = self.clock.now();
        let _ = self.wish.take_absence();
        let mut read = self.poll();
        if matches!(read, Err(RigFault::Interrupted)) {
            self.wish.heed();
            read = self.poll();
        }
        let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
        match read {
            Ok(point) if finite(&point.displacement) && finite(&point.force) => {
                (Some((point.displacement, point.force)), point.raw)
            }
            _ => (None, Vec::new()),
        }
    }

    /// Waits without heeding a wish: it is being heeded.
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
