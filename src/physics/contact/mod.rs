//! Contact laws, one file each. In: the state of striker and structure at the start of a step. Out:
//! the contact force of the step. They know no rig and no procedure.

pub mod contact_time_step;
mod hertz;
mod impulse;
mod restitution;
mod spring;
pub mod state;

pub use hertz::HertzForce;
pub(crate) use impulse::{Decided, StrikerEnd};
pub use impulse::{ImpulseContact, Touching};
pub use restitution::RestitutionContact;
pub use spring::SpringContact;

use thiserror::Error;

use super::contact::state::StepState;
use crate::integrator::Integrator;
use crate::integrator::step_form::Motion;
use crate::integrator::substep::{Scratch, Striker, Substep};
use crate::number::numbers;
use crate::self_test::SelfTestPart;
use crate::structure::matrix::Vector;

/// The contact law between striker and structure, with its numbers: f64 in SI here, formulas in a plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactLaw<N = f64> {
    /// One velocity while they touch (Melo et al. 2006, eq. 4).
    Rigid,
    /// Rigid up to `force` \[N\], then perfectly plastic (Melo et al. 2006, Fig. 7).
    Limit { force: N },
    /// Separation speed over closing speed, 0 to 1.
    Restitution { coefficient: N },
    /// F = k δ^1.5 (1 + loss·δ̇), k in N/m^1.5, loss in s/m; above `force_limit` \[N\] the surface is permanently indented.
    Hertz {
        stiffness: N,
        loss: N,
        force_limit: Option<N>,
    },
}

/// The names of the numbers of the laws in a plan.
pub mod argument {
    pub const FORCE: &str = "force";
    pub const COEFFICIENT: &str = "coefficient";
    pub const STIFFNESS: &str = "stiffness";
    pub const LOSS: &str = "loss";
    pub const FORCE_LIMIT: &str = "force_limit";
}

/// A number of a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LawNumber<'a, N> {
    /// Its argument in a plan.
    pub argument: &'static str,
    /// Its name among the inputs of a run.
    pub input: &'static str,
    pub value: &'a N,
}

/// The spring of a law of finite stiffness: F = k δⁿ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSpring<N = f64> {
    /// k \[N/mⁿ\]
    pub stiffness: N,
    /// n
    pub exponent: f64,
}

