//! What can go wrong with ram, specimen and sensors of a bench. In: a fault, and what should have been. Out: what is.
//! It knows no dialect and no line.

use rand::RngExt as _;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng as _;

/// One fault of ram, specimen or sensor. All last from the moment they strike, but a spike and a bad number, which
/// spoil one reading.
#[derive(Clone, Debug, PartialEq)]
pub enum BenchFault {
    /// The ram makes only this part of every way from now on; 0: it sticks.
    Reach(f64),
    /// The ram follows its command with this time constant, s.
    Lag(f64),
    /// Force readings times this: a sign, a wrong unit.
    ScaleForce(f64),
    /// Displacement readings times this.
    ScaleDisplacement(f64),
    /// Force readings stay within ± this, N.
    ClipForce(f64),
    FreezeForce,
    FreezeDisplacement,
    /// N/s on the force reading from now on.
    Drift(f64),
    /// m/s on the displacement reading from now on.
    DriftDisplacement(f64),
    /// N on the next force reading.
    Spike(f64),
    /// This text in place of the next force reading.
    Number(String),
    /// Once the specimen is at this displacement (m), only this part of its force is left.
    Fracture {
        displacement: f64,
        left: f64,
    },
}

/// The faults that have struck so far.
#[derive(Debug)]
pub struct BenchFaults {
    pub(crate) reach: f64,
    pub(crate) lag: f64,
    force_factor: f64,
    displacement_factor: f64,
    clip: Option<f64>,
    freezes_force: bool,
    freezes_displacement: bool,
    frozen_force: Option<f64>,
    frozen_displacement: Option<f64>,
    /// N/s, and since when, s.
    drifts: Vec<(f64, f64)>,
    /// m/s, and since when, s.
    displacement_drifts: Vec<(f64, f64)>,
    spike: f64,
    number: Option<String>,
    /// m, and the part left beyond it.
    fracture: Option<(f64, f64)>,
    broken: Option<f64>,
    /// Faults drawn for at every force reading, with their probability.
    chances: Vec<(BenchFault, f64)>,
    generator: Pcg64,
}

impl BenchFaults {
    /// A sound bench; the seed serves the faults that come by chance.
    pub(crate) fn none(seed: u64) -> Self {
        Self {
            reach: 1.0,
            lag: 0.0,
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

    /// A fault strikes at `time` (s).
    pub(crate) fn strike(&mut self, fault: BenchFault, time: f64) {
        match fault {
            BenchFault::Reach(part) => self.reach = part,
            BenchFault::Lag(seconds) => self.lag = seconds,
            BenchFault::ScaleForce(factor) => self.force_factor *= factor,
            BenchFault::ScaleDisplacement(factor) => self.displacement_factor *= factor,
            BenchFault::ClipForce(limit) => self.clip = Some(limit),
            BenchFault::FreezeForce => self.freezes_force = true,
            BenchFault::FreezeDisplacement => self.freezes_displacement = true,
            BenchFault::Drift(rate) => self.drifts.push((rate, time)),
            BenchFault::DriftDisplacement(rate) => self.displacement_drifts.push((rate, time)),
            BenchFault::Spike(force) => self.spike += force,
            BenchFault::Number(text) => self.number = Some(text),
            BenchFault::Fracture { displacement, left } => {
                self.fracture = Some((displacement, left));
            }
        }
    }

    pub(crate) fn strike_by_chance(&mut self, fault: BenchFault, probability: f64) {
        self.chances.push((fault, probability));
    }

    /// The specimen's force with its ram at `position` (m), N.
    pub(crate) fn specimen_force(&mut self, position: f64, sound: f64) -> f64 {
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

    /// What the cell gives at `time` (s) for a true force, N.
    pub(crate) fn read_force(&mut self, sound: f64, time: f64) -> f64 {
        let drawn: Vec<BenchFault> = {
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
        let read = (sound + drifted(&self.drifts, time) + std::mem::take(&mut self.spike))
            * self.force_factor;
        let read = self
            .clip
            .map_or(read, |limit| read.clamp(-limit.abs(), limit.abs()));
        if self.freezes_force {
            *self.frozen_force.get_or_insert(read)
        } else {
            read
        }
    }

    /// What the transducer gives at `time` (s) for a true displacement, m.
    pub(crate) fn read_displacement(&mut self, sound: f64, time: f64) -> f64 {
        let read = (sound + drifted(&self.displacement_drifts, time)) * self.displacement_factor;
        if self.freezes_displacement {
            *self.frozen_displacement.get_or_insert(read)
        } else {
            read
        }
    }

    /// What stands in place of a force reading, if anything.
    pub(crate) const fn take_number(&mut self) -> Option<String> {
        self.number.take()
    }
}

/// What rates since their times come to at `time`, s.
fn drifted(drifts: &[(f64, f64)], time: f64) -> f64 {
    drifts
        .iter()
        .map(|(rate, since)| rate * (time - since))
        .sum()
}
