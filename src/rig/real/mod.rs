//! A rig that moves a real specimen. In: one target per axis, and the devices. Out: settled readings in the polarity of the
//! plan, validated axis by axis; a fault of one axis holds all. It knows no protocol and no procedure; the guard decides
//! which motions are allowed.

mod coordinate;
mod halt;
mod median;
mod motion;
mod open;
mod path;
mod poll;
mod replies;
mod settle;
mod stroke;
mod validity;

use psd_physics::tracking::trajectory::Path;
use psd_plan::{AxialAxis, Calibration, Interval, Limits, ReadingRules, RealLink, Settle};
use psd_text::count::counted_in_words;

use super::controllers::{Device, DeviceFault, DeviceMove, metres};
use super::motion::from_positions;
use super::safety::failpoint::{Guarding, on};
use super::transport::Clock;
use super::{
    CutOff, DeclaredNoise, EachReading, EncodedMove, FinalHold, Identity, LastMove, LineStatistics,
    Live, Reading, Rig, RigFault, StopRequest, named_axis, who,
};
use coordinate::Coordinate;
pub use open::commands_only;
use poll::Point;
pub use replies::{LoggedReading, check_replies};
use validity::ReadingValidator;

/// The rounding of six decimals of a millimetre \[m\].
const WIRE_ROUNDING: f64 = 0.5e-9;
/// The rounding of three decimals of a newton \[N\].
const WIRE_ROUNDING_OF_FORCE: f64 = 0.5e-3;

/// Actuators with their load cells.
pub struct RealRig {
    link: RealLink,
    settle: Settle,
    axes: Vec<Axis>,
    identity: Identity,
    /// The replies with the identity of its devices.
    introduction: Vec<Vec<u8>>,
    actuator: Box<dyn Device>,
    load_cell: Option<Box<dyn Device>>,
    clock: Box<dyn Clock>,
    stop_request: StopRequest,
    /// Time of the clock at opening \[s\].
    began: f64,
    /// Time of the last answer of the devices \[s\], by the clock.
    last_contact: f64,
    proposed: Option<ProposedMove>,
    /// The position where it has settled \[m\], or the force in force control \[N\]. None during a motion, and after a motion without settling.
    settled: Option<Vec<f64>>,
    /// For each axis, the start of the dwell in which it settled \[s\] and its median force \[N\].
    rested: Vec<Option<(f64, f64)>>,
    /// Mean observed speed of the last move \[m/s\].
    seen_speed: Option<f64>,
    /// The reading that exceeded a limit during the last motion.
    broken: Option<Reading>,
    /// Observed times (\[s\], by the clock) and positions \[m\] of the first axis during the last move.
    seen_positions: Vec<(f64, f64)>,
    reread: u64,
    /// It has moved since it was opened.
    moved: bool,
    /// Why its position cannot be trusted.
    untrusted: Option<String>,
    /// The hold command was not received: only the bytes that need no answer are left.
    deaf: bool,
    /// The reason why the hold command was not received.
    hold_failure: String,
    /// Publishes readings as they are made.
    live: Live,
}

/// One actuator with its load cell.
struct Axis {
    /// Conversion of displacement and force between the devices and the plan.
    coordinate: Coordinate,
    limits: Limits,
    rules: ReadingRules,
    calibration: Calibration,
    /// A device other than the actuator measures its force.
    has_own_load_cell: bool,
    /// Its targets are forces \[N\].
    axial: Option<AxialAxis>,
    validator: ReadingValidator,
    /// The last reading during the motion was outside a limit.
    outside: bool,
    /// Distance between the extreme positions of the last path \[m\]. 0 after a move.
    span: f64,
    /// The range between the start and the target of the move, with the possible overshoot of an actuator \[m\]; in force control with the
    /// tolerance \[N\]. None on a path.
    allowed_range: Option<Interval>,
    /// The last reading during the motion was outside this range.
    off: bool,
}

