//! One reading of a real rig. In: the replies of actuator and load cell. Out: displacement and force in the plan's
//! polarity, validated, with the bytes they were decoded from. An invalid reading is requested again a few times. It moves
//! nothing.

use super::median::representative;
use super::settle::Disturbed;
use super::validity::{Invalid, RawSample};
use super::{DeviceRole, RealRig};
use crate::controllers::{DeviceFault, Flags, Force, Sample};
use crate::safety::failpoint::{Guarding, on};
use crate::{Reading, RigFault, safety};
use psd_plan::Calibration;

/// Number of times an invalid reading is requested again.
pub(super) const REREADS: u32 = 3;

/// One usable reading, in the polarity of the plan.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Point {
    /// Rig time \[s\].
    pub(super) time: f64,
    /// One an axis \[m\].
    pub(super) displacement: Vec<f64>,
    /// One an axis \[N\].
    pub(super) force: Vec<f64>,
    /// Whether the actuator reports that it still moves.
    pub(super) moving: Option<bool>,
    /// A device reports that its reading has not settled.
    pub(super) unsettled: bool,
    /// Includes replies that were not valid readings.
    pub(super) raw: Vec<Vec<u8>>,
}

impl Point {
    pub(super) fn into_reading(self) -> Reading {
        let Self {
            time,
            displacement,
            force,
            raw,
            ..
        } = self;
        Reading {
            time,
            displacement,
            force,
            raw,
        }
    }
}

impl RealRig {
    /// Reads once, at rest or in motion.
    pub(super) fn poll(&mut self) -> Result<Point, RigFault> {
        let mut raw = Vec::new();
        let mut left = REREADS;
        loop {
            self.come_back()?;
            let asked = self.ask(&mut raw);
            if let Err(Unusable::Fault(fault)) = asked {
                return Err(fault);
            }
            self.look_up()?;
            match asked {
                Ok(point) => {
                    self.live.show(&point.displacement, &point.force);
                    return Ok(Point { raw, ..point });
                }
                Err(Unusable::AskAgain(_)) if left > 0 => {
                    left -= 1;
                    self.reread += 1;
                }
                Err(Unusable::Impossible(_))
                    if left > 0 && (self.moved || !on(Guarding::AtRest)) =>
                {
                    left -= 1;
                    self.reread += 1;
                }
                Err(Unusable::Impossible(fault)) if !self.moved => {
                    return Err(before_the_first_move(fault));
                }
                Err(
                    Unusable::AskAgain(fault)
                    | Unusable::Impossible(fault)
                    | Unusable::Fault(fault),
                ) => return Err(fault),
            }
        }
    }

    /// The median of as many readings as the plan requests. After settling at a target each of them must show all axes
    /// settled; otherwise the rig settles again and all readings are repeated.
    pub(super) fn settled_reading(&mut self) -> Result<Reading, RigFault> {
        let began = self.clock.now();
        let targets = self
            .settled
            .clone()
            .filter(|_| on(Guarding::Settling) && on(Guarding::Following));
        loop {
            let (points, disturbed) = self.readings_at(targets.as_deref())?;
            let reading = self.reading_of(points, began);
            let Some(targets) = targets
                .as_deref()
                .filter(|_| disturbed.is_some() || self.force_jumps(&reading))
            else {
                return Ok(reading);
            };
            self.reread += u64::from(disturbed.is_none());
            let now = self.clock.now();
            if now - began > self.settle.timeout {
                return Err(self.unsettled(disturbed.and_then(|disturbed| disturbed.astray)));
            }
            self.settle_at(targets, now)?;
        }
    }

    /// Up to the number of readings that the plan requests; ends at the first that shows an unsettled rig.
    fn readings_at(
        &mut self,
        targets: Option<&[f64]>,
    ) -> Result<(Vec<Point>, Option<Disturbed>), RigFault> {
        let mut points = Vec::new();
        for sample in 0..self.link.readings.samples.max(1) {
            if sample > 0 {
                self.wait_until(self.last_contact + self.period())?;
            }
            let point = self.poll()?;
            let disturbed = targets.and_then(|targets| self.disturbed(&point, targets));
            points.push(point);
            if disturbed.is_some() {
                return Ok((points, disturbed));
            }
        }
        Ok((points, None))
    }

