//! The mechanical part of an emulated rig: actuators of constant speed, a specimen, sensors with noise and resolution. In:
//! targets and time. Out: position and force of each actuator, SI. It knows no protocol. A value without an axis belongs to the
//! first one. Axial actuators are behind all others.

use super::emulated_rig::actuator::{ActuatorModel, ActuatorSettings};
use super::emulated_rig::axial::AxialActuator;
use super::emulated_rig::fault::MechanicalFault;
use super::emulated_rig::smooth_paths::PathQueue;
use super::emulated_rig::structure::Structure;
use psd_plan::{Behaviour, Frame, Interval};

/// The properties of an emulated rig.
#[derive(Clone, Debug)]
pub struct EmulatedRigSettings {
    pub behaviour: Behaviour,
    /// Damping coefficient c of the force c·v while it moves \[N·s/m\].
    pub damping: f64,
    /// Standard deviation of a force reading \[N\].
    pub noise: f64,
    /// Quantization step of the displacement reading \[m\]; 0: none.
    pub resolution: f64,
    /// Scale factor of a raw converter \[N per count\], with the polarity of the load cell.
    pub newtons_per_count: f64,
    /// Zero offset of a raw converter: the count at zero force.
    pub zero_offset: f64,
    pub seed: u64,
    /// Limits of the target. The emulator logs a target outside them as a failure of the host.
    pub limits: Interval,
    /// Maximum speed \[m/s\].
    pub top_speed: f64,
}

/// A commanded move of the emulated rig.
#[derive(Clone, Debug, PartialEq)]
pub struct SentMove {
    /// Time since power-up \[s\].
    pub time: f64,
    /// Number of the move, if the protocol has one.
    pub id: Option<u64>,
    /// Indices of the actuators that move.
    pub actuators: Vec<usize>,
    /// One for each of them \[m\].
    pub targets: Vec<f64>,
    /// Speed of the actuator with the longest move \[m/s\].
    pub speed: f64,
}

/// The physics behind an emulated controller.
#[derive(Debug)]
pub struct EmulatedRig {
    settings: EmulatedRigSettings,
    structure: Structure,
    pub(super) actuators: Vec<ActuatorModel>,
    /// The last of the actuators.
    axial: Vec<AxialActuator>,
    /// Time since power-up \[s\].
    pub(super) time: f64,
    /// Restoring force of the specimen at each actuator \[N\], without noise.
    restoring_force: Vec<f64>,
    /// Number of force readings; with several actuators, those of the first.
    readings: u64,
    /// Targets outside the limits \[m\].
    violations: Vec<f64>,
    /// Every commanded move.
    pub(super) moves: Vec<SentMove>,
    pub(super) paths: PathQueue,
    /// Index of the actuator that a value without an axis belongs to.
    view: usize,
    /// Scale factor \[N per count\] and zero offset of each actuator, if they differ from those of the emulated rig.
    converters: Vec<(f64, f64)>,
}

/// Longest time step of a smooth move \[s\]: the specimen reacts to a load reversal within this time.
const FINELY: f64 = 1e-3;

/// Returns the seed of one actuator. The first one uses the seed of the emulated rig.
const fn seed_of(seed: u64, actuator: u64) -> u64 {
    seed.wrapping_add(actuator.wrapping_mul(0x9e37_79b9_7f4a_7c15))
}

impl EmulatedRig {
    /// Every commanded target \[m\], in order; with several actuators one after the other.
    #[must_use]
    pub fn targets(&self) -> Vec<f64> {
        self.moves
            .iter()
            .flat_map(|sent| sent.targets.clone())
            .collect()
    }

    /// One actuator on a specimen of one degree of freedom.
    #[must_use]
    pub fn new(settings: EmulatedRigSettings) -> Self {
        let EmulatedRigSettings {
            noise,
            resolution,
            limits,
            ..
        } = settings;
        let structure = Structure::of_one(&settings.behaviour, settings.damping);
        // The displacement of such a specimen has the polarity of the rig.
        Self::with_structure(
            settings,
            structure,
            &[ActuatorSettings {
                sign: 1.0,
                noise,
                resolution,
                limits,
            }],
        )
    }

