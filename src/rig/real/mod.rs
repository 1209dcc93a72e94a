//! A rig that moves a real specimen. In: one target per axis, and the devices. Out: settled
//! readings in the polarity of the plan, judged axis by axis; a fault of one axis holds all. It
//! knows no protocol and no procedure; the guard decides which motions are allowed.

mod coordinate;
mod halt;
mod motion;
mod open;
mod path;
mod poll;
mod settle;
mod stroke;
mod validity;

use crate::physics::tracking::trajectory::Path;
use crate::plan::{Calibration, Interval, Limits, ReadingRules, RealLink, Settle};

use super::controllers::{Device, DeviceFault, Move};
use super::motion::of_places;
use super::safety::failpoint::{Guarding, on};
use super::transport::Clock;
use super::{
    CutOff, DeclaredNoise, EachReading, Halted, Identity, LastMove, Live, Offer, Reading, Rig,
    RigFault, Tally, Wish,
};
use coordinate::Coordinate;
pub use open::commands_only;
use validity::Judge;

/// What six decimals of a millimetre cannot say, m.
const WIRE_ROUNDING: f64 = 0.5e-9;

/// Actuators and what weighs what they bend.
pub struct RealRig {
    link: RealLink,
    settle: Settle,
    axes: Vec<Axis>,
    identity: Identity,
    /// The replies in which its devices said so.
    introduction: Vec<Vec<u8>>,
    actuator: Box<dyn Device>,
    load_cell: Option<Box<dyn Device>>,
    clock: Box<dyn Clock>,
    wish: Wish,
    /// The clock when it was opened, s.
    began: f64,
    /// The clock when the devices were last heard, s.
    heard: f64,
    proposed: Option<Proposed>,
    /// Where it has settled, m; None while it is on its way, and where nobody waited for it to settle.
    settled: Option<Vec<f64>>,
    /// Of each axis when the dwell in which it settled began, s, and the median force of it, N.
    rested: Vec<Option<(f64, f64)>>,
    /// Mean speed of the last move as it was seen, m/s.
    seen_speed: Option<f64>,
    /// Times (s, by the clock) and places (m) of the first axis on the last move, as it was seen.
    seen_places: Vec<(f64, f64)>,
    reread: u64,
    /// It was sent on a way since it was opened.
    moved: bool,
    /// Why its position is not to be trusted.
    untrusted: Option<String>,
    /// The words that hold it found no ear: only those that need no answer are left.
    deaf: bool,
    /// Why they found none.
    unheard: String,
    /// Where readings are shown as they come.
    live: Live,
}

/// One actuator with its load cell.
struct Axis {
    /// How displacement and force of the devices count in the plan.
    coordinate: Coordinate,
    limits: Limits,
    rules: ReadingRules,
    calibration: Calibration,
    /// Another device than the one that moves it reads its force.
    weighed_apart: bool,
    judge: Judge,
    /// The last reading on the way was outside a limit.
    outside: bool,
    /// Between the farthest places of the last path, m; 0 where a move came after it.
    span: f64,
    /// Between where it set off and where it was sent, with what a ram may overshoot, m; None where it follows a path.
    way: Option<Interval>,
    /// The last reading on the way was off it.
    off: bool,
}

/// A move that was offered and not yet sent.
#[derive(Clone, Debug)]
struct Proposed {
    going: Move,
    /// m, in the plan's sign.
    targets: Vec<f64>,
    /// Where it stood when it was offered, m.
    from: Vec<f64>,
}

impl RealRig {
    /// Whether its position and readings are still to be trusted: no device started anew or lost its reference.
    #[must_use]
    pub const fn trusted(&self) -> bool {
        self.untrusted.is_none()
    }

    /// Where its readings are to be seen as they come, on the way too.
    #[must_use]
    pub fn live(&self) -> Live {
        self.live.clone()
    }

    /// Whether its displacement is what was commanded and nothing measures it.
    #[must_use]
    pub fn open_loop(&self) -> bool {
        open::commands_only(&self.link)
    }

    /// Places of the devices, m, one an axis, as the plan has them.
    fn in_plan(&self, places: &[f64]) -> Vec<f64> {
        self.axes
            .iter()
            .zip(places)
            .map(|(axis, place)| axis.coordinate.in_plan(*place))
            .collect()
    }

    /// The wall clock, for the record.
    #[must_use]
    pub fn wall(&self) -> Option<String> {
        self.clock.wall()
    }

    /// A fault of a device, said of the rig.
    fn told(&mut self, part: Part, fault: &DeviceFault) -> RigFault {
        let (role, behind, culprit) = match (part, &self.load_cell) {
            (Part::LoadCell, Some(cell)) => ("load cell", self.link.load_cells(), cell.culprit()),
            _ => ("actuator", self.link.actuators(), self.actuator.culprit()),
        };
        // Of several the one it is the fault of; where that is not known the first.
        let place = behind.get(culprit.unwrap_or(0)).map_or_else(
            || role.to_owned(),
            |behind| format!("{} on {}", behind.name(role), behind.link.port),
        );
        let told = format!("{place}: {fault}");
        match fault {
            DeviceFault::Interrupted => return RigFault::Interrupted,
            DeviceFault::Rebooted { .. } => self.untrusted = Some(told.clone()),
            _ => {}
        }
        RigFault::Device(told)
    }