    /// The median of each axis, at the time of the last reading, with the bytes of all readings.
    pub(super) fn reading_of(&self, mut points: Vec<Point>, began: f64) -> Reading {
        if points.len() == 1
            && let Some(point) = points.pop()
        {
            return point.into_reading();
        }
        let time = points.last().map_or(began - self.began, |point| point.time);
        let median = |of: fn(&Point) -> &[f64]| {
            let of_axis = |axis: usize| points.iter().map(|point| of(point)[axis]).collect();
            (0..self.axes.len())
                .map(|axis| representative(of_axis(axis)))
                .collect()
        };
        let (displacement, force) = (
            median(|point| &point.displacement),
            median(|point| &point.force),
        );
        Reading {
            time,
            displacement,
            force,
            raw: points.into_iter().flat_map(|point| point.raw).collect(),
        }
    }

    /// A reading during the motion: a single one, not a median.
    pub(super) fn reading_now(&mut self) -> Result<Reading, RigFault> {
        Ok(self.poll()?.into_reading())
    }

    /// Time between two polls \[s\].
    pub(super) fn period(&self) -> f64 {
        (1.0 / self.link.readings.rate).min(self.link.watchdog / 4.0)
    }

    /// Polls the devices again after other work.
    fn come_back(&mut self) -> Result<(), RigFault> {
        let now = self.clock.now();
        let away = now - std::mem::replace(&mut self.last_contact, now);
        self.check_line_gap(away)
    }

    /// The devices have answered, or were polled repeatedly: the longest gap between polls of a line is checked.
    pub(super) fn look_up(&mut self) -> Result<(), RigFault> {
        self.last_contact = self.clock.now();
        safety::beat();
        let away = self.stop_request.take_line_gap();
        self.check_line_gap(away)?;
        if self.stop_request.hold_requested() {
            Err(RigFault::Interrupted)
        } else {
            Ok(())
        }
    }

    /// After a gap longer than the watchdog \[s\] the rig holds automatically: its state is not the one that the program
    /// assumes.
    fn check_line_gap(&self, away: f64) -> Result<(), RigFault> {
        if on(Guarding::Away) && (away.is_nan() || away > self.link.watchdog) {
            return Err(RigFault::Device(format!(
                "psd did not poll the rig for {away:.1} s, longer than the watchdog's {} s; the run does not continue \
                 automatically",
                self.link.watchdog
            )));
        }
        Ok(())
    }

    fn ask(&mut self, raw: &mut Vec<Vec<u8>>) -> Result<Point, Unusable> {
        let moved = self.actuator.sample();
        let moved = self.sampled(DeviceRole::Actuator, moved, raw)?;
        let force_sample = match &mut self.load_cell {
            Some(cell) => {
                let force_sample = cell.sample();
                Some(self.sampled(DeviceRole::LoadCell, force_sample, raw)?)
            }
            None => None,
        };
        let force_sample = force_sample.as_ref().unwrap_or(&moved);
        let count = self.axes.len();
        let found = [&moved, force_sample].map(|sample| sample.channels.len());
        if found != [count; 2] {
            let found = found[0].min(found[1]);
            return Err(Unusable::Fault(RigFault::Device(format!(
                "the answer has {found} axes, but the rig has {count}"
            ))));
        }
        let time = self.clock.now() - self.began;
        let (displacement, force) = (Vec::with_capacity(count), Vec::with_capacity(count));
        let mut point = Point {
            time,
            displacement,
            force,
            moving: moved.moving,
            unsettled: false,
            raw: Vec::new(),
        };
        for index in 0..count {
            let (moved_axis, force_axis) = (moved.channels[index], force_sample.channels[index]);
            let lacks =
                |what: &str| Unusable::Fault(RigFault::Device(format!("the rig gives no {what}")));
            let displacement = moved_axis
                .displacement
                .ok_or_else(|| lacks("displacement"))?;
            let force_axis = if self.axes[index].has_own_load_cell {
                force_axis
            } else {
                moved_axis
            };
            let original = force_axis.force.ok_or_else(|| lacks("force"))?;
            let force = newtons(&self.axes[index].calibration, original)
                .ok_or_else(|| lacks("force in N: raw counts need a calibration"))?;
            let flags = either(moved_axis.flags, force_axis.flags);
            // All axes have one clock: it is checked with the first axis.
            let device_time = moved.time.filter(|_| index == 0);
            let raw_sample = RawSample {
                displacement,
                force,
                original,
                flags,
                device_time,
            };
            let axis = &mut self.axes[index];
            let judged = axis.validator.validate(&raw_sample, &axis.rules);
            point
                .displacement
                .push(axis.coordinate.in_plan(displacement));
            point.force.push(axis.coordinate.turned(force));
            point.unsettled |= flags.unsettled;
            judged.map_err(|invalid| self.refuse(invalid))?;
        }
        Ok(point)
    }