    /// One actuator at every floor of a frame, the lowest first. Only the settings common to all actuators are used.
    #[must_use]
    pub fn of_frame(
        settings: EmulatedRigSettings,
        frame: &Frame,
        actuators: &[ActuatorSettings],
    ) -> Self {
        Self::with_structure(settings, Structure::of_frame(frame), actuators)
    }

    fn with_structure(
        settings: EmulatedRigSettings,
        structure: Structure,
        actuators: &[ActuatorSettings],
    ) -> Self {
        let actuator = |(number, actuator): (u64, &ActuatorSettings)| {
            ActuatorModel::new(*actuator, seed_of(settings.seed, number))
        };
        let mut rig = Self {
            structure,
            actuators: (0..).zip(actuators).map(actuator).collect(),
            axial: Vec::new(),
            settings,
            time: 0.0,
            restoring_force: Vec::new(),
            readings: 0,
            violations: Vec::new(),
            moves: Vec::new(),
            paths: PathQueue::default(),
            view: 0,
            converters: Vec::new(),
        };
        let at_rest = vec![0.0; actuators.len()];
        rig.restoring_force = rig.structure.bend(&at_rest, &at_rest, 0.0, 0.0);
        rig
    }

    /// Adds friction to the load cell \[N\]. It acts against the last motion, also during a dwell, as in the simulated rig.
    #[must_use]
    pub fn with_friction(mut self, friction: f64) -> Self {
        self.structure.set_friction(friction);
        self
    }

    /// Adds a raw converter for each actuator: scale factor \[N per count\] and zero offset.
    #[must_use]
    pub fn with_converters(self, converters: Vec<(f64, f64)>) -> Self {
        Self { converters, ..self }
    }

    /// Moves the actuators to these initial positions of their controllers \[m\]; the specimen stays undeformed.
    #[must_use]
    pub fn resting_at(mut self, positions: &[f64]) -> Self {
        for (actuator, position) in self.actuators.iter_mut().zip(positions) {
            actuator.stand_at(*position);
        }
        self
    }

    /// Starts a fault of the actuator with this index, of its specimen or of its sensors.
    pub fn strike(&mut self, actuator: usize, fault: MechanicalFault) {
        let time = self.time;
        if let Some(actuator) = self.actuators.get_mut(actuator) {
            actuator.faults.strike(fault, time);
        }
    }

    /// Adds a fault that occurs with a probability at any force reading of the actuator with this index.
    pub fn strike_by_chance(&mut self, actuator: usize, fault: MechanicalFault, probability: f64) {
        if let Some(actuator) = self.actuators.get_mut(actuator) {
            actuator.faults.strike_by_chance(fault, probability);
        }
    }

    #[must_use]
    pub const fn settings(&self) -> &EmulatedRigSettings {
        &self.settings
    }

    /// The number of actuators.
    #[must_use]
    pub const fn actuators(&self) -> usize {
        self.actuators.len()
    }

    /// The limits for targets of the actuator with this index \[m\].
    #[must_use]
    pub fn limits_of(&self, actuator: usize) -> Interval {
        self.actuators[actuator].settings.limits
    }

    /// Time since power-up \[s\].
    #[must_use]
    pub const fn time(&self) -> f64 {
        self.time
    }

    /// Advances the emulated rig to a later time \[s\].
    pub fn advance(&mut self, to: f64) {
        while let Some(until) = self.next_path_start().filter(|until| *until < to) {
            self.pass(until);
            self.begin_next_path();
        }
        self.pass(to);
    }

