//! One actuator of an emulated rig, with its transducer and its load cell. In: targets, time, the force on it. Out: its position and
//! the readings of its sensors, in SI, with noise, quantization and faults. It knows neither the other actuators nor a
//! protocol.

use rand_distr::{Distribution as _, Normal};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng as _;

use super::fault::MechanicalFaults;
use psd_physics::tracking::trajectory::Path;
use psd_plan::Interval;

/// Tolerance of a limit \[m\]: a target can exceed it by the rounding errors of the conversion from mm to m.
const ROUNDING: f64 = 1e-12;

/// The properties of an actuator and its sensors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActuatorSettings {
    /// Polarity (+1 or −1) of its displacement and force at the specimen.
    pub sign: f64,
    /// Standard deviation of a force reading \[N\].
    pub noise: f64,
    /// Quantization step of the displacement reading \[m\]; 0: none.
    pub resolution: f64,
    /// Limits of the target \[m\]. The emulator logs a target outside them as a failure of the host.
    pub limits: Interval,
}

#[derive(Debug)]
pub struct ActuatorModel {
    pub settings: ActuatorSettings,
    generator: Pcg64,
    pub faults: MechanicalFaults,
    /// The present commanded position \[m\].
    pub position: f64,
    /// The position without lag \[m\].
    reached: f64,
    /// The true position \[m\].
    pub at: f64,
    /// The position at which the specimen was mounted \[m\]. The specimen's displacement is measured from it.
    mounted_at: f64,
    pub target: f64,
    /// m/s
    pub speed: f64,
    /// The smooth move and the time since its start \[s\].
    course: Option<(Path, f64)>,
}

impl ActuatorModel {
    pub fn new(settings: ActuatorSettings, seed: u64) -> Self {
        let (generator, faults) = (Pcg64::seed_from_u64(seed), MechanicalFaults::none(seed));
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

    /// Moves to this initial position \[m\] with the specimen undeformed.
    pub fn stand_at(&mut self, position: f64) {
        (
            self.position,
            self.reached,
            self.at,
            self.target,
            self.mounted_at,
        ) = (position, position, position, position, position);
    }

    /// It is this far from its initial position \[m\], wherever it was.
    pub fn come_to(&mut self, displacement: f64) {
        let position = self.mounted_at + displacement;
        (self.position, self.reached, self.at, self.target) =
            (position, position, position, position);
    }

    /// The displacement of the specimen \[m\].
    pub fn bends(&self) -> f64 {
        self.at - self.mounted_at
    }

    /// Follows a smooth path from now on. Past its end it keeps the final velocity.
    pub fn follow(&mut self, path: Path) {
        self.target = path.to;
        self.course = Some((path, 0.0));
    }

    /// Starts a move to a target \[m\] at a speed \[m/s\].
    pub fn go(&mut self, target: f64, speed: f64) {
        (self.target, self.speed, self.course) = (target, speed, None);
    }

    /// Stops at the commanded position.
    pub fn hold(&mut self) {
        self.go(self.position, 0.0);
    }

    /// Whether it is on a smooth path, or continues after one.
    pub fn follows_path(&self) -> bool {
        self.course.is_some()
    }

    /// Its position on its path after a further `seconds` \[m\].
    fn advance_on_path(&mut self, seconds: f64) {
        let Some((path, elapsed)) = &mut self.course else {
            return;
        };
        *elapsed += seconds;
        // Rounding errors in the sum of the times must not change the end of the path.
        let past = *elapsed - path.seconds;
        let ended = past > -1e-9;
        self.position = if ended {
            path.to + past.max(0.0) * path.end_velocity
        } else {
            path.position(*elapsed)
        };
        if ended && path.end_velocity == 0.0 {
            self.course = None;
        }
    }

    /// Advances the time by `seconds`.
    pub fn advance(&mut self, seconds: f64) {
        let left = self.target - self.position;
        let before = self.position;
        if self.course.is_some() {
            self.advance_on_path(seconds);
        } else if left != 0.0 {
            // A distance within the rounding of the position is none: no sum would ever reach its end.
            let travel = (self.speed * seconds).max(f64::EPSILON * self.target.abs());
            self.position = if left.abs() <= travel {
                self.target
            } else {
                self.position + travel.copysign(left)
            };
        }
        // The position of an actuator without faults equals its command exactly. A sum of increments would have rounding
        // errors.
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

    /// The part of the next `seconds` during which it moves \[s\].
    pub fn arrives_in(&self, seconds: f64) -> f64 {
        match self.target - self.position {
            _ if self.faults.lag > 0.0 || self.follows_path() => seconds,
            0.0 => 0.0,
            left => (left.abs() / self.speed).min(seconds),
        }
    }

    pub fn moving(&self) -> bool {
        self.follows_path() || self.position != self.target
    }

    /// Velocity with its sign \[m/s\]; 0 at rest.
    pub fn velocity(&self) -> f64 {
        if let Some((path, elapsed)) = &self.course {
            return path.rate(*elapsed).velocity;
        }
        if self.moving() {
            self.speed * (self.target - self.position).signum()
        } else {
            0.0
        }
    }

    /// Whether a target \[m\] is within its limits.
    pub fn allows(&self, target: f64) -> bool {
        let Interval { low, high } = self.settings.limits;
        low - ROUNDING <= target && target <= high + ROUNDING
    }

    /// The reading of its transducer at `time` \[s\] \[m\].
    pub fn displacement(&mut self, time: f64) -> f64 {
        let quantum = self.settings.resolution;
        let read = self.faults.read_displacement(self.at, time);
        if quantum > 0.0 {
            (read / quantum).round() * quantum
        } else {
            read
        }
    }

    /// The reading of its load cell \[N\] for a true force `true_force` at `time` \[s\].
    pub fn force(&mut self, true_force: f64, time: f64) -> f64 {
        let noise = Normal::new(0.0, self.settings.noise)
            .map_or(0.0, |normal| normal.sample(&mut self.generator));
        self.faults.read_force(true_force + noise, time)
    }
}
