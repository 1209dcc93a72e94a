//! The bench a simulated controller stands on: rams that move at constant speed, a structure that resists, sensors with
//! noise and quanta. In: targets, time. Out: where each ram stands and what it feels, in SI. It speaks no dialect. Most
//! benches have one ram; what is said without a place is said of the first.

use super::bench_fault::BenchFault;
use super::bench_glide::Glides;
use super::ram::{Ram, RamSettings};
use super::structure::Structure;
use crate::plan::{Behaviour, Frame, Interval};

/// What a bench is made of.
#[derive(Clone, Debug)]
pub struct BenchSettings {
    pub behaviour: Behaviour,
    /// c of c·v while it moves, N·s/m.
    pub damping: f64,
    /// Standard deviation of a force reading, N.
    pub noise: f64,
    /// Quantum of the displacement reading, m; 0: none.
    pub resolution: f64,
    /// N per count of a raw converter; its sign is the cell's.
    pub newtons_per_count: f64,
    /// Count at no force.
    pub zero_count: f64,
    pub seed: u64,
    /// Targets outside are a failure of whoever sent them.
    pub limits: Interval,
    /// Fastest it can go, m/s.
    pub top_speed: f64,
}

/// A move the bench was sent on.
#[derive(Clone, Debug, PartialEq)]
pub struct SentMove {
    /// s since power-up.
    pub time: f64,
    /// Number of the move, where the dialect has one.
    pub id: Option<u64>,
    /// One a ram, m.
    pub targets: Vec<f64>,
    /// Of the ram with the farthest way, m/s.
    pub speed: f64,
}

/// The physics behind a simulated controller.
#[derive(Debug)]
pub struct Bench {
    settings: BenchSettings,
    structure: Structure,
    pub(super) rams: Vec<Ram>,
    /// s since power-up.
    pub(super) time: f64,
    /// One a ram, as the specimen has it: N, without noise.
    restoring_force: Vec<f64>,
    /// Force readings so far; of several rams those of the first.
    readings: u64,
    /// Targets that lay outside the limits, m.
    violations: Vec<f64>,
    /// Every target it was sent to, m.
    pub(super) targets: Vec<f64>,
    pub(super) moves: Vec<SentMove>,
    pub(super) glides: Glides,
}

/// The longest part of a smooth way that is taken in one piece, s: a specimen feels its turn no later.
const FINELY: f64 = 1e-3;

/// The seed of one ram: the bench's own for the first.
const fn seed_of(seed: u64, ram: u64) -> u64 {
    seed.wrapping_add(ram.wrapping_mul(0x9e37_79b9_7f4a_7c15))
}

impl Bench {
    /// One ram on a specimen of one degree of freedom.
    #[must_use]
    pub fn new(settings: BenchSettings) -> Self {
        let BenchSettings { noise, resolution, limits, .. } = settings;
        let structure = Structure::of_one(&settings.behaviour, settings.damping);
        // Such a specimen is bent in the rig's own directions.
        Self::standing(settings, structure, &[RamSettings { sign: 1.0, noise, resolution, limits }])
    }

    /// A ram at every floor of a frame, the lowest first. Of the settings only those for all rams count.
    #[must_use]
    pub fn of_frame(settings: BenchSettings, frame: &Frame, rams: &[RamSettings]) -> Self {
        Self::standing(settings, Structure::of_frame(frame), rams)
    }

    fn standing(settings: BenchSettings, structure: Structure, rams: &[RamSettings]) -> Self {
        let ram = |(number, ram): (u64, &RamSettings)| Ram::new(*ram, seed_of(settings.seed, number));
        let mut bench = Self {
            structure,
            rams: (0..).zip(rams).map(ram).collect(),
            settings,
            time: 0.0,
            restoring_force: Vec::new(),
            readings: 0,
            violations: Vec::new(),
            targets: Vec::new(),
            moves: Vec::new(),
            glides: Glides::default(),
        };
        bench.restoring_force = bench.structure.bend(&vec![0.0; rams.len()]);
        bench
    }

