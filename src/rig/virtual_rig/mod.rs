//! The virtual rig: an actuator and a load cell per axis, with a specimen between them. In: one
//! target per axis. Out: readings. Its time is simulated; it reads no clock and no file. Each load
//! cell has its own seed.

pub mod actuator;
mod axial;
#[cfg(test)]
mod frame_tests;
pub mod load_cell;
pub mod settling;
pub(super) mod smooth_paths;
mod springs;
mod stroke;
#[cfg(test)]
mod tests;

use self::axial::AxialActuator;
use self::smooth_paths::Course;
use self::springs::Springs;
use self::stroke::Stroke;
use super::motion::{Instants, even};
use super::virtual_rig::actuator::Actuator;
use super::virtual_rig::load_cell::{LoadCell, to_quantum};
use super::virtual_rig::settling::{Unsettled, dying, relaxing_time, settling_time, shared};
use super::{
    CutOff, DeclaredNoise, EachReading, EncodedMove, Identity, Reading, Rig, RigFault,
    UnfinishedStep, WholeSteps,
};
use psd_physics::relaxation::maxwell::Motion;
use psd_physics::structure::matrix::Vector as _;
use psd_physics::tracking::trajectory::Path;
use psd_plan::{Frame, Plan, Settle, Specimen, VirtualLink};

pub use psd_plan::VIRTUAL_SPEED as OWN_SPEED;

/// One degree of freedom, or the tested floors of a frame from the ground up.
pub struct VirtualRig {
    name: String,
    link: VirtualLink,
    settle: Settle,
    /// Polarity of every axis, +1 or −1, between rig and plan. The specimen has the polarity of the rig.
    sign: f64,
    axes: Vec<Axis>,
    /// The actuators in force control, behind the others in targets and readings.
    axial: Vec<AxialActuator>,
    springs: Springs,
    /// \[s\]
    time: f64,
    /// The last positions of the axes \[m\], and their restoring forces there \[N\].
    bent: Vec<f64>,
    restoring_force: Vec<f64>,
    /// Targets at the rig \[m\], then of the actuators in force control \[N\], and speed of the fastest axis \[m/s\].
    proposed: Option<(Vec<f64>, f64)>,
    /// The references at the end of the present move \[m\], and the motion of each piston.
    aims: Vec<f64>,
    travels: Vec<Motion>,
    /// Start and duration of its last move \[s\].
    moved: Option<[f64; 2]>,
    /// Whether nothing changes while the references are at rest: no piston lags, and no force relaxes.
    is_still: bool,
    /// Settling time of every move \[s\]; None if it differs from move to move, or is beyond the timeout.
    wait: Option<f64>,
    /// Whether every reading after a move is its target and the force of the specimen there.
    is_ideal: bool,
    /// The paths that the axes follow, or were stopped on.
    interrupted: Vec<Course>,
}

struct Axis {
    actuator: Actuator,
    cell: LoadCell,
}

/// Velocities of the pistons \[m/s\].
fn velocities(axes: &[Axis]) -> impl Iterator<Item = f64> {
    axes.iter().map(|axis| axis.actuator.velocity())
}

/// The seed of one load cell: the plan's own for the first.
const fn seed_of(seed: u64, axis: u64) -> u64 {
    // The odd number nearest to 2⁶⁴ over the golden ratio: two axes with similar seeds have different generator seeds.
    seed.wrapping_add(axis.wrapping_mul(0x9e37_79b9_7f4a_7c15))
}

impl VirtualRig {
    /// A rig with `specimen`, or without one, on one axis; `sign` is +1 or −1.
    #[must_use]
    pub fn new(link: VirtualLink, settle: Settle, specimen: Option<&Specimen>, sign: f64) -> Self {
        Self::of_springs(link, settle, Springs::of_specimen(specimen), sign)
    }

