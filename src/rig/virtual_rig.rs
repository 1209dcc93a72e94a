//! The virtual rig: an actuator, a load cell and a specimen between them. In: targets. Out: readings. Its time is
//! simulated, so that motion, settling and pauses take rig time and no wall time; it reads no clock and no file.

pub(super) mod glide;

use self::glide::Course;
use super::actuator::Actuator;
use super::load_cell::{LoadCell, to_quantum};
use super::moved::even;
use super::settling::{Unsettled, dying, relaxing_time, settling_time, shared};
use super::{CutOff, DeclaredNoise, EachReading, Identity, Offer, Reading, Rig, RigFault};
use crate::mechanics::damping::CellDamping;
use crate::mechanics::maxwell::Travel;
use crate::mechanics::path::Path;
use crate::mechanics::relaxing::Relaxing;
use crate::mechanics::specimen::{RestoringForce, SpecimenModel};
use crate::plan::{Behaviour, Plan, Settle, Specimen, VirtualLink};

pub use crate::plan::VIRTUAL_SPEED as OWN_SPEED;

/// One degree of freedom: one actuator, one load cell.
pub struct VirtualRig {
    name: String,
    link: VirtualLink,
    settle: Settle,
    /// +1 or −1: how displacement and force at the rig count in the plan. The specimen is at the rig.
    sign: f64,
    actuator: Actuator,
    cell: LoadCell,
    specimen: SpecimenModel,
    damping: CellDamping,
    /// What relaxes with the specimen.
    relaxing: Relaxing,
    /// N·s/m, for the force rate while settling.
    viscous: f64,
    /// s
    time: f64,
    /// Where the specimen was last bent to (m), and its force there (N).
    bent: f64,
    restoring_force: f64,
    /// Target at the rig (m) and speed (m/s).
    proposed: Option<(f64, f64)>,
    /// When it went on its last move.
    moved: Option<[f64; 2]>,
    /// The path that it follows, or was stopped on.
    under_way: Option<Course>,
}

impl VirtualRig {
    /// A rig that bends `specimen`, or nothing.
    #[must_use]
    pub fn new(link: VirtualLink, settle: Settle, specimen: Option<&Specimen>, sign: f64) -> Self {
        let nothing = Behaviour::Elastic { stiffness: 0.0 };
        let behaviour = specimen.and_then(|specimen| specimen.behaviour.clone()).unwrap_or(nothing);
        let (viscous, coulomb) = specimen.map_or((0.0, 0.0), |specimen| (specimen.damping, specimen.coulomb));
        let mut model = SpecimenModel::new(&behaviour);
        let restoring_force = model.move_to(0.0);
        Self {
            name: "virtual".to_owned(),
            link,
            settle,
            sign,
            actuator: Actuator::new(link.lag, link.tracking),
            cell: LoadCell::new(link.noise, link.force_resolution, link.drift, link.seed),
            specimen: model,
            damping: CellDamping::new(viscous, coulomb).with_rate_of(&behaviour),
            relaxing: Relaxing::of(&behaviour),
            viscous,
            time: 0.0,
            bent: 0.0,
            restoring_force,
            proposed: None,
            moved: None,
            under_way: None,
        }
    }

    /// The plan's rig with the plan's specimen on it: the one that the first procedure names. In place of a real rig an
    /// ideal virtual one.
    #[must_use]
    pub fn of_plan(plan: &Plan) -> Self {
        let link = plan.rig.link.as_virtual().copied().unwrap_or_default();
        let specimen = Self::specimen_of(plan);
        Self { name: plan.rig.name.clone(), ..Self::new(link, plan.rig.settle, specimen, plan.rig.sign) }
    }

    /// The specimen that stands on the plan's rig: the one that the first procedure names, else the first.
    #[must_use]
    pub fn specimen_of(plan: &Plan) -> Option<&Specimen> {
        plan.specimen_on_the_rig()
    }

    /// Target at the rig, m.
    fn at_rig(&self, targets: &[f64]) -> Result<f64, RigFault> {
        match targets {
            [target] if target.is_finite() => Ok(self.sign * target),
            [target] => Err(RigFault::Device(format!("the target {target} m is no place"))),
            _ => Err(RigFault::Device(format!("this rig has one degree of freedom, not {}", targets.len()))),
        }
    }

    /// The specimen, what relaxes with it and the friction on it follow the piston.
    fn follow(&mut self, travel: &Travel) {
        let position = self.actuator.position();
        if position != self.bent {
            self.damping.force(self.actuator.velocity());
        }
        let way = (self.bent, position);
        self.restoring_force = self.relaxing.bend(&mut self.specimen, travel, way, self.restoring_force);
        self.bent = position;
    }

