//! The bench a simulated controller stands on: an axis that moves at constant speed, a specimen that resists, sensors
//! with noise and quanta. In: targets, time. Out: where it stands and what it feels, in SI. It speaks no dialect.

use rand_distr::{Distribution as _, Normal};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng as _;

use crate::mechanics::specimen::{RestoringForce, SpecimenModel};
use crate::plan::{Behaviour, Interval};

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

/// The physics behind a simulated controller.
#[derive(Debug)]
pub struct Bench {
    settings: BenchSettings,
    specimen: SpecimenModel,
    generator: Pcg64,
    /// s since power-up.
    time: f64,
    /// m
    position: f64,
    target: f64,
    /// m/s
    speed: f64,
    /// N, without noise.
    restoring_force: f64,
    /// Targets that lay outside the limits, m.
    violations: Vec<f64>,
    /// Every target it was sent to, m.
    targets: Vec<f64>,
}

impl Bench {
    #[must_use]
    pub fn new(settings: BenchSettings) -> Self {
        let mut specimen = SpecimenModel::new(&settings.behaviour);
        let restoring_force = specimen.move_to(0.0);
        let generator = Pcg64::seed_from_u64(settings.seed);
        Self {
            settings,
            specimen,
            generator,
            time: 0.0,
            position: 0.0,
            target: 0.0,
            speed: 0.0,
            restoring_force,
            violations: Vec::new(),
            targets: Vec::new(),
        }
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
        if left != 0.0 {
            let way = self.speed * seconds;
            self.position = if left.abs() <= way { self.target } else { self.position + way.copysign(left) };
            self.restoring_force = self.specimen.move_to(self.position);
        }
    }

    /// Sets off to `target` (m) at `speed` (m/s).
    pub fn go(&mut self, target: f64, speed: f64) {
        if !self.settings.limits.contains(target) {
            self.violations.push(target);
        }
        self.targets.push(target);
        self.target = target;
        self.speed = speed.abs().min(self.settings.top_speed);
    }

    /// Stops where it stands.
    pub const fn hold(&mut self) {
        self.target = self.position;
    }

    #[must_use]
    pub fn moving(&self) -> bool {
        self.position != self.target
    }

    /// m, as its transducer reads it.
    #[must_use]
    pub fn displacement(&self) -> f64 {
        let quantum = self.settings.resolution;
        if quantum > 0.0 { (self.position / quantum).round() * quantum } else { self.position }
    }

    /// N, as its cell feels it, with noise.
    pub fn force(&mut self) -> f64 {
        let velocity = if self.moving() { self.speed.copysign(self.target - self.position) } else { 0.0 };
        let noise = Normal::new(0.0, self.settings.noise).map_or(0.0, |normal| normal.sample(&mut self.generator));
        self.restoring_force + self.settings.damping * velocity + noise
    }

    /// The force as a raw converter of 24 bits gives it.
    pub fn counts(&mut self) -> i64 {
        let count = self.force() / self.settings.newtons_per_count + self.settings.zero_count;
        #[expect(clippy::cast_possible_truncation, reason = "clamped to 24 bits")]
        let count = count.round().clamp(-8_388_608.0, 8_388_607.0) as i64;
        count
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
    use super::*;

    fn bench() -> Bench {
        Bench::new(BenchSettings {
            behaviour: Behaviour::Elastic { stiffness: 1e5 },
            damping: 0.0,
            noise: 0.0,
            resolution: 1e-6,
            newtons_per_count: -0.01,
            zero_count: 1000.0,
            seed: 1,
            limits: Interval { low: -0.001, high: 0.01 },
            top_speed: 0.01,
        })
    }

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
    }
}
