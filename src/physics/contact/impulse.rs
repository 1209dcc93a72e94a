//! The paper's contact: rigid, or rigid–perfectly plastic with a limit force (Melo et al. 2006, eq. 4, Fig. 7). Its
//! contact force grows as 1/Δt; as Δt → 0 it is a collision with e = Ms/(Ms + 2M), or a plastic one under a limit.
//!
//! With the contact force F₁ = (Ms/Δt)(Ẋs + gΔt − Ẋs₁) and Ẋs₁ = Ẋ₁, eq. (4) reads for any integrator whose end velocity is
//! linear in F₁, Ẋ₁ = `v_free` + w·F₁:
//!
//! ```text
//! F₁ = (Ẋs + gΔt − v_free) / (Δt/Ms + w)
//! ```
//!
//! In the tangent form w = ½Δt/M̂, and the line above is eq. (4) again. A tensile F₁ is dropped, one beyond the limit force
//! is cut to it.
//!
//! ## Energy
//! A force acts at both ends of a step, of which the trapezoid gives the structure the mean: M·½(v₀+v₁)·Δt·½(c₀+c₁) =
//! ½(F₀+F₁)·½Δt(v₀+v₁), exactly, so that the contact loss counts the travel ½Δt(v₀+v₁) and not d₁ − d₀, which under explicit
//! Newmark differ by ¼Δt²(a₀ − a₁). The striker gives F₁ΔXs.

use super::{Advance, Start};
use crate::contact::state::StepState;
use crate::integrator::substep::Striker;

/// Rigid contact, cut at a limit force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpulseContact {
    /// N; infinite under the rigid law.
    force_limit: f64,
}

/// State and force \[N\] of a contact in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Decided {
    pub state: StepState,
    pub force: f64,
}

impl Decided {
    pub(crate) const FREE: Self = Self {
        state: StepState::Free,
        force: 0.0,
    };
}

impl ImpulseContact {
    /// No limit: the force is whatever stops the closing within the step.
    #[must_use]
    pub const fn rigid() -> Self {
        Self {
            force_limit: f64::INFINITY,
        }
    }

    /// At most `force` \[N\].
    #[must_use]
    pub const fn limited(force: f64) -> Self {
        Self { force_limit: force }
    }

    /// \[N\]; infinite without a limit.
    pub(crate) const fn force_limit(self) -> f64 {
        self.force_limit
    }

    /// F of a step from `v_free` \[m/s\] and w \[m/s/N\]: at most the limit, and never in tension.
    #[inline]
    pub(crate) fn decide(
        self,
        striker: &Striker,
        start: &Start,
        free: f64,
        compliance: f64,
    ) -> Decided {
        // No tolerance: δp was stored as this very difference, so that a surface at rest on its dent touches it.
        if start.striker_displacement - start.displacement < start.indentation {
            return Decided::FREE;
        }
        let falling = start.striker_velocity + striker.gravity * striker.time_step;
        match (falling - free) / (striker.time_step / striker.mass + compliance) {
            needed if needed > self.force_limit => Decided {
                state: StepState::Limit,
                force: self.force_limit,
            },
            needed if needed >= 0.0 => Decided {
                state: StepState::Contact,
                force: needed,
            },
            _ => Decided::FREE,
        }
    }

    /// The striker after a step, the struck degree of freedom at `displacement` \[m\] with `velocity` \[m/s\] then.
    #[inline]
    pub(crate) fn advance(
        striker: &Striker,
        start: &Start,
        decided: Decided,
        [displacement, velocity]: [f64; 2],
    ) -> Advance {
        let Striker {
            mass,
            gravity,
            time_step,
            ..
        } = *striker;
        let Decided { state, force } = decided;
        let falling = start.striker_velocity + gravity * time_step;
        let striker_velocity = match state {
            StepState::Free => falling,
            StepState::Contact => velocity,
            StepState::Limit => falling - force * time_step / mass,
        };
        let striker_moved = 0.5 * time_step * (start.striker_velocity + striker_velocity);
        let striker_displacement = start.striker_displacement + striker_moved;
        let limited = state == StepState::Limit;
        let dent = striker_displacement - displacement;
        let indentation = if limited {
            start.indentation.max(dent)
        } else {
            start.indentation
        };
        let moved = 0.5 * time_step * (start.velocity + velocity);
        Advance {
            striker_displacement,
            striker_velocity,
            state,
            contact_force: force,
            indentation,
            contact_loss: force * striker_moved - 0.5 * (start.contact_force + force) * moved,
            damping_work: 0.0,
            indentation_work: if limited {
                force * (indentation - start.indentation)
            } else {
                0.0
            },
            contacts: u32::from(!start.touching && state != StepState::Free),
        }
    }
}