    /// A rig with one axis for each floor of the frame, or for each tested storey.
    #[must_use]
    pub fn of_frame(link: VirtualLink, settle: Settle, frame: &Frame, sign: f64) -> Self {
        Self::of_springs(link, settle, Springs::of_frame(frame), sign)
    }

    fn of_springs(link: VirtualLink, settle: Settle, mut springs: Springs, sign: f64) -> Self {
        let axis = |number: u64| Axis {
            actuator: Actuator::new(link.lag, link.tracking),
            cell: LoadCell::new(&link, seed_of(link.seed, number)),
        };
        let axes: Vec<Axis> = (0..).take(springs.order()).map(axis).collect();
        let at_rest = vec![0.0; axes.len()];
        let mut restoring_force = at_rest.clone();
        let travels = vec![Motion::rest(0.0); axes.len()];
        springs.bend(&travels, &at_rest, &mut restoring_force);
        let relaxes = (0..axes.len()).any(|axis| !springs.relaxing_at(axis).is_empty());
        let is_still = link.lag == 0.0 && !relaxes;
        let mut rig = Self {
            name: "virtual".to_owned(),
            link,
            settle,
            sign,
            axes,
            axial: Vec::new(),
            springs,
            time: 0.0,
            bent: at_rest.clone(),
            restoring_force,
            proposed: None,
            aims: Vec::new(),
            travels,
            moved: None,
            is_still,
            wait: None,
            is_ideal: false,
            interrupted: Vec::new(),
        };
        if is_still && link.tracking == 0.0 {
            rig.wait = rig.settling(&at_rest);
            rig.is_ideal = rig.wait.is_some()
                && sign == 1.0
                && link.is_exact()
                && !rig.springs.have_feedback_at_rest();
        }
        rig
    }

    /// The plan's rig with the plan's specimen: the one of the first procedure. For a plan with a real rig, an ideal
    /// virtual rig.
    #[must_use]
    pub fn of_plan(plan: &Plan) -> Self {
        let link = plan.rig.link.as_virtual().copied().unwrap_or_default();
        let specimen = Self::specimen_of(plan);
        let (settle, sign) = (plan.rig.settle, plan.rig.polarity);
        let rig = match specimen.and_then(|specimen| specimen.frame.as_ref()) {
            Some(frame) => Self {
                axial: AxialActuator::of(plan, frame, &link),
                ..Self::of_frame(link, settle, frame, sign)
            },
            None => Self::new(link, settle, specimen, sign),
        };
        Self {
            name: plan.rig.name.clone(),
            ..rig
        }
    }

    /// Actuators of both kinds.
    fn order(&self) -> usize {
        self.axes.len() + self.axial.len()
    }

    /// The specimen on the plan's rig: that of the first procedure, otherwise the first.
    #[must_use]
    pub fn specimen_of(plan: &Plan) -> Option<&Specimen> {
        plan.specimen_on_the_rig()
    }

    /// The fault for a number of axes that differs from that of the rig.
    fn other_order(&self, found: usize) -> RigFault {
        let own = match self.order() {
            1 => "one degree of freedom".to_owned(),
            order => format!("{order} degrees of freedom"),
        };
        RigFault::Device(format!("this rig has {own}, not {found}"))
    }

    /// Targets at the rig \[m\], then those in force control \[N\].
    fn at_rig(&self, targets: &[f64]) -> Result<Vec<f64>, RigFault> {
        if targets.len() != self.order() {
            return Err(self.other_order(targets.len()));
        }
        match targets.iter().find(|target| !target.is_finite()) {
            Some(target) => Err(RigFault::Device(format!("invalid target: {target} m"))),
            None => Ok(targets
                .iter()
                .enumerate()
                .map(|(axis, target)| {
                    if axis < self.axes.len() {
                        self.sign * target
                    } else {
                        *target
                    }
                })
                .collect()),
        }
    }

