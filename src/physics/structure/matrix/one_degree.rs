//! The tangent form of one degree of freedom, for a number or for several side by side: eqs. (2c), (2d) and (5). In: the start of a step.
//! Out: its parts. The steps of a structure and those of many impacts at once are made of them.
//!
//! A division takes as long as four sums in a row, and each step waits for the one before. With K_t = ΔR/ΔX as a ratio, eq. (5) times ΔX
//! has one division:
//!
//! ```text
//! Ẍ₁ = top/bottom,    top = (f₁ − R − C(Ẋ + ½ΔtẌ))·ΔX − ΔR·(ΔtẊ + ¼Δt²Ẍ),    bottom = (M + ½ΔtC)·ΔX + ¼Δt²·ΔR
//! ```
//!
//! `bottom` has the sign of ΔX.

#![allow(
    clippy::inline_always,
    reason = "a part of its caller, which is compiled for several vector units"
)]

use crate::number::{Answer as _, Number, numbers};

/// A shorter change of displacement gives no secant \[m\]: its products would be below the smallest numbers.
pub(crate) const LEAST_CHANGE: f64 = 1e-100;

numbers! {
    /// K_t as a ratio, ΔR/ΔX.
    pub struct Secant {
        /// ΔR \[N\], 0 or with the sign of ΔX.
        force,
        /// ΔX \[m\], not 0.
        displacement,
    }
}

impl Secant {
    /// Of this stiffness \[N/m\].
    pub(crate) const fn of(stiffness: f64) -> Self {
        Self {
            force: stiffness,
            displacement: 1.0,
        }
    }

    /// K_t \[N/m\]
    pub(crate) const fn stiffness(&self) -> f64 {
        (self.force / self.displacement).abs()
    }
}

impl<N: Number> Secant<N> {
    /// Eq. (6): a change of force \[N\] over its change of displacement \[m\], within 0 and `largest` \[N/m\]; `self` after a change of
    /// at most `least` \[m\].
    #[inline(always)]
    pub(crate) fn after(&self, force: N, displacement: N, largest: N, least: f64) -> Self {
        let zero = force.same(0.0);
        let bound = largest * displacement;
        let (low, high) = (zero.smaller(bound), zero.larger(bound));
        let moved = displacement.abs().gt(force.same(least));
        if (moved & force.ge(low) & force.le(high)).is_surely_yes() {
            return Self {
                force,
                displacement,
            };
        }
        let before = *self;
        N::rarely(move || Self {
            force: N::choose(moved, || force.larger(low).smaller(high), || before.force),
            displacement: N::choose(moved, || displacement, || before.displacement),
        })
    }
}

numbers! {
    /// A step without contact.
    pub(crate) struct Unforced {
        /// Ẋ + ½ΔtẌ \[m/s\]: Ẋ₁ without the part of Ẍ₁.
        glide,
        /// Ẍ₁ = top/bottom
        top,
        bottom,
        /// ΔX of K_t: a force F adds F ΔX to `top`.
        response,
        /// ΔtẊ + ¼Δt²Ẍ \[m\]: X₁ − X without the part of Ẍ₁.
        drift,
    }
}

/// Eq. (5) from (Ẋ, Ẍ), with f₁ and R \[N\].
#[inline(always)]
pub(crate) fn unforced<N: Number>(
    time_step: N,
    [mass, damping]: [N; 2],
    [velocity, acceleration]: [N; 2],
    [load_end, force]: [N; 2],
    secant: &Secant<N>,
) -> Unforced<N> {
    let half = time_step * 0.5;
    let gained = half * acceleration;
    let (glide, drift) = (velocity + gained, half * (velocity + velocity + gained));
    let push = load_end - force - damping * glide;
    Unforced {
        glide,
        top: push * secant.displacement - secant.force * drift,
        bottom: (half * damping + mass) * secant.displacement + half * half * secant.force,
        response: secant.displacement,
        drift,
    }
}

impl<N: Number> Unforced<N> {
    /// Eqs. (2c) and (2d): X₁ = X + ½Δt(Ẋ + Ẋ₁), Ẋ₁ = Ẋ + ½Δt(Ẍ + Ẍ₁), as (X₁, Ẋ₁). X₁ does not wait for Ẋ₁.
    #[inline(always)]
    pub(crate) fn travel(&self, time_step: N, displacement: N, acceleration_end: N) -> [N; 2] {
        let half = time_step * 0.5;
        [
            displacement + (self.drift + half * half * acceleration_end),
            self.glide + half * acceleration_end,
        ]
    }
}