/// A move that was proposed and not yet sent.
#[derive(Clone, Debug)]
struct ProposedMove {
    going: DeviceMove,
    /// \[m\], or \[N\] in force control, in the polarity of the plan.
    targets: Vec<f64>,
    /// The same quantity at the time of the proposal.
    from: Vec<f64>,
}

impl Axis {
    /// A target of the plan in the coordinate of the device.
    fn target_at_device(&self, target: f64) -> f64 {
        match self.axial {
            Some(_) => self.coordinate.turned(target),
            None => self.coordinate.at_device(target),
        }
    }

    /// A target of the device in the coordinate of the plan.
    fn target_in_plan(&self, target: f64) -> f64 {
        match self.axial {
            Some(_) => self.coordinate.turned(target),
            None => self.coordinate.in_plan(target),
        }
    }

    /// Distance of an encoded target from the requested one that its frame causes: \[m\] or \[N\].
    fn wire_rounding(&self) -> f64 {
        match self.axial {
            Some(_) => WIRE_ROUNDING_OF_FORCE,
            None => WIRE_ROUNDING.max(self.rules.resolution / 2.0),
        }
    }

    /// What the controller holds of an axis at this displacement \[m\] with this force \[N\].
    const fn controlled(&self, displacement: f64, force: f64) -> f64 {
        match self.axial {
            Some(_) => force,
            None => displacement,
        }
    }
}

impl RealRig {
    /// Whether its position and readings can be trusted: no device restarted or lost its reference.
    #[must_use]
    pub const fn trusted(&self) -> bool {
        self.untrusted.is_none()
    }

    /// Publishes its readings as they are made, also during a motion.
    #[must_use]
    pub fn live(&self) -> Live {
        self.live.clone()
    }

    /// The displacements that the rig itself allows, in the plan's coordinate \[m\], one per axis. None: it does not report them.
    #[must_use]
    pub fn reported_range(&self) -> Option<Vec<Interval>> {
        let ranges = self.actuator.reported_range()?;
        let turned = |(axis, range): (&Axis, &Interval)| {
            let ends = [range.low, range.high].map(|end| axis.coordinate.in_plan(end));
            Interval {
                low: ends[0].min(ends[1]),
                high: ends[0].max(ends[1]),
            }
        };
        Some(self.axes.iter().zip(&ranges).map(turned).collect())
    }

    /// Targets of the devices, one per axis, in the plan's coordinate.
    fn in_plan(&self, targets: &[f64]) -> Vec<f64> {
        self.axes
            .iter()
            .zip(targets)
            .map(|(axis, target)| axis.target_in_plan(*target))
            .collect()
    }

    /// What the controllers hold, one per axis: displacements \[m\], then forces in force control \[N\].
    fn controlled(&self, point: &Point) -> Vec<f64> {
        let readings = point.displacement.iter().zip(&point.force);
        let each = self.axes.iter().zip(readings);
        each.map(|(axis, (displacement, force))| axis.controlled(*displacement, *force))
            .collect()
    }

    /// An axis whose controller does not hold the force is loaded from zero alone: psd applies no load again that a controller has left.
    fn loaded_from_zero(&self, targets: &[f64]) -> Result<(), RigFault> {
        let enters_loaded = |(axis, target): (&Axis, &f64)| {
            axis.axial.is_some_and(|axial| {
                !axis.validator.is_in_force_control() && target.abs() > axial.tolerance
            })
        };
        match self.axes.iter().zip(targets).position(enters_loaded) {
            None => Ok(()),
            Some(index) => Err(RigFault::Device(format!(
                "{} does not hold its axial force, and psd does not apply it again",
                who(named_axis(index, self.axes.len()))
            ))),
        }
    }

