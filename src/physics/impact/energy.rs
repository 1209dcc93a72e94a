//! The energy balance of an impact (physics: every dynamic run, every step).

/// Share of the energy put in that a scheme may make or lose before a reader is told: an unstable run is off by far more.
pub const UNBALANCED: f64 = 0.1;

/// Share beyond which a run says more of its scheme than of its specimen: nothing is decided by it.
pub const WORTHLESS: f64 = 0.5;

/// Energies at the end of a step, all in J. They add up:
/// `striker + structure + restoring + damping + contact_loss + error = ½ Ms V0² + weight`.
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
    /// Work of the striker's weight, Ms g (Xs − Xs₀): put in, where it falls.
    pub weight: f64,
    /// What remains of the input: the integration error.
    pub error: f64,
}