    /// The only axis, for a motion at constant velocity, and its target \[m\].
    fn only(&mut self, targets: &[f64]) -> Result<(&mut Actuator, f64), RigFault> {
        let target = self.at_rig(targets)?;
        match (&mut self.axes[..], &target[..]) {
            ([axis], [target, ..]) => Ok((&mut axis.actuator, *target)),
            _ => Err(RigFault::Device(
                "the axes of a frame move to targets: they are not read during a motion".to_owned(),
            )),
        }
    }

    /// The specimen, its relaxation and its friction follow the pistons along `travels`.
    fn follow(&mut self) {
        let mut moved = false;
        for (bent, axis) in self.bent.iter_mut().zip(&self.axes) {
            let position = axis.actuator.position();
            moved |= position != *bent;
            *bent = position;
        }
        if moved {
            self.springs.slide(velocities(&self.axes));
        }
        self.springs
            .bend(&self.travels, &self.bent, &mut self.restoring_force);
    }

    /// `seconds` pass with the references at rest.
    fn rest(&mut self, seconds: f64) {
        self.time += seconds;
        if self.is_still {
            self.stop();
            return;
        }
        let resting = self.axes.iter_mut();
        let resting = resting.map(|axis| axis.actuator.rest(seconds));
        self.travels.clear();
        self.travels.extend(resting);
        self.follow();
    }

    /// The references stop.
    fn stop(&mut self) {
        for axis in &mut self.axes {
            axis.actuator.stop();
        }
    }

    fn reading(&mut self) -> Reading {
        let mut reading = Reading {
            time: 0.0,
            displacement: Vec::new(),
            force: Vec::new(),
            raw: Vec::new(),
        };
        self.read_into(&mut reading);
        reading
    }

    fn read_into(&mut self, reading: &mut Reading) {
        let (sign, time, resolution) = (self.sign, self.time, self.link.resolution);
        reading.time = time;
        reading.displacement.clear();
        let bent = self.bent.iter();
        reading
            .displacement
            .extend(bent.map(|bent| sign * to_quantum(*bent, resolution)));
        reading.force.clone_from(&self.restoring_force);
        self.springs
            .add_feedback(velocities(&self.axes), &mut reading.force);
        for (axis, force) in self.axes.iter_mut().zip(&mut reading.force) {
            *force = sign * axis.cell.read(*force, time);
        }
        for axial in &mut self.axial {
            let shortening = axial.shortening(self.springs.drift(axial.spring()));
            reading
                .displacement
                .push(to_quantum(shortening, resolution));
            reading.force.push(axial.read(time));
        }
    }

    /// The actuators in force control go to these forces \[N\], each at its rate, while the others hold.
    fn load(&mut self, forces: &[f64]) {
        let mut seconds: f64 = 0.0;
        for (axial, force) in self.axial.iter_mut().zip(forces) {
            seconds = seconds.max(axial.go_to(*force));
            self.springs.lean(axial.spring(), axial.p_delta_stiffness());
        }
        if seconds > 0.0 {
            self.rest(seconds);
            if self.is_still {
                self.follow();
            }
        }
    }

    /// The references move to their `aims` together, the one with the longest travel at this speed \[m/s\].
    fn arrive(&mut self, speed: f64) {
        for (aim, axis) in self.aims.iter_mut().zip(&self.axes) {
            *aim = axis.actuator.aim(*aim);
        }
        let travels = self
            .axes
            .iter()
            .zip(&self.aims)
            .map(|(axis, aim)| (aim - axis.actuator.reference()).abs());
        let seconds = travels.fold(0.0, f64::max) / speed;
        let motions = self
            .axes
            .iter_mut()
            .zip(&self.aims)
            .map(|(axis, aim)| axis.actuator.advance(*aim, seconds));
        self.travels.clear();
        self.travels.extend(motions);
        self.moved = Some([self.time, seconds]);
        self.time += seconds;
        self.follow();
        self.stop();
    }

