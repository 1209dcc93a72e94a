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

/// How the actuator goes from target to target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    /// It stops at every one; the reading is at rest.
    StepAndPause,
    /// It does not stop: rig time is `time_scale` times virtual time, and what a damper does at that speed is in the force.
    Continuous { time_scale: f64 },
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
