//! The virtual rig of a frame: an actuator and a load cell for each floor, and storeys between them. In: targets, one a floor.
//! Out: readings. As the virtual rig of one degree of freedom its time is simulated; each load cell has a seed of its own.

mod glide;

use super::actuator::Actuator;
use super::load_cell::{LoadCell, to_quantum};
use super::settling::{Unsettled, dying, relaxing_time, settling_time, shared};
use super::virtual_rig::OWN_SPEED;
use super::virtual_rig::glide::Course;
use super::{DeclaredNoise, EachReading, Identity, Offer, Reading, Rig, RigFault};
use crate::mechanics::damping::CellDamping;
use crate::mechanics::frame::{SymmetricBand, drifts, floor_forces};
use crate::mechanics::maxwell::{MaxwellBranch, Travel};
use crate::mechanics::path::Path;
use crate::mechanics::relaxing::Relaxing;
use crate::mechanics::specimen::SpecimenModel;
use crate::plan::{Frame, Settle, Storey, VirtualLink};

/// Several degrees of freedom: floors from the ground up.
pub struct VirtualFrame {
    name: String,
    link: VirtualLink,
    settle: Settle,
    /// +1 or −1, of every axis.
    sign: f64,
    axes: Vec<Axis>,
    structure: Structure,
    /// s
    time: f64,
    /// Where the floors were last bent to (m), and their restoring forces there (N).
    bent: Vec<f64>,
    restoring_force: Vec<f64>,
    /// Targets at the rig (m) and speed of the fastest axis (m/s).
    proposed: Option<(Vec<f64>, f64)>,
    /// The paths that they follow, or were stopped on.
    under_way: Vec<Course>,
}

struct Axis {
    actuator: Actuator,
    cell: LoadCell,
    /// Sums of the sizes of a row of K (N/m) and of what damps the storeys (N·s/m): how fast its force can change as the floors
    /// move.
    stiffness: f64,
    damping: f64,
}

/// What gives the floors their forces.
enum Structure {
    /// `R_i = V_i − V_{i+1}`, V each storey's shear at its drift.
    /// What a storey resists more with the faster it is bent is felt by the cells, and gone at rest; its friction stays.
    Storeys { models: Vec<SpecimenModel>, dampers: Vec<CellDamping>, relaxing: Vec<Relaxing>, drift: Vec<f64>, shear: Vec<f64> },
    /// R = K X.
    Matrix(SymmetricBand),
}

impl Structure {
    fn of(frame: &Frame) -> Self {
        if frame.storeys.is_empty() {
            let order = frame.degrees_of_freedom();
            return Self::Matrix(SymmetricBand::from_dense(&frame.stiffness).unwrap_or_else(|_| SymmetricBand::zero(order, 0)));
        }
        let nothing = vec![0.0; frame.storeys.len()];
        let models = frame.storeys.iter().map(|storey| SpecimenModel::new(&storey.behaviour)).collect();
        let damper = |storey: &Storey| CellDamping::new(storey.damping, storey.coulomb).with_rate_of(&storey.behaviour);
        let dampers = frame.storeys.iter().map(damper).collect();
        let relaxing = frame.storeys.iter().map(|storey| Relaxing::of(&storey.behaviour)).collect();
        Self::Storeys { models, dampers, relaxing, drift: nothing.clone(), shear: nothing }
    }

    /// The floors go to these places (m), each as its travel says.
    fn bend(&mut self, travels: &[Travel], displacement: &[f64], restoring_force: &mut [f64]) {
        match self {
            Self::Storeys { models, relaxing, drift, shear, .. } => {
                let before = drift.clone();
                drifts(displacement, drift);
                let mut below = None;
                let ways = before.into_iter().zip(drift.iter().copied());
                let storeys = models.iter_mut().zip(relaxing).zip(travels).zip(ways).zip(&mut *shear);
                for ((((model, relaxing), floor), way), shear) in storeys {
                    let travel = below.map_or(*floor, |below| floor.less(below));
                    *shear = relaxing.bend(model, &travel, way, *shear);
                    below = Some(floor);
                }
                floor_forces(shear, restoring_force);
            }
            Self::Matrix(stiffness) => stiffness.mul_into(displacement, restoring_force),
        }
    }

    /// What relaxes in the force of a floor: in its own storey and in the one above. A floor's force is the difference of two shears, and
    /// steady where both relax alike: they are taken by their sizes, so that no shear is on its way either.
    fn relaxing_at(&self, floor: usize) -> Vec<&Relaxing> {
        match self {
            Self::Storeys { relaxing, .. } => relaxing.iter().skip(floor).take(2).filter(|storey| !storey.is_none()).collect(),
            Self::Matrix(_) => Vec::new(),
        }
    }