    /// Settling time of a move whose axes miss their targets by these distances \[m\], without relaxation. None if one axis does not
    /// settle within the timeout.
    fn settling(&self, misses: &[f64]) -> Option<f64> {
        self.longest(misses, |axis, unsettled| {
            let relaxes = !self.springs.relaxing_at(axis).is_empty();
            settling_time(&shared(&self.settle, unsettled, relaxes), unsettled)
        })
    }

    /// The remaining motion of an axis that misses its target by `miss` \[m\].
    fn unsettled(&self, axis: usize, miss: f64) -> Unsettled {
        let actuator = &self.axes[axis].actuator;
        let (stiffness, damping) = self.springs.rows(axis);
        Unsettled {
            lagging: actuator.lagging(),
            lag: actuator.lag(),
            miss: miss.abs(),
            stiffness: stiffness
                + self
                    .springs
                    .relaxing_at(axis)
                    .iter()
                    .map(|relaxing| relaxing.stiffness())
                    .sum::<f64>(),
            damping,
            drift: self.link.drift,
            rate: self.springs.rate(),
        }
    }

    /// The longest settling time of all axes \[s\]. None if one does not settle within the timeout.
    fn longest(
        &self,
        misses: &[f64],
        wait: impl Fn(usize, &Unsettled) -> Option<f64>,
    ) -> Option<f64> {
        let mut axes = misses.iter().enumerate();
        axes.try_fold(0.0, |longest: f64, (axis, miss)| {
            Some(longest.max(wait(axis, &self.unsettled(axis, *miss))?))
        })
    }

    /// Waits until every axis and the force of every storey have settled; false if one does not settle within the timeout.
    fn settle(&mut self, misses: &[f64]) -> bool {
        let Some(waited) = self.settling(misses) else {
            return false;
        };
        self.rest(waited);
        let more = self.longest(misses, |axis, unsettled| {
            relaxing_time(
                &self.settle,
                unsettled,
                &dying(&self.springs.relaxing_at(axis)),
                waited,
            )
        });
        if let Some(more) = more {
            self.rest(more);
        }
        more.is_some()
    }
}

impl VirtualRig {
    /// [`WholeSteps::step`] of an ideal rig.
    fn step_ideally(&mut self, targets: &[f64], speed: f64, pause: f64, reading: &mut Reading) {
        let mut travel: f64 = 0.0;
        for (axis, target) in self.axes.iter_mut().zip(targets) {
            travel = travel.max(axis.actuator.jump(*target));
        }
        self.bent.set(targets);
        let seconds = travel / speed;
        self.proposed = None;
        self.moved = Some([self.time, seconds]);
        self.time += seconds;
        self.time += self.wait.unwrap_or(0.0);
        if pause > 0.0 {
            self.time += pause;
        }
        self.springs
            .bend_at_once(targets, &mut self.restoring_force);
        reading.time = self.time;
        reading.displacement.set(targets);
        reading.force.set(&self.restoring_force);
        // A cell adds no drift and no noise.
        for force in &mut reading.force {
            *force += 0.0;
        }
    }
}

impl WholeSteps for VirtualRig {
    fn step(
        &mut self,
        targets: &[f64],
        speed: Option<f64>,
        pause: f64,
        reading: &mut Reading,
    ) -> Result<(), UnfinishedStep> {
        let speed = speed.unwrap_or(OWN_SPEED);
        if self.is_ideal {
            self.step_ideally(targets, speed, pause, reading);
            return Ok(());
        }
        self.proposed = None;
        let sign = self.sign;
        self.aims.clear();
        self.aims.extend(targets.iter().map(|to| sign * to));
        self.arrive(speed);
        self.rest(self.wait.unwrap_or(0.0));
        if pause > 0.0 {
            self.rest(pause);
        }
        self.read_into(reading);
        Ok(())
    }
}

impl Rig for VirtualRig {
    fn identity(&self) -> Identity {
        Identity {
            name: self.name.clone(),
            model: "virtual rig".to_owned(),
            serial: String::new(),
            firmware: env!("CARGO_PKG_VERSION").to_owned(),
            boot: None,
            simulated: true,
        }
    }