    /// The same bench with friction on its cell, N: against the last motion, also through a pause, as a virtual rig has it.
    #[must_use]
    pub const fn with_friction(mut self, friction: f64) -> Self {
        self.structure.set_friction(friction);
        self
    }

    /// Something goes wrong now with the ram at this place, its specimen or its sensors.
    pub fn strike(&mut self, ram: usize, fault: BenchFault) {
        let time = self.time;
        if let Some(ram) = self.rams.get_mut(ram) {
            ram.faults.strike(fault, time);
        }
    }

    /// Something goes wrong at any force reading of the ram at this place, with a probability.
    pub fn strike_by_chance(&mut self, ram: usize, fault: BenchFault, probability: f64) {
        if let Some(ram) = self.rams.get_mut(ram) {
            ram.faults.strike_by_chance(fault, probability);
        }
    }

    #[must_use]
    pub const fn settings(&self) -> &BenchSettings {
        &self.settings
    }

    /// How many rams it has.
    #[must_use]
    pub const fn rams(&self) -> usize {
        self.rams.len()
    }

    /// Where targets of the ram at this place may lie, m.
    #[must_use]
    pub fn limits_of(&self, ram: usize) -> Interval {
        self.rams[ram].settings.limits
    }

    /// s since power-up.
    #[must_use]
    pub const fn time(&self) -> f64 {
        self.time
    }

    /// Brings the bench to a later moment, s.
    pub fn advance(&mut self, to: f64) {
        while let Some(until) = self.next_glide().filter(|until| *until < to) {
            self.pass(until);
            self.begin_next_glide();
        }
        self.pass(to);
    }

    /// Nothing is told to the rams before that moment, s.
    fn pass(&mut self, to: f64) {
        while self.rams.iter().any(Ram::glides) && to - self.time > FINELY {
            self.take(self.time + FINELY);
        }
        self.take(to);
    }

    fn take(&mut self, to: f64) {
        let seconds = to - self.time;
        if seconds.is_nan() || seconds <= 0.0 {
            return;
        }
        self.time = to;
        if self.moving() {
            let velocities = self.velocities();
            self.structure.goes(&velocities);
        }
        // All arrive together; a ram that lags goes all the time.
        let going = self.rams.iter().map(|ram| ram.arrives_in(seconds)).fold(0.0, f64::max);
        let before: Vec<f64> = self.rams.iter().map(|ram| ram.at).collect();
        for ram in &mut self.rams {
            ram.advance(seconds);
        }
        let moved: Vec<f64> = self.rams.iter().zip(before).map(|(ram, before)| ram.settings.sign * (ram.at - before)).collect();
        self.structure.relax(&moved, going, seconds);
        if moved.iter().any(|moved| *moved != 0.0) {
            let places: Vec<f64> = self.rams.iter().map(|ram| ram.settings.sign * ram.at).collect();
            let forces = self.structure.bend(&places);
            let felt = self.rams.iter_mut().zip(forces).map(|(ram, force)| ram.faults.specimen_force(ram.at, force));
            self.restoring_force = felt.collect();
        }
    }

    /// Sets off to `target` (m) at `speed` (m/s).
    pub fn go(&mut self, target: f64, speed: f64) {
        self.go_as(None, &[target], speed);
    }

    /// Sets off to a target a ram (m) for a move that may have a number: all arrive together, the one with the farthest way
    /// at `speed` (m/s).
    pub fn go_as(&mut self, id: Option<u64>, targets: &[f64], speed: f64) {
        let speed = speed.abs().min(self.settings.top_speed);
        let farthest = self.rams.iter().zip(targets).map(|(ram, to)| (to - ram.position).abs()).fold(0.0, f64::max);
        for (ram, target) in (0..self.rams.len()).zip(targets) {
            self.judge(ram, *target);
            self.targets.push(*target);
            let ram = &mut self.rams[ram];
            let way = (target - ram.position).abs();
            ram.go(*target, if way == farthest { speed } else { speed * (way / farthest) });
        }
        self.moves.push(SentMove { time: self.time, id, targets: targets.to_vec(), speed });
    }

    /// The controller refused a target (m): it goes nowhere, but was asked to.
    pub fn refuse(&mut self, target: f64) {
        self.judge(0, target);
    }

