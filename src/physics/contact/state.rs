//! Contact between striker and structure: the laws and the states of a step.

/// State of a step, as recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepState {
    Free,
    Contact,
    Limit,
}

impl StepState {
    /// Its name in tables and figures.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Contact => "contact",
            Self::Limit => "limit",
        }
    }
}

/// The contact law between striker and structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactLaw {
    /// One velocity while they touch (Melo et al. 2006, eq. 4).
    Rigid,
    /// Rigid up to `force` \[N\], then perfectly plastic (Melo et al. 2006, Fig. 7).
    Limit { force: f64 },
    /// Separation speed over closing speed, 0 to 1.
    Restitution { coefficient: f64 },
    /// F = k δ^1.5 (1 + loss·δ̇), k in N/m^1.5, loss in s/m; above `force_limit` \[N\] the surface is permanently indented.
    Hertz {
        stiffness: f64,
        loss: f64,
        force_limit: Option<f64>,
    },
}

impl ContactLaw {
    /// k of a law of finite stiffness \[N/m^1.5\].
    #[must_use]
    pub const fn stiffness(&self) -> Option<f64> {
        match self {
            Self::Hertz { stiffness, .. } => Some(*stiffness),
            Self::Rigid | Self::Limit { .. } | Self::Restitution { .. } => None,
        }
    }

    /// Whether a peak contact force \[N\] is that of an impulse over one step: it grows as 1/Δt and is not a property of the impact.
    #[must_use]
    pub fn force_follows_the_step(&self, largest: f64) -> bool {
        match self {
            Self::Rigid | Self::Restitution { .. } => true,
            Self::Limit { force } => largest < *force * (1.0 - 1e-9),
            Self::Hertz { .. } => false,
        }
    }
}