    /// A fault of a device as a fault of the rig.
    fn device_fault(&mut self, part: DeviceRole, fault: &DeviceFault) -> RigFault {
        let (role, behind, faulty_member) = match (part, &self.load_cell) {
            (DeviceRole::LoadCell, Some(cell)) => {
                ("load cell", self.link.load_cells(), cell.faulty_member())
            }
            _ => (
                "actuator",
                self.link.actuators(),
                self.actuator.faulty_member(),
            ),
        };
        // Among several devices, the faulty one; the first if the faulty one is not known.
        let device = behind.get(faulty_member.unwrap_or(0)).map_or_else(
            || role.to_owned(),
            |behind| format!("{} on {}", behind.name(role), behind.link.port),
        );
        let message = format!("{device}: {fault}");
        match fault {
            DeviceFault::Interrupted => return RigFault::Interrupted,
            DeviceFault::Rebooted { .. } => self.untrusted = Some(message.clone()),
            _ => {}
        }
        RigFault::Device(message)
    }

    /// Holds where `result` is a fault.
    fn or_hold<T>(&mut self, result: Result<T, RigFault>) -> Result<T, RigFault> {
        if result.is_err() {
            self.hold();
        }
        result
    }
}

/// Formatted for a sentence.
fn degrees_of_freedom(count: usize) -> String {
    counted_in_words(count, "degree of freedom", "degrees of freedom")
}

/// What a device of the rig does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum DeviceRole {
    Actuator,
    LoadCell,
}

impl Rig for RealRig {
    fn identity(&self) -> Identity {
        self.identity.clone()
    }

    fn introduction(&self) -> Vec<Vec<u8>> {
        self.introduction.clone()
    }

    fn degrees_of_freedom(&self) -> usize {
        self.axes.len()
    }

    fn time(&self) -> f64 {
        self.clock.now() - self.began
    }

    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<EncodedMove, RigFault> {
        self.proposed = None;
        if let Some(reason) = &self.untrusted {
            return Err(RigFault::Device(format!("no further motion: {reason}")));
        }
        if targets.len() != self.axes.len() {
            let reason = format!(
                "this rig has {}, not {}",
                degrees_of_freedom(self.axes.len()),
                targets.len()
            );
            return Err(RigFault::Device(reason));
        }
        if let Some(target) = targets.iter().find(|target| !target.is_finite()) {
            return Err(RigFault::Device(format!("invalid target: {target} m")));
        }
        self.loaded_from_zero(targets)?;
        let speed = speed.unwrap_or(self.link.own_speed);
        // Polled before the bytes are made, because nothing is polled between them and their sending. The status flags may
        // be a reason to hold, as with any reading.
        let polled = self.poll();
        let polled = self.or_hold(polled)?;
        let from = self.controlled(&polled);
        let turned: Vec<f64> = self
            .axes
            .iter()
            .zip(targets)
            .map(|(axis, target)| axis.target_at_device(*target))
            .collect();
        let going = self
            .actuator
            .encode(&turned, speed)
            .map_err(|fault| self.device_fault(DeviceRole::Actuator, &fault))?;
        let encoded = self.in_plan(&going.targets);
        // A first target that is rounded is settled at where it was sent.
        let (rounding, settles_at) = if self.actuator.rounds_first_target() {
            (self.settle.band / 2.0, encoded.clone())
        } else {
            (0.0, targets.to_vec())
        };
        // The resolution of the devices bounds how close the decoded target can be.
        let apt = |(axis, (encoded, target)): (&Axis, (&f64, &f64))| {
            let allowed = axis.wire_rounding().max(rounding) * (1.0 + 1e-6);
            (encoded - target).abs() <= allowed
        };
        let apt = going.speed > 0.0
            && going.speed.is_finite()
            && encoded.len() == targets.len()
            && self.axes.iter().zip(encoded.iter().zip(targets)).all(apt);
        if on(Guarding::WireNumber) && !apt {
            let [asked, encoded] = [targets, &encoded].map(metres);
            let reason = format!(
                "requested: {asked}; encoded: {encoded} at {} m/s; not sent",
                going.speed
            );
            return Err(RigFault::Device(reason));
        }
        let at_the_rig = self
            .axes
            .iter()
            .any(|axis| axis.coordinate.datum != 0.0)
            .then(|| going.targets.clone());
        let propose = EncodedMove {
            targets: encoded,
            speed: going.speed,
            wire: going.frames.concat(),
            move_id: going.id,
            at_the_rig,
        };
        self.proposed = Some(ProposedMove {
            going,
            targets: settles_at,
            from,
        });
        Ok(propose)
    }