    /// The floors go on at these velocities, m/s: each storey's friction knows its direction.
    fn slide(&mut self, velocities: &[f64]) {
        if let Self::Storeys { dampers, .. } = self {
            for (damper, velocity) in dampers.iter_mut().zip(apart(velocities)) {
                damper.force(velocity);
            }
        }
    }

    /// What the cells feel of the floors' forces at these velocities (m/s), N.
    fn felt(&mut self, velocities: &[f64], restoring_force: &[f64]) -> Vec<f64> {
        let mut felt = restoring_force.to_vec();
        if let Self::Storeys { dampers, relaxing, shear, .. } = self
            && (dampers.iter().any(|damper| !damper.is_none()) || relaxing.iter().any(|storey| !storey.is_none()))
        {
            let relaxing = relaxing.iter().map(Relaxing::force);
            let storeys = dampers.iter_mut().zip(shear).zip(apart(velocities)).zip(relaxing);
            let felt_by = |(((damper, shear), velocity), relaxing): (((&mut CellDamping, &mut f64), f64), f64)| {
                damper.felt(*shear, velocity) + relaxing
            };
            let shears: Vec<f64> = storeys.map(felt_by).collect();
            floor_forces(&shears, &mut felt);
        }
        felt
    }
}

/// Velocities of the drifts, m/s.
fn apart(velocities: &[f64]) -> Vec<f64> {
    let mut apart = vec![0.0; velocities.len()];
    drifts(velocities, &mut apart);
    apart
}

/// Of each floor: the sum of the sizes of its row of the storeys' damping matrix, N·s/m.
fn damping_rows(frame: &Frame) -> Vec<f64> {
    let of = |storey: usize| frame.storeys.get(storey).map_or(0.0, |storey| storey.damping);
    let below = |floor: usize| if floor > 0 { 2.0 * of(floor) } else { of(floor) };
    (0..frame.degrees_of_freedom()).map(|floor| below(floor) + 2.0 * of(floor + 1)).collect()
}

/// The seed of one load cell: the plan's own for the lowest floor.
const fn seed_of(seed: u64, axis: u64) -> u64 {
    // The odd number nearest to 2⁶⁴ over the golden ratio: no two axes of any two near seeds meet.
    seed.wrapping_add(axis.wrapping_mul(0x9e37_79b9_7f4a_7c15))
}

impl VirtualFrame {
    /// At rest, a floor of the frame an axis; `sign` is +1 or −1, and turns what actuators and cells count.
    #[must_use]
    pub fn new(name: &str, link: VirtualLink, settle: Settle, frame: &Frame, sign: f64) -> Self {
        let viscous = damping_rows(frame);
        let axis = |((number, row), damping): ((u64, &Vec<f64>), f64)| Axis {
            actuator: Actuator::new(link.lag, link.tracking),
            cell: LoadCell::new(link.noise, link.force_resolution, link.drift, seed_of(link.seed, number)),
            stiffness: row.iter().map(|entry| entry.abs()).sum(),
            damping,
        };
        let axes: Vec<Axis> = (0..).zip(&frame.stiffness).zip(viscous).map(axis).collect();
        let at_rest = vec![0.0; axes.len()];
        let mut structure = Structure::of(frame);
        let mut restoring_force = at_rest.clone();
        structure.bend(&vec![Travel::rest(0.0); axes.len()], &at_rest, &mut restoring_force);
        Self {
            name: name.to_owned(),
            link,
            settle,
            sign,
            axes,
            structure,
            time: 0.0,
            bent: at_rest,
            restoring_force,
            proposed: None,
            under_way: Vec::new(),
        }
    }

    /// The storeys, and what relaxes in them, follow the pistons.
    fn follow(&mut self, travels: &[Travel]) {
        let mut moved = false;
        for (bent, axis) in self.bent.iter_mut().zip(&self.axes) {
            let position = axis.actuator.position();
            moved |= position != *bent;
            *bent = position;
        }
        if moved {
            let velocities = self.velocities();
            self.structure.slide(&velocities);
        }
        self.structure.bend(travels, &self.bent, &mut self.restoring_force);
    }

    /// Of the pistons, m/s.
    fn velocities(&self) -> Vec<f64> {
        self.axes.iter().map(|axis| axis.actuator.velocity()).collect()
    }