    /// `seconds` pass with the reference at rest.
    fn rest(&mut self, seconds: f64) {
        let travel = self.actuator.rest(seconds);
        self.time += seconds;
        self.follow(&travel);
    }

    /// The readings of an even way between two places at the rig (m), of which some may be done.
    fn stroke(
        &mut self,
        (from, aim): (f64, f64),
        velocity: f64,
        (samples, done): (usize, usize),
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        let seconds = (aim - from) / (self.sign * velocity);
        if samples == 0 || !(seconds > 0.0 && seconds.is_finite()) {
            return Err(RigFault::Device(format!("a traverse at {velocity} m/s with {samples} samples leads nowhere")));
        }
        #[expect(clippy::cast_precision_loss, reason = "far fewer samples than 2^53")]
        let fraction = |sample: usize| sample as f64 / samples as f64;
        #[expect(clippy::cast_precision_loss, reason = "the same")]
        let each_takes = seconds / samples as f64;
        let began = self.time - seconds * fraction(done);
        for sample in done + 1..=samples {
            let to = if sample == samples { aim } else { from + (aim - from) * fraction(sample) };
            let travel = if sample == done + 1 && done_already(to, self.actuator.reference(), (aim - from) / seconds * each_takes)
            {
                self.actuator.pass((aim - from) / seconds)
            } else {
                self.actuator.advance(to, each_takes)
            };
            self.time = began + seconds * fraction(sample);
            self.follow(&travel);
            let reading = self.reading();
            if let Err(refused) = each(reading) {
                self.hold();
                return Err(refused);
            }
        }
        self.actuator.stop();
        Ok(())
    }

    fn reading(&mut self) -> Reading {
        let force = self.damping.felt(self.restoring_force, self.actuator.velocity()) + self.relaxing.force();
        Reading {
            time: self.time,
            displacement: vec![self.sign * to_quantum(self.bent, self.link.resolution)],
            force: vec![self.sign * self.cell.read(force, self.time)],
            raw: Vec::new(),
        }
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
        1
    }

    fn time(&self) -> f64 {
        self.time
    }

    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<Offer, RigFault> {
        let target = self.at_rig(targets)?;
        let speed = speed.unwrap_or(OWN_SPEED);
        if !(speed > 0.0 && speed.is_finite()) {
            return Err(RigFault::Device(format!("a move at {speed} m/s never arrives")));
        }
        self.proposed = Some((target, speed));
        Ok(Offer { targets: targets.to_vec(), speed, wire: Vec::new(), move_id: None, at_the_rig: None })
    }

    fn execute(&mut self) -> Result<(), RigFault> {
        let (target, speed) =
            self.proposed.take().ok_or_else(|| RigFault::Device("nothing was proposed to execute".to_owned()))?;
        let aim = self.actuator.aim(target);
        let seconds = (aim - self.actuator.reference()).abs() / speed;
        let travel = self.actuator.advance(aim, seconds);
        // A first-order lag delays a motion by its time constant, and adds the square of it to the variance.
        let lag = self.actuator.lag();
        self.moved = Some(even(self.time, self.time + 0.5 * seconds + lag, seconds * seconds / 12.0 + lag * lag));
        self.time += seconds;
        self.follow(&travel);
        self.actuator.stop();
        let unsettled = Unsettled {
            lagging: self.actuator.lagging(),
            lag: self.actuator.lag(),
            miss: (target - aim).abs(),
            stiffness: self.specimen.initial_stiffness() + self.relaxing.stiffness(),
            damping: self.viscous,
            drift: self.link.drift,
            rate: self.damping.rate.map(|rate| (self.restoring_force, rate)),
        };
        let arrived = self.time;
        if let Some(wait) = settling_time(&shared(&self.settle, &unsettled, !self.relaxing.is_none()), &unsettled) {
            self.rest(wait);
            if let Some(more) = relaxing_time(&self.settle, &unsettled, &dying(&[&self.relaxing]), wait) {
                self.rest(more);
                return Ok(());
            }
        }
        self.rest((arrived + self.settle.timeout - self.time).max(0.0));
        self.hold();
        Err(RigFault::NotSettled { timeout: self.settle.timeout, axis: None })
    }

    fn pause(&mut self, seconds: f64) -> Result<(), RigFault> {
        self.rest(seconds);
        Ok(())
    }

    fn read(&mut self) -> Result<Reading, RigFault> {
        Ok(self.reading())
    }

    fn read_moved(&mut self) -> Result<(Reading, Option<[f64; 2]>), RigFault> {
        Ok((self.reading(), self.moved))
    }

    fn traverse(&mut self, targets: &[f64], velocity: f64, samples: usize, each: EachReading<'_>) -> Result<(), RigFault> {
        let aim = self.actuator.aim(self.at_rig(targets)?);
        self.stroke((self.actuator.reference(), aim), velocity, (samples, 0), each)
    }

