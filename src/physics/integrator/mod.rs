//! Time integration: Newmark in tangent form, explicit Newmark, α-operator-splitting, with their
//! stability limits. In: mass, damping, stiffness and force. Out: the next displacement. It knows
//! no contact law.

pub mod coefficients;
pub mod input;
pub mod newmark;
pub mod solver;
pub mod stability;
pub mod state;
pub mod step_form;
pub(crate) mod substep;
pub mod tangent;
pub mod tangents;

/// A time-integration method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integrator {
    /// Newmark's constant average acceleration with the measured tangent stiffness (Melo et al. 2006, eqs. 2 to 6).
    Tangent,
    /// Explicit Newmark, γ = ½: needs no stiffness.
    Explicit,
    /// α-operator splitting with the initial stiffness; −⅓ ≤ α ≤ 0.
    AlphaOs { alpha: f64 },
}

impl Integrator {
    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tangent => "tangent",
            Self::Explicit => "explicit",
            Self::AlphaOs { .. } => "alpha_os",
        }
    }
}
