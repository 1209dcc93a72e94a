//! The bench a simulated controller stands on: an axis that moves at constant speed, a specimen that resists, sensors
//! with noise and quanta. In: targets, time. Out: where it stands and what it feels, in SI. It speaks no dialect.

use rand_distr::{Distribution as _, Normal};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng as _;

use super::bench_fault::{BenchFault, BenchFaults};
use crate::mechanics::damping::CellDamping;
use crate::mechanics::maxwell::{MaxwellBranch, Travel};
use crate::mechanics::specimen::{RestoringForce, SpecimenModel};
use crate::plan::{Behaviour, Interval};

/// A target may lie this far beyond a limit and still be on it, m: the last bits of a turn from mm to m.
const ROUNDING: f64 = 1e-12;

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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SentMove {
    /// s since power-up.
    pub time: f64,
    /// Number of the move, where the dialect has one.
    pub id: Option<u64>,
    /// m
    pub target: f64,
    /// m/s
    pub speed: f64,
}

/// The physics behind a simulated controller.
#[derive(Debug)]
pub struct Bench {
    settings: BenchSettings,
    specimen: SpecimenModel,
    generator: Pcg64,
    /// s since power-up.
    time: f64,
    /// Where the ram is commanded to be now, m.
    position: f64,
    /// Where a ram without lag would be, m.
    reached: f64,
    /// Where the ram is, m.
    ram: f64,
    target: f64,
    /// m/s
    speed: f64,
    /// N, without noise.
    restoring_force: f64,
    /// What the cell feels beside it.
    damping: CellDamping,
    /// What relaxes beside the specimen.
    branches: Vec<MaxwellBranch>,
    faults: BenchFaults,
    /// Force readings so far.
    readings: u64,
    /// Targets that lay outside the limits, m.
    violations: Vec<f64>,
    /// Every target it was sent to, m.
    targets: Vec<f64>,
    moves: Vec<SentMove>,
}

impl Bench {
    #[must_use]
    pub fn new(settings: BenchSettings) -> Self {
        let mut specimen = SpecimenModel::new(&settings.behaviour);
        let restoring_force = specimen.move_to(0.0);
        let generator = Pcg64::seed_from_u64(settings.seed);
        let faults = BenchFaults::none(settings.seed);
        let damping = CellDamping::new(settings.damping, 0.0).with_rate_of(&settings.behaviour);
        let branches = MaxwellBranch::all_of(&settings.behaviour);
        Self {
            settings,
            specimen,
            generator,
            time: 0.0,
            position: 0.0,
            reached: 0.0,
            ram: 0.0,
            target: 0.0,
            speed: 0.0,
            restoring_force,
            damping,
            branches,
            faults,
            readings: 0,
            violations: Vec::new(),
            targets: Vec::new(),
            moves: Vec::new(),
        }
    }

    /// The same bench with friction on its cell, N: against the last motion, also through a pause, as a virtual rig has it.
    #[must_use]
    pub const fn with_friction(mut self, friction: f64) -> Self {
        self.damping.coulomb = friction;
        self
    }

    /// Something goes wrong now.
    pub fn strike(&mut self, fault: BenchFault) {
        self.faults.strike(fault, self.time);
    }

    /// Something goes wrong at any force reading, with a probability.
    pub fn strike_by_chance(&mut self, fault: BenchFault, probability: f64) {
        self.faults.strike_by_chance(fault, probability);
    }

    #[must_use]
    pub const fn settings(&self) -> &BenchSettings {
        &self.settings
    }

    /// s since power-up.
    #[must_use]
    pub const fn time(&self) -> f64 {
        self.time
    }

    /// Brings the bench to a later moment, s.
    pub fn advance(&mut self, to: f64) {
        let seconds = to - self.time;
        if seconds.is_nan() || seconds <= 0.0 {
            return;
        }
        self.time = to;
        let left = self.target - self.position;
        let before = self.position;
        if left != 0.0 {
            self.damping.last_direction = left.signum();
            let way = self.speed * seconds;
            self.position = if left.abs() <= way { self.target } else { self.position + way.copysign(left) };
        }
        // A sound ram is at its command to the last bit, which a sum of ways would not be.
        let sound = self.faults.reach == 1.0 && self.reached == before;
        self.reached = if sound { self.position } else { self.reached + self.faults.reach * (self.position - before) };
        let follows = if self.faults.lag > 0.0 { -(-seconds / self.faults.lag).exp_m1() } else { 1.0 };
        let ram = if follows == 1.0 { self.reached } else { self.ram + follows * (self.reached - self.ram) };
        // Evenly while it goes, the rest at rest; a ram that lags goes all the time.
        let going = if follows == 1.0 && left != 0.0 { (left.abs() / self.speed).min(seconds) } else { seconds };
        for branch in &mut self.branches {
            branch.follow(&Travel::even((ram - self.ram) / going, going));
            branch.follow(&Travel::rest(seconds - going));
        }
        if ram != self.ram {
            self.ram = ram;
            self.restoring_force = self.faults.specimen_force(ram, self.specimen.move_to(ram));
        }
    }

