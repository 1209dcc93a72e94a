//! The tangent form of one degree of freedom, for a number or for several side by side: eqs. (2c), (2d) and (5). In: the start of a step.
//! Out: its parts. The steps of a structure and those of many impacts at once are made of them.

#![allow(
    clippy::inline_always,
    reason = "a part of its caller, which is compiled for several vector units"
)]

use crate::number::Number;

/// M̂ = M + ½Δt(C + ½ΔtK_t) \[kg\].
#[inline(always)]
pub(crate) fn effective_mass<N: Number>(time_step: N, [mass, damping, tangent]: [N; 3]) -> N {
    let half = time_step * 0.5;
    (tangent * half + damping) * half + mass
}

/// F₁ − R − C(Ẋ + ½ΔtẌ) − K_t(ΔtẊ + ¼Δt²Ẍ) \[N\] from (Ẋ, Ẍ); C is None without damping.
#[inline(always)]
pub(crate) fn unbalanced_force<N: Number>(
    time_step: N,
    [velocity, acceleration]: [N; 2],
    [load_end, force]: [N; 2],
    damping: Option<N>,
    tangent: N,
) -> N {
    let half = time_step * 0.5;
    let mut push = load_end - force;
    if let Some(damping) = damping {
        push = push - damping * (velocity + half * acceleration);
    }
    push - tangent * (time_step * (velocity + half * 0.5 * acceleration))
}

/// Eqs. (2c) and (2d): X₁ = X + ½Δt(Ẋ + Ẋ₁), Ẋ₁ = Ẋ + ½Δt(Ẍ + Ẍ₁), as (X₁, Ẋ₁); from (X, Ẋ, Ẍ).
#[inline(always)]
pub(crate) fn travel<N: Number>(
    time_step: N,
    [displacement, velocity, acceleration]: [N; 3],
    acceleration_end: N,
) -> [N; 2] {
    let half = time_step * 0.5;
    let velocity_end = velocity + half * (acceleration + acceleration_end);
    let displacement_end = displacement + half * (velocity + velocity_end);
    [displacement_end, velocity_end]
}
