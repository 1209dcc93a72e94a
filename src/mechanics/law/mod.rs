//! Contact laws in action: each takes structure and striker over one step. One law a file.

mod hertz;
mod impulse;
mod restitution;

pub(crate) use hertz::Closing;
pub use hertz::HertzContact;
pub use impulse::ImpulseContact;
pub use restitution::RestitutionContact;
pub(crate) use restitution::{Collision, MOST_BOUNCES, locate};

use crate::mechanics::contact::{ContactLaw, StepState};
use crate::mechanics::integrator::Motion;

/// What stays the same over a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bodies {
    /// M, kg
    pub mass: f64,
    /// C, N·s/m
    pub damping: f64,
    /// Ms, kg
    pub striker_mass: f64,
    /// g of Ms Ẍs = Ms g − F, m/s²; 0 of a striker that does not fall.
    pub gravity: f64,
    /// Δt, s
    pub time_step: f64,
}

/// Structure and striker at the start of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    pub structure: Motion,
    pub striker_displacement: f64,
    pub striker_velocity: f64,
    /// F of the step before, N.
    pub contact_force: f64,
    /// Whether the step before was one in contact.
    pub touching: bool,
    /// `K_t`, N/m
    pub tangent_stiffness: f64,
    /// δp, m
    pub indentation: f64,
}

/// … and at its end; of the structure, what `S` tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Advance<S = Motion> {
    pub structure: S,
    pub striker_displacement: f64,
    pub striker_velocity: f64,
    pub state: StepState,
    /// Impulse of the step over Δt, N.
    pub contact_force: f64,
    /// δp, m
    pub indentation: f64,
    /// Energy that left the two bodies through their contact in this step, J.
    pub contact_loss: f64,
    /// ∫CẊ dX over this step, J.
    pub damping_work: f64,
    /// `F_lim` Δδp, J.
    pub indentation_work: f64,
    /// Contacts that began in this step: of a law that acts step by step the first step in contact after one apart, of one that
    /// follows the contact inside a step every time that it closes.
    pub contacts: u32,
}

/// Of a law that acts step by step: whether a contact begins with a step in this state.
#[must_use]
pub(crate) fn begun(was_touching: bool, state: StepState) -> u32 {
    u32::from(!was_touching && state != StepState::Free)
}

/// A contact law's step.
pub trait Law {
    fn advance(&mut self, bodies: &Bodies, start: &Start) -> Advance;
}

/// The law of a plan, chosen once a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnyContact {
    Impulse(ImpulseContact),
    Restitution(RestitutionContact),
    Hertz(HertzContact),
}

impl AnyContact {
    /// `approach_velocity` is the striker's at the start: it sets how finely a Hertz blow is resolved.
    #[must_use]
    pub fn new(law: ContactLaw, bodies: &Bodies, approach_velocity: f64) -> Self {
        match law {
            ContactLaw::Rigid => Self::Impulse(ImpulseContact::rigid()),
            ContactLaw::Limit { force } => Self::Impulse(ImpulseContact::limited(force)),
            ContactLaw::Restitution { coefficient } => Self::Restitution(RestitutionContact::new(coefficient)),
            ContactLaw::Hertz { stiffness, loss, force_limit } => {
                Self::Hertz(HertzContact::new(stiffness, loss, force_limit, bodies, approach_velocity))
            }
        }
    }
}

impl Law for AnyContact {
    fn advance(&mut self, bodies: &Bodies, start: &Start) -> Advance {
        match self {
            Self::Impulse(law) => law.advance(bodies, start),
            Self::Restitution(law) => law.advance(bodies, start),
            Self::Hertz(law) => law.advance(bodies, start),
        }
    }
}