    /// Keeps the bytes, also those of an invalid reading.
    fn sampled(
        &mut self,
        part: DeviceRole,
        sample: Result<Sample, DeviceFault>,
        raw: &mut Vec<Vec<u8>>,
    ) -> Result<Sample, Unusable> {
        match sample {
            Ok(mut sample) => {
                raw.append(&mut sample.raw);
                Ok(sample)
            }
            Err(fault) => {
                let rig_fault = self.device_fault(part, &fault);
                Err(match fault {
                    DeviceFault::NoReading { raw: bytes, .. } => {
                        raw.push(bytes);
                        Unusable::AskAgain(rig_fault)
                    }
                    DeviceFault::Impossible { raw: bytes, .. } => {
                        raw.push(bytes);
                        Unusable::Impossible(rig_fault)
                    }
                    _ => Unusable::Fault(rig_fault),
                })
            }
        }
    }

    fn refuse(&mut self, invalid: Invalid) -> Unusable {
        match invalid {
            Invalid::AskAgain(reason) => Unusable::AskAgain(RigFault::Device(reason)),
            Invalid::Impossible(reason) => Unusable::Impossible(RigFault::Device(reason)),
            Invalid::Hold(reason) => Unusable::Fault(RigFault::Device(reason)),
            Invalid::Saturated(reason) => {
                let fault = RigFault::Device(reason);
                Unusable::Fault(if self.moved {
                    fault
                } else {
                    before_the_first_move(fault)
                })
            }
            Invalid::Untrusted(reason) => {
                self.untrusted = Some(reason.clone());
                Unusable::Fault(RigFault::Device(reason))
            }
        }
    }
}

/// \[N\], in the polarity of the cell.
pub(super) fn newtons(calibration: &Calibration, force: Force) -> Option<f64> {
    match force {
        Force::Newtons(force) => Some(force),
        #[expect(
            clippy::cast_precision_loss,
            reason = "converters have at most 32 bits"
        )]
        Force::Counts { count, .. } => calibration
            .newtons_per_count
            .map(|factor| (count as f64 - calibration.zero_offset) * factor),
    }
}

/// Why an answer is not a valid reading.
enum Unusable {
    AskAgain(RigFault),
    /// Requested again if the rig has moved; before the first move its readings cannot be trusted.
    Impossible(RigFault),
    Fault(RigFault),
}

/// The fault for a reading that a rig without faults never gives at rest. Nothing is sent to the rig.
fn before_the_first_move(fault: RigFault) -> RigFault {
    match fault {
        RigFault::Device(reason) => RigFault::Device(format!(
            "{reason}; nothing has moved: check unit, scale, register order and sensor"
        )),
        other => other,
    }
}

/// The flags of both devices.
const fn either(one: Flags, other: Flags) -> Flags {
    Flags {
        saturated: one.saturated || other.saturated,
        stale: one.stale || other.stale,
        limit_high: one.limit_high || other.limit_high,
        limit_low: one.limit_low || other.limit_low,
        emergency_stop: one.emergency_stop || other.emergency_stop,
        unreferenced: one.unreferenced || other.unreferenced,
        unsettled: one.unsettled || other.unsettled,
        watchdog_tripped: one.watchdog_tripped || other.watchdog_tripped,
        in_force_control: one.in_force_control || other.in_force_control,
        left_at_band: one.left_at_band || other.left_at_band,
        left_without_cell: one.left_without_cell || other.left_without_cell,
    }
}
