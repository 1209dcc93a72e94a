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

#![allow(
    clippy::inline_always,
    reason = "a part of its caller, which is compiled for several vector units"
)]

use std::fmt::Debug;

use super::Start;
use crate::contact::state::StepState;
use crate::integrator::substep::Striker;
use crate::number::{Answer as _, Number, numbers};

numbers! {
    /// Rigid contact, cut at a limit force, with what the striker brings into a step. `fall` and `striker_compliance` are not neighbours:
    /// the compiler would add both in one vector with numbers that were stored one by one just before, and the processor waits for such.
    pub struct ImpulseContact {
        /// N; infinite under the rigid law.
        force_limit,
        /// gΔt of a step of free fall \[m/s\].
        fall,
        /// Ms \[kg\]
        striker_mass,
        /// Δt/Ms \[s/kg\]
        striker_compliance,
    }
}

/// A number whose contact has a state, or numbers side by side with that of each.
pub trait Touching: Number {
    type State: Copy + Debug;

    /// At the limit force, otherwise in contact, otherwise free.
    fn state(at_limit: Self::Answer, in_contact: Self::Answer) -> Self::State;

    /// The number of each state. Of several numbers all three are computed.
    fn of_state(
        state: Self::State,
        free: impl FnOnce() -> Self,
        contact: impl FnOnce() -> Self,
        limit: impl FnOnce() -> Self,
    ) -> Self;
}

impl Touching for f64 {
    type State = StepState;

    #[inline(always)]
    fn state(at_limit: bool, in_contact: bool) -> StepState {
        match (at_limit, in_contact) {
            (true, _) => StepState::Limit,
            (false, true) => StepState::Contact,
            (false, false) => StepState::Free,
        }
    }

    #[inline(always)]
    fn of_state(
        state: StepState,
        free: impl FnOnce() -> Self,
        contact: impl FnOnce() -> Self,
        limit: impl FnOnce() -> Self,
    ) -> Self {
        match state {
            StepState::Free => free(),
            StepState::Contact => contact(),
            StepState::Limit => limit(),
        }
    }
}

/// State and force \[N\] of a contact in a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Decided<N: Touching = f64> {
    pub state: N::State,
    pub force: N,
}

numbers! {
    /// The striker at the end of a step, and what the contact did in it.
    pub(crate) struct StrikerEnd {
        displacement,
        velocity,
        /// δp \[m\]
        indentation,
        /// Energy that left the two bodies through their contact in this step \[J\].
        contact_loss,
        /// `F_lim` Δδp \[J\]
        indentation_work,
    }
}

impl ImpulseContact {
    /// A force of `force_limit` at most \[N\]. Without a limit, which is infinite, the force is whatever stops the closing within the
    /// step.
    #[must_use]
    pub fn new(force_limit: f64, striker: &Striker) -> Self {
        Self {
            force_limit,
            striker_mass: striker.mass,
            fall: striker.gravity * striker.time_step,
            striker_compliance: striker.time_step / striker.mass,
        }
    }
}

impl Decided {
    pub(crate) const FREE: Self = Self {
        state: StepState::Free,
        force: 0.0,
    };
}

impl<N: Touching> ImpulseContact<N> {
    /// F that stops the closing within a step \[N\], from the velocity Ẋs at its start, `v_free` \[m/s\] and w \[m/s/N\].
    #[inline(always)]
    pub(crate) fn needed(&self, striker_velocity: N, free: N, compliance: N) -> N {
        (striker_velocity + self.fall - free) / (self.striker_compliance + compliance)
    }

    /// F of a step that needs this force: at most the limit, and never in tension. Only a law that is `LIMITED` can have a limit.
    #[inline(always)]
    pub(crate) fn decide<const LIMITED: bool>(
        &self,
        start: &Start<N>,
        needed: impl FnOnce() -> N,
    ) -> Decided<N> {
        let zero = self.force_limit.same(0.0);
        // No tolerance: δp was stored as this very difference, so that a surface at rest on its dent touches it.
        let near = (start.striker_displacement - start.displacement).ge(start.indentation);
        if near.is_surely_no() {
            return Decided {
                state: N::state(near, near),
                force: zero,
            };
        }
        let needed = needed();
        let beyond = if LIMITED {
            needed.gt(self.force_limit)
        } else {
            near & !near
        };
        let state = N::state(near & beyond, near & needed.ge(zero));
        let force = N::of_state(state, || zero, || needed, || self.force_limit);
        Decided { state, force }
    }

    /// The striker after a step of Δt \[s\], the struck degree of freedom at `displacement` \[m\] with `velocity` \[m/s\] then.
    #[inline(always)]
    pub(crate) fn advance(
        &self,
        time_step: N,
        start: &Start<N>,
        decided: &Decided<N>,
        [displacement, velocity]: [N; 2],
    ) -> StrikerEnd<N> {
        let Decided { state, force } = *decided;
        let half = time_step * 0.5;
        let falling = start.striker_velocity + self.fall;
        let striker_velocity = N::of_state(
            state,
            || falling,
            || velocity,
            || falling - force * time_step / self.striker_mass,
        );
        let striker_moved = half * (start.striker_velocity + striker_velocity);
        let striker_displacement = start.striker_displacement + striker_moved;
        let unchanged = || start.indentation;
        let dent = || {
            start
                .indentation
                .larger(striker_displacement - displacement)
        };
        let indentation = N::of_state(state, unchanged, unchanged, dent);
        let none = || force.same(0.0);
        let work = || force * (indentation - start.indentation);
        let indentation_work = N::of_state(state, none, none, work);
        let moved = half * (start.velocity + velocity);
        StrikerEnd {
            displacement: striker_displacement,
            velocity: striker_velocity,
            indentation,
            contact_loss: force * striker_moved - (start.contact_force + force) * 0.5 * moved,
            indentation_work,
        }
    }
}
