//! Cyclic deterioration of a hysteresis by the energy it absorbs. In: work, reversals, ends of excursions. Out: the remaining strengths and
//! unloading stiffness, and the extension of the reloading target. It knows no path.
//!
//! After Ibarra, Medina & Krawinkler (*Hysteretic models that incorporate strength and stiffness deterioration*, Earthquake Engng Struct.
//! Dyn. 34 (2005) 1489–1511), in the order of `IMKPinching` of OpenSees: each mode has its own γ and loses the fraction β = (`E_i`/(γ F_y
//! x_y − ΣE_j))^c, with the energy `E_i` of the excursion and ΣE_j of all including it; β = 1 if less than `E_i` remains.
//! - At zero force, where the next excursion begins in a direction: the strength of that side, yield force and post-yield stiffness alike,
//!   times 1 − `β_s`, down to the residual; its post-capping line, by its force at zero displacement, times 1 − `β_c`; its peak times
//!   1 + `β_a`.
//! - At the reversal of a loaded excursion: the unloading stiffness of both sides times 1 − `β_k`, with `E_i` and ΣE_j minus the released
//!   elastic energy.

pub(super) mod bilinear;
pub mod pinching;
#[cfg(test)]
mod pinching_tests;

/// Parameters of cyclic deterioration: for each mode the energy capacity γ over `F_y` `x_y`, infinite if the mode is off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deterioration {
    pub strength: f64,
    pub capping: f64,
    pub unloading: f64,
    pub reloading: f64,
    /// c
    pub exponent: f64,
    /// Strength that is never lost, over the first one.
    pub residual: f64,
}

/// Deterioration of a hysteresis so far; none if no capacity is stated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Degradation {
    rule: Option<Deterioration>,
    /// `F_y` \[N\] and K \[N/m\]
    yield_force: f64,
    stiffness: f64,
    /// Strength over the first one, forwards and backwards.
    pub strength: [f64; 2],
    /// Force of the post-capping line at zero displacement, over the first one.
    pub capping: [f64; 2],
    /// Unloading stiffness over the first one.
    pub unloading: f64,
    /// Energy of all completed excursions, and of the present one \[J\].
    pub energy: [f64; 2],
    /// The part of the present one that has already reduced the unloading stiffness \[J\].
    charged: f64,
}

/// The energy of an excursion.
struct ExcursionEnergy {
    /// `E_i` \[J\]
    absorbed: f64,
    /// ΣE_j, all including it \[J\].
    all: f64,
}

/// Energy below this share of `F_y` `x_y` is rounding.
const ROUNDING: f64 = 1e-12;

impl Degradation {
    /// Undamaged: `F_y` \[N\] and K \[N/m\].
    #[must_use]
    pub const fn new(rule: Option<Deterioration>, yield_force: f64, stiffness: f64) -> Self {
        Self {
            rule,
            yield_force,
            stiffness,
            strength: [1.0; 2],
            capping: [1.0; 2],
            unloading: 1.0,
            energy: [0.0; 2],
            charged: 0.0,
        }
    }

    /// Whether any mode deteriorates.
    #[must_use]
    pub fn degrades(&self) -> bool {
        self.rule.is_some_and(|rule| {
            [rule.strength, rule.capping, rule.unloading, rule.reloading]
                .into_iter()
                .any(f64::is_finite)
        })
    }

    /// Adds the work of a move \[J\].
    pub fn work(&mut self, done: f64) {
        self.energy[1] += done;
    }

    /// β of an excursion, for a capacity γ.
    fn share(&self, capacity: f64, exponent: f64, energy: &ExcursionEnergy) -> f64 {
        let left = capacity * self.yield_force * self.yield_force / self.stiffness - energy.all;
        if left > energy.absorbed {
            (energy.absorbed / left).powf(exponent)
        } else {
            1.0
        }
    }

    /// The reversal of a loaded excursion, with the elastic energy `stored` \[J\].
    pub fn turned(&mut self, stored: f64) {
        let Some(rule) = self.rule else { return };
        let absorbed = self.energy[1] - stored - self.charged;
        if absorbed > ROUNDING * self.yield_force * self.yield_force / self.stiffness {
            let energy = ExcursionEnergy {
                absorbed,
                all: self.energy[0] + self.energy[1] - stored,
            };
            self.unloading *= 1.0 - self.share(rule.unloading, rule.exponent, &energy);
            self.charged += absorbed;
        }
    }

    /// Zero force, where the next excursion begins to this `side` (0 forwards, 1 backwards). Returns the factor of its peak displacement.
    pub fn ended(&mut self, side: usize) -> f64 {
        let Some(rule) = self.rule else { return 1.0 };
        let absorbed = self.energy[1].max(0.0);
        let all = self.energy[0] + absorbed;
        (self.energy, self.charged) = ([all, 0.0], 0.0);
        let energy = ExcursionEnergy { absorbed, all };
        let share = |capacity| self.share(capacity, rule.exponent, &energy);
        let [strength, capping, reloading] =
            [rule.strength, rule.capping, rule.reloading].map(share);
        self.strength[side] = (self.strength[side] * (1.0 - strength)).max(rule.residual);
        self.capping[side] *= 1.0 - capping;
        1.0 + reloading
    }
}