    /// Advances the emulated rig to a time \[s\] before which the actuators receive no command.
    fn pass(&mut self, to: f64) {
        while self.actuators.iter().any(ActuatorModel::follows_path) && to - self.time > FINELY {
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
        // All arrive simultaneously. An actuator with a lag moves the whole time.
        let going = self
            .actuators
            .iter()
            .map(|actuator| actuator.arrives_in(seconds))
            .fold(0.0, f64::max);
        let lateral = self.lateral();
        let before: Vec<f64> = self.actuators.iter().map(|actuator| actuator.at).collect();
        for actuator in &mut self.actuators[..lateral] {
            actuator.advance(seconds);
        }
        let load_changes = self.advance_axial(seconds);
        let moved: Vec<f64> = self.actuators[..lateral]
            .iter()
            .zip(before)
            .map(|(actuator, before)| actuator.settings.sign * (actuator.at - before))
            .collect();
        let positions: Vec<f64> = self.actuators[..lateral]
            .iter()
            .map(|actuator| actuator.settings.sign * actuator.bends())
            .collect();
        let forces = self.structure.bend(&positions, &moved, going, seconds);
        self.follow_drifts();
        if load_changes || moved.iter().any(|moved| *moved != 0.0) {
            let cell_forces = self.actuators[..lateral]
                .iter_mut()
                .zip(forces)
                .map(|(actuator, force)| actuator.faults.specimen_force(actuator.bends(), force));
            self.restoring_force = cell_forces.collect();
        }
    }

    /// Starts a move to `target` \[m\] at `speed` \[m/s\].
    pub fn go(&mut self, target: f64, speed: f64) {
        self.go_as(None, &[target], speed);
    }

    /// Starts a move to one target per actuator \[m\]. The move can have a number. All arrive simultaneously, and the actuator
    /// with the longest move has the speed `speed` \[m/s\].
    pub fn go_as(&mut self, id: Option<u64>, targets: &[f64], speed: f64) {
        let all: Vec<usize> = (0..self.actuators.len()).collect();
        self.go_those(id, &all, targets, speed);
    }

    /// Starts such a move of these actuators alone.
    pub fn go_those(&mut self, id: Option<u64>, actuators: &[usize], targets: &[f64], speed: f64) {
        let speed = speed.abs().min(self.settings.top_speed);
        let travel =
            |rig: &Self, actuator: usize, to: f64| (to - rig.actuators[actuator].position).abs();
        let farthest = actuators
            .iter()
            .zip(targets)
            .map(|(actuator, to)| travel(self, *actuator, *to))
            .fold(0.0, f64::max);
        for (actuator, target) in actuators.iter().zip(targets) {
            self.check_limits(*actuator, *target);
            let travel = travel(self, *actuator, *target);
            self.actuators[*actuator].go(
                *target,
                if travel == farthest {
                    speed
                } else {
                    speed * (travel / farthest)
                },
            );
        }
        self.moves.push(SentMove {
            time: self.time,
            id,
            actuators: actuators.to_vec(),
            targets: targets.to_vec(),
            speed,
        });
    }

    /// The controller refused a target \[m\]: no motion, but the target is logged.
    pub fn refuse(&mut self, target: f64) {
        self.check_limits(0, target);
    }

    /// The same for the actuator with this index.
    pub fn refuse_of(&mut self, actuator: usize, target: f64) {
        self.check_limits(actuator, target);
    }

    /// The same for several targets, one per actuator.
    pub fn refuse_all(&mut self, targets: &[f64]) {
        for (actuator, target) in (0..self.actuators.len()).zip(targets) {
            self.check_limits(actuator, *target);
        }
    }

    pub(super) fn check_limits(&mut self, actuator: usize, target: f64) {
        if !self.actuators[actuator].allows(target) {
            self.violations.push(target);
        }
    }

    /// Stops all actuators at their present position.
    pub fn hold(&mut self) {
        self.paths.clear();
        let all: Vec<usize> = (0..self.actuators.len()).collect();
        self.hold_those(&all);
    }

    /// Whether any actuator moves.
    #[must_use]
    pub fn moving(&self) -> bool {
        (0..self.actuators.len()).any(|actuator| self.any_moving(&[actuator]))
    }

    /// The present commanded position \[m\], as a controller knows it that counts its own steps.
    #[must_use]
    pub fn commanded(&self) -> f64 {
        self.commanded_of(self.view)
    }

    #[must_use]
    pub fn commanded_of(&self, actuator: usize) -> f64 {
        self.actuators[actuator].position
    }

    /// The reading of the displacement transducer \[m\].
    pub fn displacement(&mut self) -> f64 {
        self.displacement_of(self.view)
    }

    pub fn displacement_of(&mut self, actuator: usize) -> f64 {
        self.actuators[actuator].displacement(self.time)
    }

    /// The reading of the load cell \[N\], with noise.
    pub fn force(&mut self) -> f64 {
        self.force_of(self.view)
    }

    pub fn force_of(&mut self, actuator: usize) -> f64 {
        self.readings += u64::from(actuator == 0);
        let velocities = self.velocities();
        if let Some(force) = self.axial_force(actuator) {
            return self.actuators[actuator].force(force, self.time);
        }
        let cell_forces = self
            .structure
            .actuator_forces(&self.restoring_force, &velocities)[actuator];
        let actuator = &mut self.actuators[actuator];
        let at_the_cell = actuator.settings.sign * cell_forces;
        actuator.force(at_the_cell, self.time)
    }

    /// The velocity of the specimen at each actuator that is not axial \[m/s\].
    fn velocities(&self) -> Vec<f64> {
        self.actuators[..self.lateral()]
            .iter()
            .map(|actuator| actuator.settings.sign * actuator.velocity())
            .collect()
    }

    /// The force as counts of a raw converter of 24 bits.
    pub fn counts(&mut self) -> i64 {
        let force = self.force();
        match self.converters.get(self.view) {
            Some((newtons_per_count, zero_offset)) => {
                in_24_bits(force / newtons_per_count + zero_offset)
            }
            None => self.counts_of(force),
        }
    }

    /// Converts a force \[N\] to counts of a raw converter of 24 bits.
    #[must_use]
    pub fn counts_of(&self, force: f64) -> i64 {
        in_24_bits(force / self.settings.newtons_per_count + self.settings.zero_offset)
    }

    /// The string that the controller sends for a force of the actuator with this index: `ordinary`, unless a fault replaces
    /// it. Call it once for each number sent.
    pub fn shown_force(&mut self, actuator: usize, ordinary: String) -> String {
        self.actuators[actuator]
            .faults
            .take_number()
            .unwrap_or(ordinary)
    }

    /// The same for the actuator in view.
    pub fn shown(&mut self, ordinary: String) -> String {
        self.shown_force(self.view, ordinary)
    }

    /// From now on, values without an axis belong to this actuator. Returns the previous one.
    pub(super) const fn look_from(&mut self, actuator: usize) -> usize {
        std::mem::replace(&mut self.view, actuator)
    }

    /// Whether any of these actuators moves.
    #[must_use]
    pub fn any_moving(&self, actuators: &[usize]) -> bool {
        actuators
            .iter()
            .any(|actuator| self.actuators[*actuator].moving() || self.force_moves(*actuator))
    }

    /// Stops these actuators at their present position.
    pub fn hold_those(&mut self, actuators: &[usize]) {
        for actuator in actuators {
            self.actuators[*actuator].hold();
            self.hold_force(*actuator);
        }
    }

    /// Number of force readings; with several actuators, those of the first.
    #[must_use]
    pub const fn readings(&self) -> u64 {
        self.readings
    }

    /// Every commanded move, in order.
    #[must_use]
    pub fn moves(&self) -> &[SentMove] {
        &self.moves
    }

    /// Targets outside the limits \[m\].
    #[must_use]
    pub fn violations(&self) -> &[f64] {
        &self.violations
    }
}

#[expect(clippy::cast_possible_truncation, reason = "clamped to 24 bits")]
fn in_24_bits(count: f64) -> i64 {
    count.round().clamp(-8_388_608.0, 8_388_607.0) as i64
}

pub mod actuator;
pub mod axial;
pub mod fault;
pub mod smooth_paths;
pub mod structure;
#[cfg(test)]
mod tests;
