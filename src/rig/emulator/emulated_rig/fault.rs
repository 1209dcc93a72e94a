//! Faults of the actuator, the specimen and the sensors of an emulated rig. In: a fault and the correct value. Out: the faulty value.
//! It knows neither protocol nor line.

use rand::RngExt as _;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng as _;

/// A fault of an actuator, a specimen or a sensor. A spike and an invalid number affect one reading. Every other fault lasts
/// from its start.
#[derive(Clone, Debug, PartialEq)]
pub enum MechanicalFault {
    /// From now on the actuator makes only this fraction of every move. At 0 it does not move.
    Reach(f64),
    /// The actuator follows its command with this time constant \[s\].
    Lag(f64),
    /// Without a next smooth move the actuators continue for so long \[s\], instead of the time of the controller.
    Coast(f64),
    /// Factor on the force readings, such as a wrong polarity or a wrong unit.
    ScaleForce(f64),
    /// Factor on the displacement readings.
    ScaleDisplacement(f64),
    /// Force readings stay within ± this value \[N\].
    ClipForce(f64),
    FreezeForce,
    FreezeDisplacement,
    /// Zero drift of the force reading from now on \[N/s\].
    Drift(f64),
    /// Zero drift of the displacement reading from now on \[m/s\].
    DriftDisplacement(f64),
    /// Added to the next force reading \[N\].
    Spike(f64),
    /// This string replaces the next force reading.
    Number(String),
    /// From this displacement \[m\] on, only this fraction of the specimen's force remains.
    Fracture {
        displacement: f64,
        left: f64,
    },
}

/// The faults that have occurred.
#[derive(Debug)]
pub struct MechanicalFaults {
    pub reach: f64,
    pub lag: f64,
    /// \[s\]
    pub coast: Option<f64>,
    force_factor: f64,
    displacement_factor: f64,
    clip: Option<f64>,
    freezes_force: bool,
    freezes_displacement: bool,
    frozen_force: Option<f64>,
    frozen_displacement: Option<f64>,
    /// Rate \[N/s\] and start time \[s\].
    drifts: Vec<(f64, f64)>,
    /// Rate \[m/s\] and start time \[s\].
    displacement_drifts: Vec<(f64, f64)>,
    spike: f64,
    number: Option<String>,
    /// Displacement \[m\] and the fraction of the force that remains beyond it.
    fracture: Option<(f64, f64)>,
    broken: Option<f64>,
    /// Faults that occur at random at a force reading, with their probability.
    chances: Vec<(MechanicalFault, f64)>,
    generator: Pcg64,
}

impl MechanicalFaults {
    /// An emulated rig without faults. The seed is used for the random faults.
    pub fn none(seed: u64) -> Self {
        Self {
            reach: 1.0,
            lag: 0.0,
            coast: None,
            force_factor: 1.0,
            displacement_factor: 1.0,
            clip: None,
            freezes_force: false,
            freezes_displacement: false,
            frozen_force: None,
            frozen_displacement: None,
            drifts: Vec::new(),
            displacement_drifts: Vec::new(),
            spike: 0.0,
            number: None,
            fracture: None,
            broken: None,
            chances: Vec::new(),
            generator: Pcg64::seed_from_u64(seed ^ 0x5eed_fa17),
        }
    }

    /// Starts a fault at `time` \[s\].
    pub fn strike(&mut self, fault: MechanicalFault, time: f64) {
        match fault {
            MechanicalFault::Reach(part) => self.reach = part,
            MechanicalFault::Lag(seconds) => self.lag = seconds,
            MechanicalFault::Coast(seconds) => self.coast = Some(seconds),
            MechanicalFault::ScaleForce(factor) => self.force_factor *= factor,
            MechanicalFault::ScaleDisplacement(factor) => self.displacement_factor *= factor,
            MechanicalFault::ClipForce(limit) => self.clip = Some(limit),
            MechanicalFault::FreezeForce => self.freezes_force = true,
            MechanicalFault::FreezeDisplacement => self.freezes_displacement = true,
            MechanicalFault::Drift(rate) => self.drifts.push((rate, time)),
            MechanicalFault::DriftDisplacement(rate) => self.displacement_drifts.push((rate, time)),
            MechanicalFault::Spike(force) => self.spike += force,
            MechanicalFault::Number(text) => self.number = Some(text),
            MechanicalFault::Fracture { displacement, left } => {
                self.fracture = Some((displacement, left));
            }
        }
    }

    pub fn strike_by_chance(&mut self, fault: MechanicalFault, probability: f64) {
        self.chances.push((fault, probability));
    }

    /// Returns the specimen's force \[N\] with its actuator at `position` \[m\].
    pub fn specimen_force(&mut self, position: f64, sound: f64) -> f64 {
        if let Some((at, left)) = self.fracture {
            let reached = if at < 0.0 {
                position <= at
            } else {
                position >= at
            };
            if reached {
                self.broken = Some(left);
            }
        }
        sound * self.broken.unwrap_or(1.0)
    }

    /// Returns the reading of the load cell \[N\] at `time` \[s\] for a true force.
    pub fn read_force(&mut self, sound: f64, time: f64) -> f64 {
        let drawn: Vec<MechanicalFault> = {
            let Self {
                chances, generator, ..
            } = self;
            chances
                .iter()
                .filter(|(_, probability)| generator.random::<f64>() < *probability)
                .map(|(fault, _)| fault.clone())
                .collect()
        };
        for fault in drawn {
            self.strike(fault, time);
        }
        let spike = std::mem::take(&mut self.spike);
        self.sense_force(sound + spike, time)
    }

    /// The same for the controller itself: without the faults of a single reading.
    pub fn sense_force(&mut self, sound: f64, time: f64) -> f64 {
        let read = (sound + drifted(&self.drifts, time)) * self.force_factor;
        let read = self
            .clip
            .map_or(read, |limit| read.clamp(-limit.abs(), limit.abs()));
        if self.freezes_force {
            *self.frozen_force.get_or_insert(read)
        } else {
            read
        }
    }

    /// Returns the reading of the transducer \[m\] at `time` \[s\] for a true displacement.
    pub fn read_displacement(&mut self, sound: f64, time: f64) -> f64 {
        let read = (sound + drifted(&self.displacement_drifts, time)) * self.displacement_factor;
        if self.freezes_displacement {
            *self.frozen_displacement.get_or_insert(read)
        } else {
            read
        }
    }

    /// Returns the string that replaces a force reading, if there is one.
    pub const fn take_number(&mut self) -> Option<String> {
        self.number.take()
    }
}

/// Returns the sum at `time` \[s\] of the zero drifts since their start times.
fn drifted(drifts: &[(f64, f64)], time: f64) -> f64 {
    drifts
        .iter()
        .map(|(rate, since)| rate * (time - since))
        .sum()
}