    /// The same of targets, one a ram.
    pub fn refuse_all(&mut self, targets: &[f64]) {
        for (ram, target) in (0..self.rams.len()).zip(targets) {
            self.judge(ram, *target);
        }
    }

    pub(super) fn judge(&mut self, ram: usize, target: f64) {
        if !self.rams[ram].allows(target) {
            self.violations.push(target);
        }
    }

    /// Stops where it stands.
    pub fn hold(&mut self) {
        self.glides.clear();
        for ram in &mut self.rams {
            ram.hold();
        }
    }

    /// Whether any ram does.
    #[must_use]
    pub fn moving(&self) -> bool {
        self.rams.iter().any(Ram::moving)
    }

    /// Where it is commanded to be now, m: what a controller knows that counts its own steps.
    #[must_use]
    pub fn commanded(&self) -> f64 {
        self.commanded_of(0)
    }

    #[must_use]
    pub fn commanded_of(&self, ram: usize) -> f64 {
        self.rams[ram].position
    }

    /// m, as its transducer reads it.
    pub fn displacement(&mut self) -> f64 {
        self.displacement_of(0)
    }

    pub fn displacement_of(&mut self, ram: usize) -> f64 {
        self.rams[ram].displacement(self.time)
    }

    /// N, as its cell feels it, with noise.
    pub fn force(&mut self) -> f64 {
        self.force_of(0)
    }

    pub fn force_of(&mut self, ram: usize) -> f64 {
        self.readings += u64::from(ram == 0);
        let velocities = self.velocities();
        let felt = self.structure.felt(&self.restoring_force, &velocities)[ram];
        let ram = &mut self.rams[ram];
        let at_the_cell = ram.settings.sign * felt;
        ram.force(at_the_cell, self.time)
    }

    /// Of each ram, as the specimen has it, m/s.
    fn velocities(&self) -> Vec<f64> {
        self.rams.iter().map(|ram| ram.settings.sign * ram.velocity()).collect()
    }

    /// The force as a raw converter of 24 bits gives it.
    pub fn counts(&mut self) -> i64 {
        let force = self.force();
        self.counts_of(force)
    }

    /// What a raw converter of 24 bits makes of a force, N.
    #[must_use]
    pub fn counts_of(&self, force: f64) -> i64 {
        let count = force / self.settings.newtons_per_count + self.settings.zero_count;
        #[expect(clippy::cast_possible_truncation, reason = "clamped to 24 bits")]
        let count = count.round().clamp(-8_388_608.0, 8_388_607.0) as i64;
        count
    }

    /// What the controller puts where a force of the ram at this place stands: `ordinary`, unless a fault has something else
    /// for it. To be asked once for each number sent.
    pub fn shown_force(&mut self, ram: usize, ordinary: String) -> String {
        self.rams[ram].faults.take_number().unwrap_or(ordinary)
    }

    /// Force readings so far; of several rams those of the first.
    #[must_use]
    pub const fn readings(&self) -> u64 {
        self.readings
    }

    /// Every move it was sent on, in order.
    #[must_use]
    pub fn moves(&self) -> &[SentMove] {
        &self.moves
    }

    /// Targets that lay outside the limits, m.
    #[must_use]
    pub fn violations(&self) -> &[f64] {
        &self.violations
    }

