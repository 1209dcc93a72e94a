//! The energy balance of an impact, at every step.

/// Fraction of the input energy that an integrator may create or lose before it is reported: an unstable run exceeds it by far.
pub const UNBALANCED: f64 = 0.1;

/// Fraction beyond which the integration error dominates the results: no requirement is decided by them.
pub const WORTHLESS: f64 = 0.5;

/// ½ M Ẋ² \[J\], of a mass \[kg\] and its velocity \[m/s\].
#[inline]
#[must_use]
pub const fn kinetic_energy(mass: f64, velocity: f64) -> f64 {
    0.5 * mass * velocity * velocity
}

/// Energies at the end of a step, all in J. They add up:
/// `striker + structure + restoring + damping + contact_loss + error = input`, with the input
/// ½ Ms V0² + energy of the structure at the start + weight + gravity.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Energies {
    /// ½ Ms Ẋs²
    pub striker: f64,
    /// ½ M Ẋ²
    pub structure: f64,
    /// ∫ R dX over the computed X, trapezoid.
    pub restoring: f64,
    /// ∫ C Ẋ dX
    pub damping: f64,
    /// Σ F₁ ΔXs − ½(F₀ + F₁) ΔX, cumulated.
    pub contact_loss: f64,
    /// `F_lim` Δδp, cumulated: an indicator, not a part of the sum.
    pub indentation: f64,
    /// Work of the striker's weight, Ms g (Xs − Xs₀), an input if it falls \[J\].
    pub weight: f64,
    /// Work of the weights on the floors of a frame, an input too \[J\].
    pub gravity: f64,
    /// The remainder of the input: the integration error.
    pub error: f64,
}

impl Energies {
    /// What is missing of the input \[J\]: the energy of the striker at the start, the work of its weight, that of the loads and
    /// that of the weights on the floors.
    pub(super) fn missing(&self, striker_at_start: f64, loads: f64) -> f64 {
        striker_at_start + self.weight + loads + self.gravity
            - (self.striker + self.structure + self.restoring + self.damping + self.contact_loss)
    }
}