    fn execute(&mut self) -> Result<(), RigFault> {
        let executed = self.carry_out();
        self.or_hold(executed)
    }

    fn pause(&mut self, seconds: f64) -> Result<(), RigFault> {
        let paused = self.stay_until(self.clock.now() + seconds);
        self.or_hold(paused)
    }

    fn read(&mut self) -> Result<Reading, RigFault> {
        let read = self.settled_reading();
        self.or_hold(read)
    }

    fn read_moved(&mut self) -> Result<(Reading, Option<[f64; 2]>), RigFault> {
        let moved =
            from_positions(&self.seen_positions).map(|ends| ends.map(|end| end - self.began));
        Ok((self.read()?, moved))
    }

    fn traverse(
        &mut self,
        targets: &[f64],
        velocity: f64,
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        let traversed = self.stroke(targets, velocity, samples, each);
        self.or_hold(traversed)
    }

    fn traverse_on(
        &mut self,
        cut_off: &CutOff<'_>,
        velocity: f64,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        let traversed = self.rest_of_stroke(cut_off, velocity, each);
        self.or_hold(traversed)
    }

    fn follow_paths(
        &mut self,
        paths: &[Path],
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        let followed = self.follow(paths, samples, each);
        self.or_hold(followed)
    }

    fn resume_paths(
        &mut self,
        paths: &[Path],
        samples: usize,
        done: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        let followed = self.rest_of_path(paths, samples.saturating_sub(done), each);
        self.or_hold(followed)
    }

    /// Sends the hold command, and without a confirmation the bytes that need no answer.
    fn hold(&mut self) {
        // Whether it was received is reported at the end of the run.
        let _ = self.command_hold();
    }

    fn halt(&mut self) -> Option<FinalHold> {
        Some(self.hold_finally())
    }

    fn set_limits(&mut self, limits: &[Limits]) -> Result<(), RigFault> {
        for (axis, limits) in self.axes.iter_mut().zip(limits) {
            axis.limits = *limits;
        }
        self.note_contact();
        let sent = self.send_limits();
        self.note_contact();
        self.or_hold(sent)
    }

    fn datum(&self) -> Option<Vec<f64>> {
        Some(self.axes.iter().map(|axis| axis.coordinate.datum).collect())
    }

    fn own_speed(&self) -> Option<f64> {
        Some(self.link.own_speed)
    }

    fn take_broken(&mut self) -> Option<Reading> {
        self.broken.take()
    }

    fn seen_speed(&self) -> Option<f64> {
        self.seen_speed
    }

    fn declared_noise(&self) -> DeclaredNoise {
        let largest = |of: fn(&ReadingRules) -> f64| {
            let lateral = self.axes.iter().filter(|axis| axis.axial.is_none());
            lateral.map(|axis| of(&axis.rules)).fold(0.0, f64::max)
        };
        DeclaredNoise {
            force: largest(|rules| rules.noise),
            resolution: largest(|rules| rules.resolution),
        }
    }

    fn last_move(&self) -> Option<LastMove> {
        let last = self.actuator.last_move()?;
        Some(LastMove {
            id: last.id,
            targets: self.in_plan(&last.targets),
        })
    }

    fn line_statistics(&self) -> LineStatistics {
        let cell = self.load_cell.as_ref().map(|cell| cell.line_statistics());
        let mut all = self
            .actuator
            .line_statistics()
            .plus(cell.unwrap_or_default());
        all.reread += self.reread;
        all
    }
}

#[cfg(test)]
mod tests;
