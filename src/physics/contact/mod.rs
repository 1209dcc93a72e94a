//! Contact laws, one file each. In: the state of striker and structure at the start of a step. Out:
//! the contact force of the step. They know no rig and no procedure.

pub mod contact_time_step;
mod hertz;
mod impulse;
mod restitution;
pub mod state;

pub use hertz::HertzContact;
pub(super) use impulse::Decided;
pub use impulse::ImpulseContact;
pub use restitution::RestitutionContact;

use thiserror::Error;

use super::contact::state::{ContactLaw, StepState};
use crate::integrator::Integrator;
use crate::integrator::step_form::Motion;
use crate::integrator::substep::{Scratch, Striker, Substep};
use crate::structure::matrix::Vector;

/// Striker and struck degree of freedom at the start of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    pub displacement: f64,
    pub velocity: f64,
    pub striker_displacement: f64,
    pub striker_velocity: f64,
    /// F of the step before \[N\].
    pub contact_force: f64,
    /// Whether the step before was one in contact.
    pub touching: bool,
    /// δp \[m\]
    pub indentation: f64,
}

/// The striker and its contact at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Advance {
    pub striker_displacement: f64,
    pub striker_velocity: f64,
    pub state: StepState,
    /// Impulse of the step over Δt \[N\].
    pub contact_force: f64,
    /// δp \[m\]
    pub indentation: f64,
    /// Energy that left the two bodies through their contact in this step \[J\].
    pub contact_loss: f64,
    /// ∫ẊᵀCẊ dt of a step with a velocity jump \[J\]; 0 for a law of impulses, where the structure balances the dampers.
    pub damping_work: f64,
    /// `F_lim` Δδp \[J\].
    pub indentation_work: f64,
    /// Contacts that began in this step: of a law that acts step by step the first step in contact after one apart, of one that
    /// follows the contact inside a step every time that it closes.
    pub contacts: u32,
}

/// Law and integrator that do not go together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("{0} finds the instant of a blow by the tangent's prediction, which only `tangent` has")]
pub struct NeedsTangent(pub &'static str);

/// The law of a plan, chosen once a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnyContact {
    Impulse(ImpulseContact),
    Divided(DividingContact),
}

/// A law that follows the contact inside a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DividingContact {
    Restitution(RestitutionContact),
    Hertz(HertzContact),
}

impl DividingContact {
    /// The step in tangent form from the state in `scratch`; its end is written to `to`.
    #[inline]
    pub(crate) fn pass<V: Vector>(
        &mut self,
        substep: &mut Substep<V>,
        striker: &Striker,
        start: &Start,
        scratch: &mut Scratch<V>,
        to: &mut Motion<V>,
    ) -> Advance {
        match self {
            Self::Restitution(law) => law.pass(substep, striker, start, scratch, to),
            Self::Hertz(law) => law.pass(substep, striker, start, scratch, to),
        }
    }
}

impl AnyContact {
    /// The law of a plan under its integrator. The paper's, rigid and limit, go with every integrator; `hertz` and `restitution`
    /// follow the contact inside a step by the tangent's prediction.
    ///
    /// # Errors
    /// Law and integrator do not go together.
    pub fn new(
        law: ContactLaw,
        integrator: Integrator,
        impact: Approaching,
    ) -> Result<Self, NeedsTangent> {
        let tangent = integrator == Integrator::Tangent;
        match law {
            ContactLaw::Rigid => Ok(Self::Impulse(ImpulseContact::rigid())),
            ContactLaw::Limit { force } => Ok(Self::Impulse(ImpulseContact::limited(force))),
            ContactLaw::Restitution { .. } if !tangent => Err(NeedsTangent("restitution")),
            ContactLaw::Restitution { coefficient } => Ok(Self::Divided(
                DividingContact::Restitution(RestitutionContact::new(coefficient)),
            )),
            ContactLaw::Hertz { .. } if !tangent => Err(NeedsTangent("hertz")),
            ContactLaw::Hertz {
                stiffness,
                loss,
                force_limit,
            } => Ok(Self::Divided(DividingContact::Hertz(HertzContact::new(
                stiffness,
                loss,
                force_limit,
                impact,
            )))),
        }
    }
}

/// Two bodies before their first impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approaching {
    /// The mass that the striker meets \[kg\].
    pub mass: f64,
    /// Ms \[kg\]
    pub striker_mass: f64,
    /// \[m/s\]
    pub velocity: f64,
    /// Δt \[s\]
    pub time_step: f64,
}

impl Approaching {
    /// M Ms/(M + Ms) \[kg\].
    #[must_use]
    pub const fn reduced_mass(&self) -> f64 {
        reduced_mass(self.mass, self.striker_mass)
    }
}

/// M Ms/(M + Ms) of two masses \[kg\].
const fn reduced_mass(mass: f64, striker_mass: f64) -> f64 {
    mass * striker_mass / (mass + striker_mass)
}
