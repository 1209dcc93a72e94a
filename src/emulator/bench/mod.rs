//! The mechanical part of an emulated rig: actuators of constant speed, a specimen, sensors with
//! noise and resolution. In: targets and time. Out: position and force of each actuator, SI. It
//! knows no protocol. A value without an axis belongs to the first one.

use super::bench::fault::BenchFault;
use super::bench::glide::Glides;
use super::bench::ram::{Ram, RamSettings};
use super::bench::structure::Structure;
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
    /// The ram of which is said what is said without a place.
    view: usize,
    /// Of each ram whose raw converter is another than the bench's: N per count, count at no force.
    converters: Vec<(f64, f64)>,
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
        let BenchSettings {
            noise,
            resolution,
            limits,
            ..
        } = settings;
        let structure = Structure::of_one(&settings.behaviour, settings.damping);
        // Such a specimen is bent in the rig's own directions.
        Self::standing(
            settings,
            structure,
            &[RamSettings {
                sign: 1.0,
                noise,
                resolution,
                limits,
            }],
        )
    }

    /// A ram at every floor of a frame, the lowest first. Of the settings only those for all rams count.
    #[must_use]
    pub fn of_frame(settings: BenchSettings, frame: &Frame, rams: &[RamSettings]) -> Self {
        Self::standing(settings, Structure::of_frame(frame), rams)
    }

    fn standing(settings: BenchSettings, structure: Structure, rams: &[RamSettings]) -> Self {
        let ram =
            |(number, ram): (u64, &RamSettings)| Ram::new(*ram, seed_of(settings.seed, number));
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
            view: 0,
            converters: Vec::new(),
        };
        let at_rest = vec![0.0; rams.len()];
        bench.restoring_force = bench.structure.bend(&at_rest, &at_rest, 0.0, 0.0);
        bench
    }

    /// The same bench with friction on its cell, N: against the last motion, also through a pause, as a virtual rig has it.
    #[must_use]
    pub const fn with_friction(mut self, friction: f64) -> Self {
        self.structure.set_friction(friction);
        self
    }

    /// The same bench with a raw converter for each ram: N per count, count at no force.
    #[must_use]
    pub fn with_converters(self, converters: Vec<(f64, f64)>) -> Self {
        Self { converters, ..self }
    }

    /// The same bench whose rams stand at these places of their controllers, m, with the specimen not bent.
    #[must_use]
    pub fn standing_at(mut self, places: &[f64]) -> Self {
        for (ram, place) in self.rams.iter_mut().zip(places) {
            ram.stand_at(*place);
        }
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
        let going = self
            .rams
            .iter()
            .map(|ram| ram.arrives_in(seconds))
            .fold(0.0, f64::max);
        let before: Vec<f64> = self.rams.iter().map(|ram| ram.at).collect();
        for ram in &mut self.rams {
            ram.advance(seconds);
        }
        let moved: Vec<f64> = self
            .rams
            .iter()
            .zip(before)
            .map(|(ram, before)| ram.settings.sign * (ram.at - before))
            .collect();
        let places: Vec<f64> = self
            .rams
            .iter()
            .map(|ram| ram.settings.sign * ram.bends())
            .collect();
        let forces = self.structure.bend(&places, &moved, going, seconds);
        if moved.iter().any(|moved| *moved != 0.0) {
            let felt = self
                .rams
                .iter_mut()
                .zip(forces)
                .map(|(ram, force)| ram.faults.specimen_force(ram.bends(), force));
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
        let all: Vec<usize> = (0..self.rams.len()).collect();
        self.go_those(id, &all, targets, speed);
    }

    /// The same of these rams alone.
    pub fn go_those(&mut self, id: Option<u64>, rams: &[usize], targets: &[f64], speed: f64) {
        let speed = speed.abs().min(self.settings.top_speed);
        let way = |bench: &Self, ram: usize, to: f64| (to - bench.rams[ram].position).abs();
        let farthest = rams
            .iter()
            .zip(targets)
            .map(|(ram, to)| way(self, *ram, *to))
            .fold(0.0, f64::max);
        for (ram, target) in rams.iter().zip(targets) {
            self.judge(*ram, *target);
            self.targets.push(*target);
            let way = way(self, *ram, *target);
            self.rams[*ram].go(
                *target,
                if way == farthest {
                    speed
                } else {
                    speed * (way / farthest)
                },
            );
        }
        self.moves.push(SentMove {
            time: self.time,
            id,
            targets: targets.to_vec(),
            speed,
        });
    }

    /// The controller refused a target (m): it goes nowhere, but was asked to.
    pub fn refuse(&mut self, target: f64) {
        self.judge(0, target);
    }

    /// The same of the ram at this place.
    pub fn refuse_of(&mut self, ram: usize, target: f64) {
        self.judge(ram, target);
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
        self.commanded_of(self.view)
    }

    #[must_use]
    pub fn commanded_of(&self, ram: usize) -> f64 {
        self.rams[ram].position
    }

    /// m, as its transducer reads it.
    pub fn displacement(&mut self) -> f64 {
        self.displacement_of(self.view)
    }

    pub fn displacement_of(&mut self, ram: usize) -> f64 {
        self.rams[ram].displacement(self.time)
    }

    /// N, as its cell feels it, with noise.
    pub fn force(&mut self) -> f64 {
        self.force_of(self.view)
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
        self.rams
            .iter()
            .map(|ram| ram.settings.sign * ram.velocity())
            .collect()
    }

    /// The force as a raw converter of 24 bits gives it.
    pub fn counts(&mut self) -> i64 {
        let force = self.force();
        match self.converters.get(self.view) {
            Some((newtons_per_count, zero_count)) => {
                in_24_bits(force / newtons_per_count + zero_count)
            }
            None => self.counts_of(force),
        }
    }

    /// What a raw converter of 24 bits makes of a force, N.
    #[must_use]
    pub fn counts_of(&self, force: f64) -> i64 {
        in_24_bits(force / self.settings.newtons_per_count + self.settings.zero_count)
    }

    /// What the controller puts where a force of the ram at this place stands: `ordinary`, unless a fault has something else
    /// for it. To be asked once for each number sent.
    pub fn shown_force(&mut self, ram: usize, ordinary: String) -> String {
        self.rams[ram].faults.take_number().unwrap_or(ordinary)
    }

    /// The same of the ram in view.
    pub fn shown(&mut self, ordinary: String) -> String {
        self.shown_force(self.view, ordinary)
    }

    /// What is said without a place is said of this ram from now on; of which it was before.
    pub(super) const fn look_from(&mut self, ram: usize) -> usize {
        std::mem::replace(&mut self.view, ram)
    }

    /// Whether any of these rams moves.
    #[must_use]
    pub fn any_moving(&self, rams: &[usize]) -> bool {
        rams.iter().any(|ram| self.rams[*ram].moving())
    }

    /// These rams stop where they stand.
    pub fn hold_those(&mut self, rams: &[usize]) {
        for ram in rams {
            self.rams[*ram].hold();
        }
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

#[expect(clippy::cast_possible_truncation, reason = "clamped to 24 bits")]
fn in_24_bits(count: f64) -> i64 {
    count.round().clamp(-8_388_608.0, 8_388_607.0) as i64
}

pub(crate) mod fault;
pub(crate) mod glide;
pub(crate) mod ram;
pub(crate) mod structure;
#[cfg(test)]
mod tests;
