//! One ram of a bench, with its transducer and its load cell. In: targets, time, the force that bends it. Out: where it
//! stands and what its sensors read, in SI, with noise, quanta and faults. It knows neither the other rams nor a dialect.

use rand_distr::{Distribution as _, Normal};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng as _;

use super::fault::BenchFaults;
use crate::physics::tracking::trajectory::Path;
use crate::plan::Interval;

/// A target may lie this far beyond a limit and still be on it, m: the last bits of a turn from mm to m.
const ROUNDING: f64 = 1e-12;

/// What a ram and its sensors are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RamSettings {
    /// +1 or −1: how its displacement and force count at the specimen.
    pub sign: f64,
    /// Standard deviation of a force reading, N.
    pub noise: f64,
    /// Quantum of the displacement reading, m; 0: none.
    pub resolution: f64,
    /// Targets outside are a failure of whoever sent them, m.
    pub limits: Interval,
}

#[derive(Debug)]
pub(crate) struct Ram {
    pub(crate) settings: RamSettings,
    generator: Pcg64,
    pub(crate) faults: BenchFaults,
    /// Where it is commanded to be now, m.
    pub(crate) position: f64,
    /// Where a ram without lag would be, m.
    reached: f64,
    /// Where it is, m.
    pub(crate) at: f64,
    /// Where it stood when the specimen was mounted, m: the specimen is bent by the way from there.
    mounted_at: f64,
    pub(crate) target: f64,
    /// m/s
    pub(crate) speed: f64,
    /// On a smooth way, and how long already, s.
    course: Option<(Path, f64)>,
}

impl Ram {
    pub(crate) fn new(settings: RamSettings, seed: u64) -> Self {
        let (generator, faults) = (Pcg64::seed_from_u64(seed), BenchFaults::none(seed));
        Self {
            settings,
            generator,
            faults,
            position: 0.0,
            reached: 0.0,
            at: 0.0,
            mounted_at: 0.0,
            target: 0.0,
            speed: 0.0,
            course: None,
        }
    }

    /// It stands there (m) from the first, with the specimen not bent.
    pub(crate) fn stand_at(&mut self, place: f64) {
        (
            self.position,
            self.reached,
            self.at,
            self.target,
            self.mounted_at,
        ) = (place, place, place, place, place);
    }

    /// By how much it bends the specimen, m.
    pub(crate) fn bends(&self) -> f64 {
        self.at - self.mounted_at
    }

    /// Goes along a smooth way from now on; past its end as fast as there.
    pub(crate) fn follow(&mut self, path: Path) {
        self.target = path.to;
        self.course = Some((path, 0.0));
    }

    /// Sets off to a target (m) at a speed (m/s).
    pub(crate) fn go(&mut self, target: f64, speed: f64) {
        (self.target, self.speed, self.course) = (target, speed, None);
    }

    /// Stops where it is commanded to be.
    pub(crate) fn hold(&mut self) {
        self.go(self.position, 0.0);
    }

    /// Whether it is on a smooth way, or goes on behind one.
    pub(crate) fn glides(&self) -> bool {
        self.course.is_some()
    }

    /// Where it is on its course after `seconds` more, m.
    fn glide(&mut self, seconds: f64) {
        let Some((path, elapsed)) = &mut self.course else {
            return;
        };
        *elapsed += seconds;
        // The end of a way is no less its end for the last bits of a sum of times.
        let past = *elapsed - path.seconds;
        let ended = past > -1e-9;
        self.position = if ended {
            path.to + past.max(0.0) * path.end_velocity
        } else {
            path.place(*elapsed)
        };
        if ended && path.end_velocity == 0.0 {
            self.course = None;
        }
    }

    /// `seconds` pass.
    pub(crate) fn advance(&mut self, seconds: f64) {
        let left = self.target - self.position;
        let before = self.position;
        if self.course.is_some() {
            self.glide(seconds);
        } else if left != 0.0 {
            let way = self.speed * seconds;
            self.position = if left.abs() <= way {
                self.target
            } else {
                self.position + way.copysign(left)
            };
        }
        // A sound ram is at its command to the last bit, which a sum of ways would not be.
        let sound = self.faults.reach == 1.0 && self.reached == before;
        self.reached = if sound {
            self.position
        } else {
            self.reached + self.faults.reach * (self.position - before)
        };
        let follows = if self.faults.lag > 0.0 {
            -(-seconds / self.faults.lag).exp_m1()
        } else {
            1.0
        };
        self.at = if follows == 1.0 {
            self.reached
        } else {
            self.at + follows * (self.reached - self.at)
        };
    }

    /// s of the next `seconds` in which it goes on.
    pub(crate) fn arrives_in(&self, seconds: f64) -> f64 {
        match self.target - self.position {
            _ if self.faults.lag > 0.0 || self.glides() => seconds,
            0.0 => 0.0,
            left => (left.abs() / self.speed).min(seconds),
        }
    }

    pub(crate) fn moving(&self) -> bool {
        self.glides() || self.position != self.target
    }

    /// m/s, signed; 0 at rest.
    pub(crate) fn velocity(&self) -> f64 {
        if let Some((path, elapsed)) = &self.course {
            return path.rate(*elapsed).velocity;
        }
        if self.moving() {
            self.speed * (self.target - self.position).signum()
        } else {
            0.0
        }
    }

    /// Whether a target (m) lies within its limits.
    pub(crate) fn allows(&self, target: f64) -> bool {
        let Interval { low, high } = self.settings.limits;
        low - ROUNDING <= target && target <= high + ROUNDING
    }

    /// m, as its transducer reads it at `time` (s).
    pub(crate) fn displacement(&mut self, time: f64) -> f64 {
        let quantum = self.settings.resolution;
        let read = self.faults.read_displacement(self.at, time);
        if quantum > 0.0 {
            (read / quantum).round() * quantum
        } else {
            read
        }
    }

    /// N, as its cell reads a force that it feels at `time` (s).
    pub(crate) fn force(&mut self, felt: f64, time: f64) -> f64 {
        let noise = Normal::new(0.0, self.settings.noise)
            .map_or(0.0, |normal| normal.sample(&mut self.generator));
        self.faults.read_force(felt + noise, time)
    }
}