    fn traverse_on(&mut self, cut_off: &CutOff<'_>, velocity: f64, each: EachReading<'_>) -> Result<(), RigFault> {
        let aim = self.actuator.aim(self.at_rig(cut_off.to)?);
        let from = self.at_rig(cut_off.from)?;
        self.stroke((from, aim), velocity, (cut_off.samples, cut_off.done), each)
    }

    fn glide(&mut self, paths: &[Path], samples: usize, each: EachReading<'_>) -> Result<(), RigFault> {
        self.under_way = None;
        self.glide_on(paths, samples, 0, each)
    }

    fn glide_on(&mut self, paths: &[Path], samples: usize, done: usize, each: EachReading<'_>) -> Result<(), RigFault> {
        match paths {
            [path] => self.glide_along(path, (samples, done), each),
            _ => Err(RigFault::Device(format!("this rig has one degree of freedom, not {}", paths.len()))),
        }
    }

    fn hold(&mut self) {
        self.actuator.hold();
        self.proposed = None;
    }

    fn declared_noise(&self) -> DeclaredNoise {
        DeclaredNoise { force: self.link.noise, resolution: self.link.resolution }
    }
}

/// Whether a stroke was cut off just where its next reading is due, a step (m) after the one before: that it is read again, moving.
fn done_already(to: f64, stands: f64, step: f64) -> bool {
    (to - stands).abs() < 1e-6 * step.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) const AT_ONCE: Settle = Settle { band: 0.0, force_rate: 0.0, dwell: 0.0, timeout: 60.0 };

    pub(super) fn specimen(damping: f64, coulomb: f64) -> Specimen {
        let behaviour = Some(Behaviour::Elastic { stiffness: 1000.0 });
        Specimen { damping, coulomb, ..Specimen::new("spring", 1.0, behaviour) }
    }

    fn rig(link: VirtualLink) -> VirtualRig {
        VirtualRig::new(link, AT_ONCE, Some(&specimen(0.0, 0.0)), 1.0)
    }

    /// A way that was cut off where a reading is due is gone on with: the reading is made again, and of a damper that moves.
    #[test]
    fn a_reading_that_was_lost_is_made_again_under_way() {
        /// Takes readings, and is killed at the one after so many.
        fn up_to(read: &mut Vec<f64>, most: usize) -> impl FnMut(Reading) -> Result<(), RigFault> {
            move |reading| {
                if read.len() == most {
                    return Err(RigFault::Device("killed".to_owned()));
                }
                read.push(reading.force[0]);
                Ok(())
            }
        }
        let damped = || VirtualRig::new(VirtualLink::default(), AT_ONCE, Some(&specimen(50.0, 0.25)), 1.0);
        let (mut whole, mut parts) = (Vec::new(), Vec::new());
        damped().traverse(&[2e-3], 0.01, 4, &mut up_to(&mut whole, 4)).unwrap();
        let mut rig = damped();
        assert!(rig.traverse(&[2e-3], 0.01, 4, &mut up_to(&mut parts, 2)).is_err());
        let cut_off = CutOff { from: &[0.0], to: &[2e-3], samples: 4, done: 2 };
        rig.traverse_on(&cut_off, 0.01, &mut up_to(&mut parts, 4)).unwrap();
        assert_eq!(parts, whole);
    }

    /// Moves at 10 mm/s and reads: time, displacement, force.
    fn go(rig: &mut VirtualRig, target: f64) -> (f64, f64, f64) {
        rig.propose(&[target], Some(0.01)).unwrap();
        rig.execute().unwrap();
        let reading = rig.read().unwrap();
        (reading.time, reading.displacement[0], reading.force[0])
    }

    #[test]
    fn an_ideal_rig_is_where_it_was_told_after_the_time_the_way_takes() {
        let mut rig = rig(VirtualLink::default());
        assert_eq!(go(&mut rig, 0.002), (0.2, 0.002, 2.0));
        rig.pause(1.0).unwrap();
        assert_eq!(rig.time(), 1.2);
        rig.propose(&[0.0], None).unwrap();
        rig.execute().unwrap();
        assert_eq!(rig.time(), 1.2 + 0.002 / OWN_SPEED);
    }

    #[test]
    fn tracking_resolution_and_drift_change_a_reading_as_computed_by_hand() {
        let (_, x, r) = go(&mut rig(VirtualLink { tracking: 0.1, ..VirtualLink::default() }), 0.002);
        assert!((x - 0.0018).abs() < 1e-15 && (r - 1.8).abs() < 1e-12);
        // The cell feels the place; the resolution is of the displacement reading.
        let (_, x, r) = go(&mut rig(VirtualLink { resolution: 5e-4, ..VirtualLink::default() }), 0.0013);
        assert!((x - 0.0015).abs() < 1e-15 && (r - 1.3).abs() < 1e-12);
        let (_, _, r) = go(&mut rig(VirtualLink { force_resolution: 0.5, ..VirtualLink::default() }), 0.0013);
        assert_eq!(r, 1.5);
        // 0.2 s at 3 N/s.
        let (_, _, r) = go(&mut rig(VirtualLink { drift: 3.0, ..VirtualLink::default() }), 0.002);
        assert!((r - 2.6).abs() < 1e-12);
    }

    #[test]
    fn lag_is_v_tau_behind_at_the_end_of_a_move_and_a_pause_lets_it_in() {
        let mut rig = rig(VirtualLink { lag: 0.02, ..VirtualLink::default() });
        let behind = 0.01 * 0.02 * (1.0 - (-10.0_f64).exp());
        let (_, x, r) = go(&mut rig, 0.002);
        assert!((x - (0.002 - behind)).abs() < 1e-15 && (r - 1000.0 * x).abs() < 1e-12);
        rig.pause(0.04).unwrap();
        let x = rig.read().unwrap().displacement[0];
        assert!((x - (0.002 - behind * (-2.0_f64).exp())).abs() < 1e-15);
    }

    #[test]
    fn settling_takes_rig_time_and_a_rig_that_cannot_settle_holds() {
        let settle = Settle { band: 1e-5, force_rate: 0.0, dwell: 0.3, timeout: 10.0 };
        let link = VirtualLink { lag: 0.02, ..VirtualLink::default() };
        let mut settling = VirtualRig::new(link, settle, Some(&specimen(0.0, 0.0)), 1.0);
        let (time, x, _) = go(&mut settling, 0.002);
        let behind = 0.01 * 0.02 * (1.0 - (-10.0_f64).exp());
        assert!((time - (0.2 + 0.02 * (behind / 1e-5).ln() + 0.3)).abs() < 1e-12);
        assert!((0.002 - x) < 1e-5);
        // 10 % of 2 mm is 0.2 mm: outside 0.01 mm for ever.
        let link = VirtualLink { tracking: 0.1, ..VirtualLink::default() };
        let mut never = VirtualRig::new(link, settle, Some(&specimen(0.0, 0.0)), 1.0);
        never.propose(&[0.002], Some(0.01)).unwrap();
        assert_eq!(never.execute(), Err(RigFault::NotSettled { timeout: 10.0, axis: None }));
        assert!((never.time() - 10.18).abs() < 1e-12);
    }

    #[test]
    fn damping_shows_while_moving_and_friction_stays_through_a_pause() {
        let mut rig = VirtualRig::new(VirtualLink::default(), AT_ONCE, Some(&specimen(50.0, 0.25)), 1.0);
        assert_eq!(rig.read().unwrap().force, [0.0]);
        let mut readings = Vec::new();
        rig.traverse(&[0.002], 0.01, 4, &mut |reading| {
            readings.push(reading);
            Ok(())
        })
        .unwrap();
        let forces: Vec<f64> = readings.iter().map(|reading| reading.force[0]).collect();
        for (force, by_hand) in forces.iter().zip([0.5, 1.0, 1.5, 2.0]) {
            assert!((force - (by_hand + 50.0 * 0.01 + 0.25)).abs() < 1e-12, "{forces:?}");
        }
        assert!((readings[1].time - 0.1).abs() < 1e-15);
        rig.pause(5.0).unwrap();
        assert!((rig.read().unwrap().force[0] - 2.25).abs() < 1e-12);
        assert!((go(&mut rig, 0.001).2 - 0.75).abs() < 1e-12);
        assert!(rig.traverse(&[0.002], -0.01, 4, &mut |_| Ok(())).is_err(), "away from the target");
    }

    #[test]
    fn a_negative_sign_turns_displacement_and_force_between_plan_and_rig() {
        let link = VirtualLink { drift: 3.0, ..VirtualLink::default() };
        let mut turned = VirtualRig::new(link, AT_ONCE, Some(&specimen(0.0, 0.0)), -1.0);
        let (_, x, r) = go(&mut turned, 0.002);
        // Only what the rig adds by itself shows its sign.
        assert!(x == 0.002 && (r - (2.0 - 0.6)).abs() < 1e-12);
    }

    #[test]
    fn refuses_what_it_cannot_do() {
        let mut rig = rig(VirtualLink::default());
        assert!(rig.propose(&[0.0, 0.0], None).is_err());
        assert!(rig.propose(&[f64::NAN], None).is_err());
        assert!(rig.propose(&[0.001], Some(0.0)).is_err());
        assert!(rig.execute().is_err(), "nothing was proposed");
    }
}
