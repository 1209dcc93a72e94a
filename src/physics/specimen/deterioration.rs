//! Wear of a hysteresis by the energy it takes. In: work, reversals, excursions that end. Out: what is left of its strengths and of its
//! unloading stiffness, and how much farther it reloads. It knows no path.
//!
//! After Ibarra, Medina & Krawinkler (*Hysteretic models that incorporate strength and stiffness deterioration*, Earthquake Engng Struct.
//! Dyn. 34 (2005) 1489–1511), in the order of `IMKPinching` of OpenSees: each mode has its own γ, and takes the share
//! β = (`E_i`/(γ F_y x_y − ΣE_j))^c, `E_i` what the excursion took, ΣE_j all with it; all of it where less is left than was taken.
//! - Where the force is gone and the way goes on to a side: that side's strength, yield force and hardening alike, times 1 − `β_s`, down to
//!   the residual; its post-capping line, by the force where it meets no displacement, times 1 − `β_c`; its peak times 1 + `β_a`.
//! - Where a loaded excursion turns: the unloading stiffness of both sides times 1 − `β_k`, `E_i` and ΣE_j without what it gives back.

/// Cyclic deterioration by energy: of each mode γ, the energy that it can take in all, over `F_y` `x_y`; infinite where the mode is off.
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

/// How far a hysteresis has worn; nothing does where no capacity is stated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wear {
    rule: Option<Deterioration>,
    /// `F_y`, N, and K, N/m
    yield_force: f64,
    stiffness: f64,
    /// Strength over the first one, forwards and backwards.
    pub strength: [f64; 2],
    /// Force of the post-capping line at no displacement, over the first one.
    pub capping: [f64; 2],
    /// Unloading stiffness over the first one.
    pub unloading: f64,
    /// Taken in all excursions that ended, and in the one that has not, J.
    pub energy: [f64; 2],
    /// What of that one has softened the unloading already, J.
    charged: f64,
}

/// Energy below this share of `F_y` `x_y` is rounding.
const ROUNDING: f64 = 1e-12;

impl Wear {
    /// As built: of `F_y` (N) and K (N/m).
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

    /// Whether anything wears.
    #[must_use]
    pub fn wears(&self) -> bool {
        self.rule.is_some_and(|rule| {
            [rule.strength, rule.capping, rule.unloading, rule.reloading]
                .into_iter()
                .any(f64::is_finite)
        })
    }

    /// Takes the work of a move, J.
    pub fn work(&mut self, done: f64) {
        self.energy[1] += done;
    }

    /// β of `taken` (J) where `all` of it has been taken so far, for a capacity γ.
    fn share(&self, capacity: f64, exponent: f64, taken: f64, all: f64) -> f64 {
        let left = capacity * self.yield_force * self.yield_force / self.stiffness - all;
        if left > taken {
            (taken / left).powf(exponent)
        } else {
            1.0
        }
    }

    /// A loaded excursion turns, with so much (J) still to give back.
    pub fn turned(&mut self, stored: f64) {
        let Some(rule) = self.rule else { return };
        let taken = self.energy[1] - stored - self.charged;
        if taken > ROUNDING * self.yield_force * self.yield_force / self.stiffness {
            let all = self.energy[0] + self.energy[1] - stored;
            self.unloading *= 1.0 - self.share(rule.unloading, rule.exponent, taken, all);
            self.charged += taken;
        }
    }

    /// The force is gone, and the next excursion goes to this `side` (0 forwards, 1 backwards). Out: how much farther its peak is.
    pub fn ended(&mut self, side: usize) -> f64 {
        let Some(rule) = self.rule else { return 1.0 };
        let taken = self.energy[1].max(0.0);
        let all = self.energy[0] + taken;
        (self.energy, self.charged) = ([all, 0.0], 0.0);
        let share = |capacity| self.share(capacity, rule.exponent, taken, all);
        let [strength, capping, reloading] =
            [rule.strength, rule.capping, rule.reloading].map(share);
        self.strength[side] = (self.strength[side] * (1.0 - strength)).max(rule.residual);
        self.capping[side] *= 1.0 - capping;
        1.0 + reloading
    }
}