    /// Every target it was sent to, m, in order; of several rams one after the other.
    #[must_use]
    pub fn targets(&self) -> &[f64] {
        &self.targets
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::bench;
    use super::*;
    use crate::plan::Storey;

    #[test]
    fn it_moves_evenly_and_stops_at_its_target() {
        let mut bench = bench();
        bench.go(0.005, 0.002);
        bench.advance(1.0);
        assert!((bench.displacement() - 0.002).abs() < 1e-12 && bench.moving());
        assert!((bench.force() - 200.0).abs() < 1e-9);
        assert_eq!(bench.counts(), 1000 - 20_000);
        bench.advance(10.0);
        assert!((bench.displacement() - 0.005).abs() < 1e-12 && !bench.moving());
        bench.go(0.02, 1.0);
        bench.advance(10.1);
        bench.hold();
        bench.advance(20.0);
        assert!((bench.displacement() - 0.006).abs() < 1e-12, "no faster than it can");
        assert_eq!((bench.violations(), bench.targets().len()), (&[0.02][..], 2));
        assert_eq!(bench.moves()[1], SentMove { time: 10.0, id: None, targets: vec![0.02], speed: 0.01 });
        bench.refuse(f64::NAN);
        assert_eq!(bench.violations().len(), 2, "what is no number is outside");
    }

    #[test]
    fn friction_stays_at_rest_and_viscous_damping_does_not() {
        let mut bench = bench().with_friction(3.0);
        assert_eq!(bench.force(), 0.0, "not before the first motion");
        bench.go(0.005, 0.01);
        bench.advance(1.0);
        assert!((bench.force() - 503.0).abs() < 1e-9);
        bench.go(0.004, 0.01);
        bench.advance(2.0);
        assert!((bench.force() - 397.0).abs() < 1e-9, "it is against the last motion");
    }

    /// The bench sent to 5 mm, a second after `fault` struck: displacement in mm, force in N.
    fn after(fault: BenchFault) -> (f64, f64) {
        let mut bench = bench();
        bench.strike(0, fault);
        bench.go(0.005, 0.01);
        for tick in 1..=100 {
            bench.advance(f64::from(tick) * 0.01);
        }
        assert!(!bench.moving(), "the controller takes it for done");
        (bench.displacement() * 1e3, bench.force())
    }

    #[test]
    fn each_fault_spoils_what_it_names() {
        let near = |found: (f64, f64), expected: (f64, f64)| {
            assert!((found.0 - expected.0).abs() < 2e-3 && (found.1 - expected.1).abs() < 0.2, "{found:?} is not {expected:?}");
        };
        near(after(BenchFault::Reach(0.4)), (2.0, 200.0));
        near(after(BenchFault::Reach(0.0)), (0.0, 0.0));
        // A ramp of 0.5 s followed with 0.2 s: short by v τ (1 − e^(−T/τ)) at its end, less e^(−t/τ) half a second later.
        let short = 10.0 * 0.2 * (1.0 - f64::exp(-2.5)) * f64::exp(-2.5);
        let (lagging, _) = after(BenchFault::Lag(0.2));
        assert!((lagging - (5.0 - short)).abs() < 0.01, "{lagging} mm");
        near(after(BenchFault::ScaleForce(-1.0)), (5.0, -500.0));
        near(after(BenchFault::ScaleDisplacement(25.4)), (127.0, 500.0));
        near(after(BenchFault::ClipForce(350.0)), (5.0, 350.0));
        near(after(BenchFault::Drift(3.0)), (5.0, 503.0));
        near(after(BenchFault::DriftDisplacement(2e-4)), (5.2, 500.0));
        near(after(BenchFault::Spike(70.0)), (5.0, 570.0));
        near(after(BenchFault::Fracture { displacement: 0.003, left: 0.1 }), (5.0, 50.0));
    }

    #[test]
    fn a_frozen_sensor_stays_and_a_spike_passes() {
        let mut bench = bench();
        bench.strike(0, BenchFault::FreezeForce);
        bench.strike(0, BenchFault::Spike(7.0));
        assert_eq!(bench.force(), 7.0);
        bench.go(0.005, 0.01);
        bench.advance(1.0);
        assert_eq!((bench.force(), bench.readings()), (7.0, 2));
        bench.strike(0, BenchFault::Number("OVL".to_owned()));
        assert_eq!(bench.shown_force(0, "1.0".to_owned()), "OVL");
        assert_eq!(bench.shown_force(0, "1.0".to_owned()), "1.0");
    }

    #[test]
    fn a_fault_by_chance_comes_about_as_often_as_said() {
        let mut bench = bench();
        bench.strike_by_chance(0, BenchFault::Spike(100.0), 0.1);
        let spikes = (0..10_000).filter(|_| bench.force() == 100.0).count();
        assert!((850..1150).contains(&spikes), "{spikes} of 10 000, expected 1000 with a deviation of 30");
    }

    const RAM: RamSettings = RamSettings { sign: 1.0, noise: 0.0, resolution: 0.0, limits: Interval { low: -0.01, high: 0.01 } };

    /// Storeys of 3 kN/m and 2 kN/m, the upper one yielding at 4 N.
    fn frame() -> Frame {
        let yielding = Behaviour::Bilinear { stiffness: 2000.0, yield_force: 4.0, hardening: 0.0 };
        Frame::of_storeys(vec![
            Storey::new(1.0, 3000.0, Behaviour::Elastic { stiffness: 3000.0 }),
            Storey::new(1.0, 2000.0, yielding),
        ])
    }

    #[test]
    fn rams_of_a_frame_arrive_together_and_feel_differences_of_storey_shears() {
        let settings = bench().settings().clone();
        let mut bench = Bench::of_frame(settings.clone(), &frame(), &[RAM, RAM]);
        bench.go_as(Some(1), &[0.001, 0.002], 0.01);
        bench.advance(0.1);
        // Half the way: drifts of half a millimetre, shears 1.5 N and 1 N.
        assert!((bench.commanded_of(0) - 0.0005).abs() < 1e-15 && (bench.commanded_of(1) - 0.001).abs() < 1e-15);
        assert!((bench.force_of(0) - 0.5).abs() < 1e-12 && (bench.force_of(1) - 1.0).abs() < 1e-12);
        bench.advance(0.21);
        assert!(!bench.moving());
        // A drift of 4 mm yields at 4 N.
        bench.go_as(Some(2), &[0.001, 0.005], 0.01);
        bench.advance(1.0);
        assert!((bench.force_of(0) + 1.0).abs() < 1e-12 && (bench.force_of(1) - 4.0).abs() < 1e-12);
        assert_eq!((bench.readings(), bench.targets().len()), (2, 4), "readings of the first ram");
        bench.go_as(Some(3), &[0.0, 0.02], 0.01);
        assert_eq!(bench.violations(), [0.02]);
        let turned = RamSettings { sign: -1.0, ..RAM };
        let matrix = Frame { storeys: Vec::new(), ..frame() };
        let mut bench = Bench::of_frame(settings, &matrix, &[RAM, turned]);
        bench.go_as(None, &[0.001, -0.005], 0.01);
        bench.advance(1.0);
        // K = [5, −2; −2, 2] kN/m at (1, 5) mm; the second ram counts the other way round.
        assert!((bench.force_of(0) + 5.0).abs() < 1e-12 && (bench.force_of(1) + 8.0).abs() < 1e-12);
    }

    #[test]
    fn each_ram_has_faults_and_a_noise_of_its_own() {
        let noisy = RamSettings { noise: 1.0, ..RAM };
        let mut bench = Bench::of_frame(bench().settings().clone(), &frame(), &[noisy, noisy]);
        assert_ne!(bench.force_of(0), bench.force_of(1));
        bench.strike(1, BenchFault::FreezeForce);
        let frozen = bench.force_of(1);
        assert!(bench.force_of(1) == frozen && bench.force_of(0) != bench.force_of(0));
    }

    /// 100 kN/m at 1 mm, beside it 50 kN/m of 2 s, after 0.1 s on the way at 10 mm/s: as a virtual rig has it, whatever the ticks.
    #[test]
    fn what_relaxes_beside_a_specimen_is_felt_also_at_rest() {
        let of = Box::new(Behaviour::Elastic { stiffness: 1e5 });
        let behaviour = Behaviour::Maxwell { of, stiffness: 5e4, time_constant: 2.0 };
        let mut relaxing = Bench::new(BenchSettings { behaviour, noise: 0.0, damping: 0.0, ..bench().settings().clone() });
        relaxing.go(0.001, 0.01);
        for tick in 1..=40 {
            relaxing.advance(f64::from(tick) * 0.025);
        }
        let held = 5e4 * 0.01 * 2.0 * (1.0 - f64::exp(-0.05)) * f64::exp(-0.45);
        assert!((relaxing.force() - 100.0 - held).abs() < 1e-9, "{} N", relaxing.force());
    }
}