    fn degrees_of_freedom(&self) -> usize {
        self.order()
    }

    fn time(&self) -> f64 {
        self.time
    }

    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<EncodedMove, RigFault> {
        let at_rig = self.at_rig(targets)?;
        let speed = speed.unwrap_or(OWN_SPEED);
        if !(speed > 0.0 && speed.is_finite()) {
            return Err(RigFault::Device(format!(
                "invalid speed of a move: {speed} m/s"
            )));
        }
        self.proposed = Some((at_rig, speed));
        Ok(EncodedMove {
            targets: targets.to_vec(),
            speed,
            wire: Vec::new(),
            move_id: None,
            at_the_rig: None,
        })
    }

    /// All axes arrive simultaneously; the one with the longest travel has the requested speed.
    fn execute(&mut self) -> Result<(), RigFault> {
        let (mut targets, speed) = self
            .proposed
            .take()
            .ok_or_else(|| RigFault::Device("nothing was proposed to execute".to_owned()))?;
        let forces = targets.split_off(self.axes.len());
        self.load(&forces);
        self.aims.clone_from(&targets);
        self.arrive(speed);
        let arrived = self.time;
        let misses: Vec<f64> = targets
            .iter()
            .zip(&self.aims)
            .map(|(target, aim)| target - aim)
            .collect();
        if self.settle(&misses) {
            return Ok(());
        }
        self.rest((arrived + self.settle.timeout - self.time).max(0.0));
        self.hold();
        Err(RigFault::NotSettled {
            timeout: self.settle.timeout,
            axis: None,
        })
    }

    fn pause(&mut self, seconds: f64) -> Result<(), RigFault> {
        self.rest(seconds);
        Ok(())
    }

    fn read(&mut self) -> Result<Reading, RigFault> {
        Ok(self.reading())
    }

    fn read_moved(&mut self) -> Result<(Reading, Option<[f64; 2]>), RigFault> {
        // A first-order lag delays a motion by its time constant, and adds its square to the variance.
        let lag = self.link.lag;
        let moved = self.moved.map(|[start, seconds]| {
            let instants = Instants {
                mean: start + 0.5 * seconds + lag,
                variance: seconds * seconds / 12.0 + lag * lag,
            };
            even(start, &instants)
        });
        Ok((self.reading(), moved))
    }

    fn at_once(&mut self) -> Option<&mut dyn WholeSteps> {
        (self.wait.is_some() && self.axial.is_empty()).then_some(self)
    }

    fn is_ideal(&mut self) -> bool {
        self.is_ideal && self.axial.is_empty()
    }

    fn traverse(
        &mut self,
        targets: &[f64],
        velocity: f64,
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        let (actuator, target) = self.only(targets)?;
        let stroke = Stroke {
            from: actuator.reference(),
            aim: actuator.aim(target),
            velocity,
        };
        self.stroke(stroke, samples, 0, each)
    }

    fn traverse_on(
        &mut self,
        cut_off: &CutOff<'_>,
        velocity: f64,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        let (_, from) = self.only(cut_off.from)?;
        let (actuator, target) = self.only(cut_off.to)?;
        let stroke = Stroke {
            from,
            aim: actuator.aim(target),
            velocity,
        };
        self.stroke(stroke, cut_off.samples, cut_off.done, each)
    }

    fn follow_paths(
        &mut self,
        paths: &[Path],
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        self.interrupted.clear();
        self.resume_paths(paths, samples, 0, each)
    }

    fn resume_paths(
        &mut self,
        paths: &[Path],
        samples: usize,
        done: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        self.follow_paths_after(paths, samples, done, each)
    }

    fn hold(&mut self) {
        for axis in &mut self.axes {
            axis.actuator.hold();
        }
        self.proposed = None;
    }

    fn declared_noise(&self) -> DeclaredNoise {
        DeclaredNoise {
            force: self.link.noise,
            resolution: self.link.resolution,
        }
    }
}