    /// Holds where `result` is a fault.
    fn or_hold<T>(&mut self, result: Result<T, RigFault>) -> Result<T, RigFault> {
        if result.is_err() {
            self.hold();
        }
        result
    }
}

/// As a sentence has it.
fn degrees_of_freedom(count: usize) -> String {
    if count == 1 {
        "one degree of freedom".to_owned()
    } else {
        format!("{count} degrees of freedom")
    }
}

/// m, after each other.
fn places(places: &[f64]) -> String {
    places
        .iter()
        .map(f64::to_string)
        .collect::<Vec<_>>()
        .join(", ")
}

/// Which device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
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

    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<Offer, RigFault> {
        self.proposed = None;
        if let Some(reason) = &self.untrusted {
            return Err(RigFault::Device(format!("not moved any more: {reason}")));
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
            return Err(RigFault::Device(format!(
                "the target {target} m is no place"
            )));
        }
        let speed = speed.unwrap_or(self.link.own_speed);
        // Asked before the bytes are made, for between them and their sending nothing is asked.
        // What it says of itself there may be a reason to hold, as anywhere.
        let polled = self.poll();
        let from = self.or_hold(polled)?.displacement;
        let turned: Vec<f64> = self
            .axes
            .iter()
            .zip(targets)
            .map(|(axis, target)| axis.coordinate.at_device(*target))
            .collect();
        let going = self
            .actuator
            .encode(&turned, speed)
            .map_err(|fault| self.told(Part::Actuator, &fault))?;
        let said = self.in_plan(&going.targets);
        // What the devices resolve is as near as they can say it.
        let apt = |(axis, (said, target)): (&Axis, (&f64, &f64))| {
            let allowed = WIRE_ROUNDING.max(axis.rules.resolution / 2.0) * (1.0 + 1e-6);
            (said - target).abs() <= allowed
        };
        let apt = going.speed > 0.0
            && going.speed.is_finite()
            && said.len() == targets.len()
            && self.axes.iter().zip(said.iter().zip(targets)).all(apt);
        if on(Guarding::WireNumber) && !apt {
            let [asked, said] = [targets, &said].map(places);
            let reason = format!(
                "asked for {asked} m, the bytes say {said} m at {} m/s: not sent",
                going.speed
            );
            return Err(RigFault::Device(reason));
        }
        let at_the_rig = self
            .axes
            .iter()
            .any(|axis| axis.coordinate.datum != 0.0)
            .then(|| going.targets.clone());
        let offer = Offer {
            targets: said,
            speed: going.speed,
            wire: going.frames.concat(),
            move_id: going.id,
            at_the_rig,
        };
        self.proposed = Some(Proposed {
            going,
            targets: targets.to_vec(),
            from,
        });
        Ok(offer)
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
        let moved = of_places(&self.seen_places).map(|ends| ends.map(|end| end - self.began));
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

    fn glide(
        &mut self,
        paths: &[Path],
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        let followed = self.follow(paths, samples, each);
        self.or_hold(followed)
    }

    fn glide_on(
        &mut self,
        paths: &[Path],
        samples: usize,
        done: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        let followed = self.rest_of_way(paths, samples.saturating_sub(done), each);
        self.or_hold(followed)
    }

    /// Says so, and where that finds no ear sends what needs no answer.
    fn hold(&mut self) {
        // Whether it was heard is told at the end of the run.
        let _ = self.tell_to_hold();
    }

    fn halt(&mut self) -> Option<Halted> {
        Some(self.held_for_good())
    }

    fn datum(&self) -> Option<Vec<f64>> {
        Some(self.axes.iter().map(|axis| axis.coordinate.datum).collect())
    }

    fn own_speed(&self) -> Option<f64> {
        Some(self.link.own_speed)
    }

    fn seen_speed(&self) -> Option<f64> {
        self.seen_speed
    }

    fn declared_noise(&self) -> DeclaredNoise {
        let largest = |of: fn(&ReadingRules) -> f64| {
            self.axes
                .iter()
                .map(|axis| of(&axis.rules))
                .fold(0.0, f64::max)
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

    fn tally(&self) -> Tally {
        let cell = self
            .load_cell
            .as_ref()
            .map_or_else(Tally::default, |cell| cell.tally());
        let actuator = self.actuator.tally();
        Tally {
            resent: actuator.resent + cell.resent,
            ignored: actuator.ignored + cell.ignored,
            reread: actuator.reread + cell.reread + self.reread,
        }
    }
}

#[cfg(test)]
mod disturbed_tests;
#[cfg(test)]
mod halt_tests;
#[cfg(test)]
mod speed_tests;
#[cfg(test)]
mod straying_tests;
#[cfg(test)]
mod tests;
