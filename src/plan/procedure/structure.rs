//! The initial state of a struck structure. In: the known values before the first step, the striker of a plan, and the step parameters of
//! the plan. Out: the initial values of an impact. It integrates nothing.

use crate::physics::contact::ContactLaw;
use crate::physics::impact::ImpactInput;
use crate::plan::{Stepping, Striker};

/// One struck degree of freedom, and its step parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Structure {
    /// M \[kg\].
    pub mass: f64,
    /// C \[N·s/m\].
    pub damping: f64,
    /// K0 \[N/m\].
    pub stiffness: f64,
    /// `K_I` of α-OS and of the I-modification \[N/m\].
    pub operator_stiffness: f64,
    pub law: ContactLaw,
    /// Δt \[s\].
    pub time_step: f64,
    /// c of `K_t within [0, c·K0]`.
    pub max_tangent_ratio: f64,
    /// Standard deviation of the load cell \[N\].
    pub force_noise: f64,
    /// Resolution of the displacement reading \[m\].
    pub resolution: f64,
}

impl Structure {
    /// The impact of a striker of the plan on it, by the integrator of the plan.
    #[must_use]
    pub const fn struck_by(self, striker: &Striker, stepping: &Stepping) -> ImpactInput {
        ImpactInput {
            mass: self.mass,
            damping: self.damping,
            stiffness: self.stiffness,
            striker_mass: striker.mass,
            striker_velocity: striker.velocity,
            gap: striker.gap,
            gravity: striker.gravity,
            time_step: self.time_step,
            max_tangent_ratio: self.max_tangent_ratio,
            law: self.law,
            integrator: stepping.integrator,
            operator_stiffness: self.operator_stiffness,
            i_modification: stepping.i_modification,
            force_noise: self.force_noise,
            resolution: self.resolution,
        }
    }
}