    fn reading(&mut self) -> Reading {
        let (sign, time, resolution) = (self.sign, self.time, self.link.resolution);
        let displacement = self.bent.iter().map(|bent| sign * to_quantum(*bent, resolution)).collect();
        let felt = self.structure.felt(&self.velocities(), &self.restoring_force);
        let force = self.axes.iter_mut().zip(felt).map(|(axis, force)| sign * axis.cell.read(force, time)).collect();
        Reading { time, displacement, force, raw: Vec::new() }
    }

    /// `seconds` pass with the references at rest.
    fn rest(&mut self, seconds: f64) {
        let travels: Vec<Travel> = self.axes.iter_mut().map(|axis| axis.actuator.rest(seconds)).collect();
        self.time += seconds;
        self.follow(&travels);
    }

    /// What moves at each axis, and what relaxes in its force: its own storey and the one above.
    fn unsettled(&self, targets: &[f64], aims: &[f64]) -> Vec<(Unsettled, Vec<MaxwellBranch>)> {
        let axes = self.axes.iter().zip(targets.iter().zip(aims)).enumerate();
        let axis = |(floor, (axis, (target, aim))): (usize, (&Axis, (&f64, &f64)))| {
            let relaxing = self.structure.relaxing_at(floor);
            let unsettled = Unsettled {
                lagging: axis.actuator.lagging(),
                lag: axis.actuator.lag(),
                miss: (target - aim).abs(),
                stiffness: axis.stiffness + relaxing.iter().map(|storey| storey.stiffness()).sum::<f64>(),
                damping: axis.damping,
                drift: self.link.drift,
                rate: None,
            };
            (unsettled, dying(&relaxing))
        };
        axes.map(axis).collect()
    }

    /// Waits until every axis has settled, and every storey's own force with it; false if one does not within the timeout.
    fn settle(&mut self, targets: &[f64], aims: &[f64]) -> bool {
        let longest = |waits: Vec<f64>| waits.into_iter().fold(0.0, f64::max);
        let wait = |(unsettled, branches): &(Unsettled, Vec<MaxwellBranch>)| {
            settling_time(&shared(&self.settle, unsettled, !branches.is_empty()), unsettled)
        };
        let Some(waited) = self.unsettled(targets, aims).iter().map(wait).collect::<Option<Vec<f64>>>().map(longest) else {
            return false;
        };
        self.rest(waited);
        let more =
            |(unsettled, branches): &(Unsettled, Vec<MaxwellBranch>)| relaxing_time(&self.settle, unsettled, branches, waited);
        let more = self.unsettled(targets, aims).iter().map(more).collect::<Option<Vec<f64>>>().map(longest);
        if let Some(more) = more {
            self.rest(more);
        }
        more.is_some()
    }
}

