//! The paper's contact: rigid, or rigid–perfectly plastic with a limit force (Melo et al. 2006, eq. 4, Fig. 7). Its
//! contact force grows as 1/Δt; as Δt → 0 it is a collision with e = Ms/(Ms + 2M), or a plastic one under a limit.

use super::{Advance, Bodies, Law, Start, begun};
use crate::mechanics::contact::StepState;

/// Rigid contact, cut at a limit force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpulseContact {
    /// N; infinite under the rigid law.
    force_limit: f64,
}

impl ImpulseContact {
    /// No limit: the force is whatever stops the closing within the step.
    #[must_use]
    pub const fn rigid() -> Self {
        Self { force_limit: f64::INFINITY }
    }

    /// At most `force`, N.
    #[must_use]
    pub const fn limited(force: f64) -> Self {
        Self { force_limit: force }
    }
}

impl Law for ImpulseContact {
    #[inline]
    fn advance(&mut self, bodies: &Bodies, start: &Start) -> Advance {
        let Bodies { mass, damping, striker_mass, gravity, time_step } = *bodies;
        let from = start.structure;
        let tangent = start.tangent_stiffness;
        let balance = from.balance(mass, damping, tangent, time_step);

        let mut state = StepState::Free;
        let mut force = 0.0;
        // Ms Ẍs = Ms g − F: what the striker would have at the end with no contact.
        let falling = start.striker_velocity + gravity * time_step;
        let mut striker_velocity = falling;
        let mut structure = None;
        // No tolerance: δp was stored as this very difference, so that a surface at rest on its dent touches it.
        if start.striker_displacement - from.displacement >= start.indentation {
            // Eq. (4) with the weight: F₁ = Ms g + (Ms/Δt)(Ẋs − Ẋs₁) is (Ms/Δt)(Ẋs + gΔt − Ẋs₁).
            let closing = from.velocity - falling;
            let load = balance.load - striker_mass / time_step * closing - 0.5 * striker_mass * from.acceleration;
            let joined = from.follow(load / (balance.inertia + 0.5 * striker_mass), tangent, time_step);
            let needed = striker_mass / time_step * (falling - joined.velocity);
            if needed > self.force_limit {
                state = StepState::Limit;
                force = self.force_limit;
                striker_velocity = falling - force * time_step / striker_mass;
            } else if needed >= 0.0 {
                state = StepState::Contact;
                force = needed;
                striker_velocity = joined.velocity;
                structure = Some(joined);
            }
        }
        let structure = structure.unwrap_or_else(|| from.follow((balance.load + force) / balance.inertia, tangent, time_step));
        let striker_displacement = start.striker_displacement + 0.5 * time_step * (start.striker_velocity + striker_velocity);
        let mut indentation = start.indentation;
        if state == StepState::Limit {
            indentation = indentation.max(striker_displacement - structure.displacement);
        }
        // With M Ẍ = F − CẊ − R at both ends the trapezoid gives the structure ½(F₀ + F₁)ΔX; the striker gave F₁ΔXs.
        let moved = structure.displacement - from.displacement;
        let striker_moved = striker_displacement - start.striker_displacement;
        Advance {
            structure,
            striker_displacement,
            striker_velocity,
            state,
            contact_force: force,
            indentation,
            contact_loss: force * striker_moved - 0.5 * (start.contact_force + force) * moved,
            damping_work: 0.5 * damping * (from.velocity + structure.velocity) * moved,
            indentation_work: if state == StepState::Limit { force * (indentation - start.indentation) } else { 0.0 },
            contacts: begun(start.touching, state),
        }
    }
}
