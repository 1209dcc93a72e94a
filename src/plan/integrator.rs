//! Time integration by name, shared by every procedure that integrates. What each does is `mechanics`'.

/// How a run goes from one step to the next.
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
    /// The word of the language.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tangent => "tangent",
            Self::Explicit => "explicit",
            Self::AlphaOs { .. } => "alpha_os",
        }
    }
}