impl Rig for VirtualFrame {
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
        self.axes.len()
    }

    fn time(&self) -> f64 {
        self.time
    }

    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<Offer, RigFault> {
        let refused = |reason: String| Err(RigFault::Device(reason));
        if targets.len() != self.axes.len() {
            return refused(format!("this rig has {} degrees of freedom, not {}", self.axes.len(), targets.len()));
        }
        if let Some(target) = targets.iter().find(|target| !target.is_finite()) {
            return refused(format!("the target {target} m is no place"));
        }
        let speed = speed.unwrap_or(OWN_SPEED);
        if !(speed > 0.0 && speed.is_finite()) {
            return refused(format!("a move at {speed} m/s never arrives"));
        }
        self.proposed = Some((targets.iter().map(|target| self.sign * target).collect(), speed));
        Ok(Offer { targets: targets.to_vec(), speed, wire: Vec::new(), move_id: None, at_the_rig: None })
    }

    /// All axes arrive at once; the one with the farthest way goes at the speed that was asked for.
    fn execute(&mut self) -> Result<(), RigFault> {
        let (targets, speed) =
            self.proposed.take().ok_or_else(|| RigFault::Device("nothing was proposed to execute".to_owned()))?;
        let aims: Vec<f64> = self.axes.iter().zip(&targets).map(|(axis, target)| axis.actuator.aim(*target)).collect();
        let ways = self.axes.iter().zip(&aims).map(|(axis, aim)| (aim - axis.actuator.reference()).abs());
        let seconds = ways.fold(0.0, f64::max) / speed;
        let went = self.axes.iter_mut().zip(&aims).map(|(axis, aim)| axis.actuator.advance(*aim, seconds));
        let travels: Vec<Travel> = went.collect();
        self.time += seconds;
        self.follow(&travels);
        for axis in &mut self.axes {
            axis.actuator.stop();
        }
        let arrived = self.time;
        if self.settle(&targets, &aims) {
            return Ok(());
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

    fn traverse(&mut self, _: &[f64], _: f64, _: usize, _: EachReading<'_>) -> Result<(), RigFault> {
        Err(RigFault::Device("the axes of a frame go to targets: they are not read on the way".to_owned()))
    }

    fn glide(&mut self, paths: &[Path], samples: usize, each: EachReading<'_>) -> Result<(), RigFault> {
        self.under_way.clear();
        self.glide_along(paths, (samples, 0), each)
    }

    fn glide_on(&mut self, paths: &[Path], samples: usize, done: usize, each: EachReading<'_>) -> Result<(), RigFault> {
        self.glide_along(paths, (samples, done), each)
    }

    fn hold(&mut self) {
        for axis in &mut self.axes {
            axis.actuator.hold();
        }
        self.proposed = None;
    }

    fn declared_noise(&self) -> DeclaredNoise {
        DeclaredNoise { force: self.link.noise, resolution: self.link.resolution }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Behaviour;

    const AT_ONCE: Settle = Settle { band: 0.0, force_rate: 0.0, dwell: 0.0, timeout: 60.0 };

    /// Storeys of 3 kN/m and 2 kN/m, the upper one yielding at 4 N.
    fn frame() -> Frame {
        let yielding = Behaviour::Bilinear { stiffness: 2000.0, yield_force: 4.0, hardening: 0.0 };
        Frame::of_storeys(vec![
            Storey::new(1.0, 3000.0, Behaviour::Elastic { stiffness: 3000.0 }),
            Storey::new(1.0, 2000.0, yielding),
        ])
    }

    fn rig(link: VirtualLink) -> VirtualFrame {
        VirtualFrame::new("frame", link, AT_ONCE, &frame(), 1.0)
    }

    fn go(rig: &mut VirtualFrame, targets: [f64; 2]) -> Reading {
        rig.propose(&targets, Some(0.01)).unwrap();
        rig.execute().unwrap();
        rig.read().unwrap()
    }

    #[test]
    fn forces_of_the_floors_are_differences_of_storey_shears() {
        // Drifts 1 mm and 1 mm: shears 3 N and 2 N.
        let reading = go(&mut rig(VirtualLink::default()), [0.001, 0.002]);
        assert_eq!((reading.time, reading.displacement), (0.2, vec![0.001, 0.002]));
        assert!((reading.force[0] - 1.0).abs() < 1e-12 && (reading.force[1] - 2.0).abs() < 1e-12);
        // A drift of 4 mm yields at 4 N.
        let reading = go(&mut rig(VirtualLink::default()), [0.001, 0.005]);
        assert!((reading.force[0] + 1.0).abs() < 1e-12 && (reading.force[1] - 4.0).abs() < 1e-12);
    }

    #[test]
    fn a_full_matrix_gives_r_as_k_x() {
        let matrix = Frame { storeys: Vec::new(), ..frame() };
        let mut rig = VirtualFrame::new("frame", VirtualLink::default(), AT_ONCE, &matrix, -1.0);
        let reading = go(&mut rig, [0.001, 0.005]);
        // K = [5, −2; −2, 2] kN/m.
        assert!((reading.force[0] + 5.0).abs() < 1e-12 && (reading.force[1] - 8.0).abs() < 1e-12, "{:?}", reading.force);
    }

    #[test]
    fn every_load_cell_has_a_noise_of_its_own_that_repeats_by_seed() {
        let forces = |seed| go(&mut rig(VirtualLink { noise: 1.0, seed, ..VirtualLink::default() }), [0.0, 0.0]).force;
        let (first, again) = (forces(7), forces(7));
        assert_eq!(first, again);
        assert_ne!(first[0], first[1]);
        assert_ne!(first, forces(8));
    }

    #[test]
    fn lag_and_tracking_are_each_axes_own() {
        let reading = go(&mut rig(VirtualLink { tracking: 0.1, ..VirtualLink::default() }), [0.001, -0.002]);
        assert!((reading.displacement[0] - 0.0009).abs() < 1e-15 && (reading.displacement[1] + 0.0018).abs() < 1e-15);
        // 0.2 s on the way: the slower axis lags by half as much.
        let reading = go(&mut rig(VirtualLink { lag: 0.02, ..VirtualLink::default() }), [0.001, -0.002]);
        let behind = 0.01 * 0.02 * (1.0 - (-10.0_f64).exp());
        assert!((reading.displacement[1] + 0.002 - behind).abs() < 1e-15);
        assert!((reading.displacement[0] - 0.001 + 0.5 * behind).abs() < 1e-15);
    }

    /// A branch of 1 kN/m and 2 s in the upper storey feels the drift: 1 mm in 0.2 s; and strength that grows with the speed
    /// feels the velocity of the drift while a lagging floor still moves.
    #[test]
    fn what_relaxes_or_gains_with_speed_is_felt_storey_by_storey() {
        let of = || Box::new(Behaviour::Elastic { stiffness: 2000.0 });
        let of_upper = |behaviour| {
            let lower = Storey::new(1.0, 3000.0, Behaviour::Elastic { stiffness: 3000.0 });
            Frame::of_storeys(vec![lower, Storey::new(1.0, 2000.0, behaviour)])
        };
        let relaxing = of_upper(Behaviour::Maxwell { of: of(), stiffness: 1000.0, time_constant: 2.0 });
        let mut rig = VirtualFrame::new("frame", VirtualLink::default(), AT_ONCE, &relaxing, 1.0);
        let (reading, q) = (go(&mut rig, [0.001, 0.002]), 1000.0 * 0.005 * 2.0 * (1.0 - f64::exp(-0.1)));
        assert!((reading.force[1] - 2.0 - q).abs() < 1e-12 && (reading.force[0] - 1.0 + q).abs() < 1e-12, "{reading:?}");
        rig.pause(2.0).unwrap();
        assert!((rig.read().unwrap().force[1] - 2.0 - q / 1f64.exp()).abs() < 1e-12);
        let faster = of_upper(Behaviour::Rate { of: of(), reference_velocity: 0.01, exponent: 0.5 });
        let mut rig = VirtualFrame::new("frame", VirtualLink { lag: 0.1, ..VirtualLink::default() }, AT_ONCE, &faster, 1.0);
        let reading = go(&mut rig, [0.001, 0.003]);
        // Each floor moves at e/lag; the drift is 2 mm less what it lags, 0.3 s on the way.
        let lagging = |way: f64| way / 0.3 * 0.1 * (1.0 - f64::exp(-3.0));
        let (drift, velocity) = (0.002 - lagging(0.002), lagging(0.002) / 0.1);
        let shear = 2000.0 * drift * (1.0 + (velocity / 0.01).sqrt());
        assert!((reading.force[1] - shear).abs() < 1e-12, "{} N is not {shear} N", reading.force[1]);
        rig.pause(5.0).unwrap();
        assert!((rig.read().unwrap().force[1] - 4.0).abs() < 1e-9, "at rest nothing of it is left");
    }

    #[test]
    fn refuses_what_it_cannot_do() {
        let mut rig = rig(VirtualLink::default());
        assert!(rig.propose(&[0.0], None).is_err());
        assert!(rig.propose(&[0.0, f64::NAN], None).is_err());
        assert!(rig.propose(&[0.0, 0.0], Some(0.0)).is_err());
        assert!(rig.execute().is_err(), "nothing was proposed");
        assert!(rig.traverse(&[0.0, 0.1], 0.01, 4, &mut |_| Ok(())).is_err());
    }

    /// Storeys of 3 kN/m and 2 kN/m and, beside each, 1 kN/m that relaxes with 2 s: bent alike by 1 mm, the force of the lower floor
    /// stands from the first moment on, but each shear loses 0.5 N/s at first. 0.02 N/s of both come after 2 ln 50 s.
    #[test]
    fn settles_when_every_storey_has_nearly_relaxed() {
        let relaxing = |stiffness| {
            let of = Box::new(Behaviour::Elastic { stiffness });
            Storey::new(1.0, stiffness, Behaviour::Maxwell { of, stiffness: 1000.0, time_constant: 2.0 })
        };
        let frame = Frame::of_storeys(vec![relaxing(3000.0), relaxing(2000.0)]);
        let settle = Settle { band: 1e-6, force_rate: 0.02, dwell: 0.5, timeout: 60.0 };
        let waited = |settle: Settle| {
            let mut rig = VirtualFrame::new("frame", VirtualLink::default(), settle, &frame, 1.0);
            // Fast, so that nothing relaxes on the way.
            rig.propose(&[0.001, 0.002], Some(1e3)).unwrap();
            rig.execute().map(|()| rig.time())
        };
        let by_hand = 2.0 * (2.0 * 0.5_f64 / 0.02).ln() + settle.dwell;
        let found = waited(settle).unwrap();
        assert!((found - by_hand).abs() < 1e-4, "{found} s, by hand {by_hand} s");
        assert!(waited(Settle { force_rate: 0.0, ..settle }).unwrap() < 0.51, "a band alone does not ask");
        assert_eq!(waited(Settle { timeout: 5.0, ..settle }), Err(RigFault::NotSettled { timeout: 5.0, axis: None }));
    }
}