impl<N> ContactLaw<N> {
    /// Its word in a plan.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Rigid => "rigid",
            Self::Limit { .. } => "limit",
            Self::Restitution { .. } => "restitution",
            Self::Hertz { .. } => "hertz",
        }
    }

    /// Its name in a sentence.
    #[must_use]
    pub const fn title(&self) -> &'static str {
        match self {
            Self::Rigid => "rigid",
            Self::Limit { .. } => "rigid up to a limit force",
            Self::Restitution { .. } => "restitution",
            Self::Hertz { .. } => "Hertz",
        }
    }

    /// The law with this word in a plan. `number` gives the value of an argument, None where it is left out. None for an unknown word, or
    /// without a number that the law requires.
    pub fn of_numbers(word: &str, mut number: impl FnMut(&str) -> Option<N>) -> Option<Self> {
        Some(match word {
            "rigid" => Self::Rigid,
            "limit" => Self::Limit {
                force: number(argument::FORCE)?,
            },
            "restitution" => Self::Restitution {
                coefficient: number(argument::COEFFICIENT)?,
            },
            "hertz" => Self::Hertz {
                stiffness: number(argument::STIFFNESS)?,
                loss: number(argument::LOSS)?,
                force_limit: number(argument::FORCE_LIMIT),
            },
            _ => return None,
        })
    }

    /// Its numbers, in the order of its declaration.
    #[must_use]
    pub fn numbers(&self) -> Vec<LawNumber<'_, N>> {
        let number = |named, input, value| LawNumber {
            argument: named,
            input,
            value,
        };
        match self {
            Self::Rigid => Vec::new(),
            Self::Limit { force } => vec![number(argument::FORCE, argument::FORCE_LIMIT, force)],
            Self::Restitution { coefficient } => {
                vec![number(argument::COEFFICIENT, "restitution", coefficient)]
            }
            Self::Hertz {
                stiffness,
                loss,
                force_limit,
            } => {
                let limit = force_limit.iter();
                [
                    number(argument::STIFFNESS, "contact_stiffness", stiffness),
                    number(argument::LOSS, argument::LOSS, loss),
                ]
                .into_iter()
                .chain(
                    limit.map(|force| number(argument::FORCE_LIMIT, argument::FORCE_LIMIT, force)),
                )
                .collect()
            }
        }
    }

    /// The spring of a law of finite stiffness.
    #[must_use]
    pub const fn spring(&self) -> Option<ContactSpring<&N>> {
        match self {
            Self::Hertz { stiffness, .. } => Some(ContactSpring {
                stiffness,
                exponent: 1.5,
            }),
            Self::Rigid | Self::Limit { .. } | Self::Restitution { .. } => None,
        }
    }

    /// Whether the contact returns the energy that it took: a spring without loss. `is_zero` finds whether a number is 0.
    pub fn is_lossless(&self, is_zero: impl FnOnce(&N) -> bool) -> bool {
        match self {
            Self::Hertz {
                loss, force_limit, ..
            } => force_limit.is_none() && is_zero(loss),
            Self::Rigid | Self::Limit { .. } | Self::Restitution { .. } => false,
        }
    }

    /// The parts of the self-test that cover it, on one degree of freedom and on a storey.
    #[must_use]
    pub const fn self_tested(&self) -> [SelfTestPart; 2] {
        match self {
            Self::Rigid => [SelfTestPart::Rigid, SelfTestPart::FrameRigid],
            Self::Limit { .. } => [SelfTestPart::Limit, SelfTestPart::FrameLimit],
            Self::Restitution { .. } => [SelfTestPart::Restitution, SelfTestPart::FrameRestitution],
            Self::Hertz { .. } => [SelfTestPart::Hertz, SelfTestPart::FrameHertz],
        }
    }

    /// The largest contact force of the law, if it has one \[N\].
    #[must_use]
    pub const fn force_limit(&self) -> Option<&N> {
        match self {
            Self::Limit { force } => Some(force),
            Self::Hertz { force_limit, .. } => force_limit.as_ref(),
            Self::Rigid | Self::Restitution { .. } => None,
        }
    }

    /// Whether it can leave a permanent indentation: above its largest force.
    #[must_use]
    pub const fn indents(&self) -> bool {
        self.force_limit().is_some()
    }

    /// Whether it follows the contact inside a step, by the tangent's prediction of the restoring force. No other integrator has one.
    #[must_use]
    pub const fn needs_tangent(&self) -> bool {
        match self {
            Self::Rigid | Self::Limit { .. } => false,
            Self::Restitution { .. } | Self::Hertz { .. } => true,
        }
    }

    /// Whether every contact force is that of an impulse over one step, so that its peak grows as 1/Δt without a bound.
    #[must_use]
    pub const fn is_impulsive(&self) -> bool {
        match self {
            Self::Rigid | Self::Restitution { .. } => true,
            Self::Limit { .. } | Self::Hertz { .. } => false,
        }
    }

    /// Whether the contact force has no bound: it is inversely proportional to the time step.
    #[must_use]
    pub const fn is_rigid(&self) -> bool {
        matches!(self, Self::Rigid)
    }

    /// Whether the coefficient of restitution is an input of the law.
    #[must_use]
    pub const fn states_restitution(&self) -> bool {
        matches!(self, Self::Restitution { .. })
    }
}

impl ContactLaw {
    /// Whether a peak contact force \[N\] is that of an impulse over one step: it grows as 1/Δt and is not a property of the impact.
    #[must_use]
    pub fn force_follows_the_step(&self, largest: f64) -> bool {
        self.blows_follow_the_step(largest) || self.is_impulsive()
    }

    /// Whether each contact lasts one step, up to a peak contact force of `largest` \[N\]. The times of the contacts, and possibly their
    /// number, then depend on the step.
    #[must_use]
    pub fn blows_follow_the_step(&self, largest: f64) -> bool {
        match self {
            Self::Rigid => true,
            Self::Limit { force } => largest < *force * (1.0 - 1e-9),
            Self::Restitution { .. } | Self::Hertz { .. } => false,
        }
    }
}

numbers! {
    /// Striker and struck degree of freedom at the start of a step.
    pub struct Start {
        displacement,
        velocity,
        striker_displacement,
        striker_velocity,
        /// F of the step before \[N\].
        contact_force,
        /// δp \[m\]
        indentation,
    }
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
#[error("{0} finds the instant of an impact by the tangent's prediction, which only `tangent` has")]
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
    Hertz(SpringContact<HertzForce>),
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
        striker: &Striker,
    ) -> Result<Self, NeedsTangent> {
        if law.needs_tangent() && integrator != Integrator::Tangent {
            return Err(NeedsTangent(law.name()));
        }
        match law {
            ContactLaw::Rigid => Ok(Self::Impulse(ImpulseContact::new(f64::INFINITY, striker))),
            ContactLaw::Limit { force } => Ok(Self::Impulse(ImpulseContact::new(force, striker))),
            ContactLaw::Restitution { coefficient } => Ok(Self::Divided(
                DividingContact::Restitution(RestitutionContact::new(coefficient)),
            )),
            ContactLaw::Hertz {
                stiffness,
                loss,
                force_limit,
            } => {
                let law = HertzForce::new(stiffness, loss, force_limit);
                let contact = SpringContact::new(law, impact);
                Ok(Self::Divided(DividingContact::Hertz(contact)))
            }
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