    /// Sets off to `target` (m) at `speed` (m/s).
    pub fn go(&mut self, target: f64, speed: f64) {
        self.go_as(None, target, speed);
    }

    /// Sets off to `target` (m) at `speed` (m/s) for a move that has a number.
    pub fn go_as(&mut self, id: Option<u64>, target: f64, speed: f64) {
        self.judge(target);
        self.targets.push(target);
        self.target = target;
        self.speed = speed.abs().min(self.settings.top_speed);
        self.moves.push(SentMove { time: self.time, id, target, speed: self.speed });
    }

    /// The controller refused a target (m): it goes nowhere, but was asked to.
    pub fn refuse(&mut self, target: f64) {
        self.judge(target);
    }

    fn judge(&mut self, target: f64) {
        let Interval { low, high } = self.settings.limits;
        let within = low - ROUNDING <= target && target <= high + ROUNDING;
        if !within {
            self.violations.push(target);
        }
    }

    /// Stops where it stands.
    pub const fn hold(&mut self) {
        self.target = self.position;
    }

    #[must_use]
    pub fn moving(&self) -> bool {
        self.position != self.target
    }

    /// Where it is commanded to be now, m: what a controller knows that counts its own steps.
    #[must_use]
    pub const fn commanded(&self) -> f64 {
        self.position
    }

    /// m, as its transducer reads it.
    pub fn displacement(&mut self) -> f64 {
        let quantum = self.settings.resolution;
        let read = self.faults.read_displacement(self.ram);
        if quantum > 0.0 { (read / quantum).round() * quantum } else { read }
    }

    /// N, as its cell feels it, with noise.
    pub fn force(&mut self) -> f64 {
        self.readings += 1;
        let way = if self.moving() { (self.target - self.position).signum() } else { 0.0 };
        let noise = Normal::new(0.0, self.settings.noise).map_or(0.0, |normal| normal.sample(&mut self.generator));
        let relaxing: f64 = self.branches.iter().map(MaxwellBranch::force).sum();
        let felt = self.damping.felt(self.restoring_force, self.speed * way) + relaxing + noise;
        self.faults.read_force(felt, self.time)
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

    /// What the controller puts where a force stands: `ordinary`, unless a fault has something else for it. To be asked
    /// once for each number sent.
    pub fn shown_force(&mut self, ordinary: String) -> String {
        self.faults.take_number().unwrap_or(ordinary)
    }

    /// Force readings so far.
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

    /// Every target it was sent to, m, in order.
    #[must_use]
    pub fn targets(&self) -> &[f64] {
        &self.targets
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::bench;
    use super::*;

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
        assert_eq!(bench.moves()[1], SentMove { time: 10.0, id: None, target: 0.02, speed: 0.01 });
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
        bench.strike(fault);
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
        near(after(BenchFault::Spike(70.0)), (5.0, 570.0));
        near(after(BenchFault::Fracture { displacement: 0.003, left: 0.1 }), (5.0, 50.0));
    }

    #[test]
    fn a_frozen_sensor_stays_and_a_spike_passes() {
        let mut bench = bench();
        bench.strike(BenchFault::FreezeForce);
        bench.strike(BenchFault::Spike(7.0));
        assert_eq!(bench.force(), 7.0);
        bench.go(0.005, 0.01);
        bench.advance(1.0);
        assert_eq!((bench.force(), bench.readings()), (7.0, 2));
        bench.strike(BenchFault::Number("OVL".to_owned()));
        assert_eq!(bench.shown_force("1.0".to_owned()), "OVL");
        assert_eq!(bench.shown_force("1.0".to_owned()), "1.0");
    }

    #[test]
    fn a_fault_by_chance_comes_about_as_often_as_said() {
        let mut bench = bench();
        bench.strike_by_chance(BenchFault::Spike(100.0), 0.1);
        let spikes = (0..10_000).filter(|_| bench.force() == 100.0).count();
        assert!((850..1150).contains(&spikes), "{spikes} of 10 000, expected 1000 with a deviation of 30");
    }
}
