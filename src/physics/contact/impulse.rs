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
//! The step of one degree of freedom is a ratio, Ẍ₁ = top/bottom ([`crate::structure::matrix::one_degree`]), to whose top F₁ adds
//! F₁ΔX. Both decisions on F₁ are then products, and eq. (4) is a ratio again:
//!
//! ```text
//! a = Ẋs + gΔt − Ẋ − ½ΔtẌ                             s = (a·bottom − ½Δt·top)·bottom
//! F₁ ≥ 0  ⇔  s ≥ 0                                     F₁ > F  ⇔  (Ms/Δt)·s > F·(bottom + ½Ms ΔX)·bottom
//! Ẍ₁ = (top + (Ms/Δt) a ΔX)/(bottom + ½Ms ΔX)          F₁ = (Ms/Δt)(Ẋs + gΔt − Ẋ₁)
//! ```
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
use crate::structure::matrix::one_degree::Unforced;

numbers! {
    /// Rigid contact, cut at a limit force, with what the striker brings into a step.
    pub struct ImpulseContact {
        /// N; infinite under the rigid law.
        force_limit,
        /// gΔt of a step of free fall \[m/s\].
        fall,
        /// Δt/Ms \[s/kg\]
        striker_compliance,
        /// Ms/Δt \[kg/s\]
        striker_inertia,
        /// ½Ms \[kg\]
        half_striker,
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
            fall: striker.gravity * striker.time_step,
            striker_compliance: striker.time_step / striker.mass,
            striker_inertia: striker.mass / striker.time_step,
            half_striker: 0.5 * striker.mass,
        }
    }
}

impl ImpulseContact {
    /// The contact of a step from `v_free` \[m/s\] and w \[m/s/N\]: the force that stops the closing within the step, at most the limit,
    /// and never in tension.
    #[inline]
    pub(crate) fn decide(&self, start: &Start, free: f64, compliance: f64) -> Decided {
        if !Self::is_near::<true>(start) {
            return Decided::FREE;
        }
        let needed =
            (start.striker_velocity + self.fall - free) / (self.striker_compliance + compliance);
        let state = f64::state(needed > self.force_limit, needed >= 0.0);
        let force = f64::of_state(state, || 0.0, || needed, || self.force_limit);
        Decided { state, force }
    }
}

impl Decided {
    pub(crate) const FREE: Self = Self {
        state: StepState::Free,
        force: 0.0,
    };
}

impl<N: Touching> ImpulseContact<N> {
    /// Whether the surfaces touch as a step begins. No tolerance: δp was stored as this very difference, so that a surface at rest on its
    /// dent touches it.
    #[inline(always)]
    fn is_near<const LIMITED: bool>(start: &Start<N>) -> N::Answer {
        if LIMITED {
            (start.striker_displacement - start.displacement).ge(start.indentation)
        } else {
            start.striker_displacement.ge(start.displacement)
        }
    }

    /// The state of a step of one degree of freedom, and its Ẍ₁ as a ratio; `half` is ½Δt \[s\]. Only a law that is `LIMITED` can have a limit.
    #[inline(always)]
    pub(crate) fn join<const LIMITED: bool>(
        &self,
        start: &Start<N>,
        unforced: &Unforced<N>,
        half: N,
    ) -> (N::State, [N; 2]) {
        let Unforced {
            glide,
            top,
            bottom,
            response,
            ..
        } = *unforced;
        let near = Self::is_near::<LIMITED>(start);
        if near.is_surely_no() {
            return (N::state(near, near), [top, bottom]);
        }
        let ahead = start.striker_velocity + self.fall - glide;
        // The sign of the bottom is that of the displacement.
        let spare = (ahead * bottom - half * top) * bottom;
        let heavier = bottom + self.half_striker * response;
        let beyond = if LIMITED {
            (self.striker_inertia * spare).gt(self.force_limit * (heavier * bottom))
        } else {
            near & !near
        };
        let state = N::state(near & beyond, near & spare.ge(half.same(0.0)));
        let pushed = || top + self.striker_inertia * ahead * response;
        let limited = || top + self.force_limit * response;
        (
            state,
            [
                N::of_state(state, || top, pushed, limited),
                N::of_state(state, || bottom, || heavier, || bottom),
            ],
        )
    }

    /// F \[N\] of that step, which ends with Ẋ₁ \[m/s\]: never in tension.
    #[inline(always)]
    pub(crate) fn settled(&self, start: &Start<N>, state: N::State, velocity: N) -> N {
        let zero = || self.force_limit.same(0.0);
        let falling = start.striker_velocity + self.fall;
        let stopped = || (self.striker_inertia * (falling - velocity)).larger(zero());
        N::of_state(state, zero, stopped, || self.force_limit)
    }

    /// The striker after a step, `half` of it ½Δt \[s\], the struck degree of freedom at `displacement` \[m\] with `velocity` \[m/s\] then; `moved` is
    /// ½Δt(v₀+v₁).
    #[inline(always)]
    pub(crate) fn advance(
        &self,
        half: N,
        start: &Start<N>,
        decided: &Decided<N>,
        [displacement, velocity, moved]: [N; 3],
    ) -> StrikerEnd<N> {
        let Decided { state, force } = *decided;
        let falling = start.striker_velocity + self.fall;
        let striker_velocity = N::of_state(
            state,
            || falling,
            || velocity,
            || falling - force * self.striker_compliance,
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
        StrikerEnd {
            displacement: striker_displacement,
            velocity: striker_velocity,
            indentation,
            contact_loss: force * striker_moved - (start.contact_force + force) * (moved * 0.5),
            indentation_work,
        }
    }
}
