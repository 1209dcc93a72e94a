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

    /// K_t minus a stiffness \[N/m\].
    pub(crate) const fn less(self, stiffness: f64) -> Self {
        Self {
            force: self.force - stiffness * self.displacement,
            displacement: self.displacement,
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
    /// A body and its time step.
    pub struct Body {
        /// M + ½ΔtC \[kg\]
        damped_mass,
        /// C \[N·s/m\]
        damping,
        /// ½Δt \[s\]
        half,
        /// ¼Δt² \[s²\]
        quarter,
    }
}

impl Body {
    /// Of M \[kg\] and C \[N·s/m\].
    pub(crate) const fn new([mass, damping]: [f64; 2], time_step: f64) -> Self {
        let half = 0.5 * time_step;
        Self {
            damped_mass: mass + half * damping,
            damping,
            half,
            quarter: half * half,
        }
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

impl<N: Number> Body<N> {
    /// Eq. (5) from (Ẋ, Ẍ), with f₁ − R \[N\]; without damping C is not read.
    #[inline(always)]
    pub(crate) fn unforced(
        &self,
        damped: bool,
        [velocity, acceleration]: [N; 2],
        unbalanced: N,
        secant: &Secant<N>,
    ) -> Unforced<N> {
        let gained = self.half * acceleration;
        let glide = velocity + gained;
        let drift = self.half * (velocity + velocity + gained);
        let push = if damped {
            unbalanced - self.damping * glide
        } else {
            unbalanced
        };
        Unforced {
            glide,
            top: push * secant.displacement - secant.force * drift,
            bottom: self.damped_mass * secant.displacement + self.quarter * secant.force,
            response: secant.displacement,
            drift,
        }
    }

    /// Eqs. (2c) and (2d): X₁ = X + ½Δt(Ẋ + Ẋ₁), Ẋ₁ = Ẋ + ½Δt(Ẍ + Ẍ₁), as (X₁, Ẋ₁). X₁ does not wait for Ẋ₁.
    #[inline(always)]
    pub(crate) fn travel(&self, from: N, unforced: &Unforced<N>, acceleration_end: N) -> [N; 2] {
        [
            from + (unforced.drift + self.quarter * acceleration_end),
            unforced.glide + self.half * acceleration_end,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LARGEST: f64 = 2000.0;

    /// 1000 N/m, then a rise \[N\] over a change \[m\], forwards and backwards.
    fn after(rise: f64, change: f64) -> f64 {
        let [forwards, backwards] = [1.0, -1.0].map(|sign| {
            let before = Secant::of(1000.0);
            let secant = before.after(sign * rise, sign * change, LARGEST, LEAST_CHANGE);
            secant.stiffness()
        });
        assert_eq!(forwards.to_bits(), backwards.to_bits());
        forwards
    }

    #[test]
    fn a_secant_stays_within_its_bounds() {
        assert_eq!(after(0.3, 1e-3), 0.3 / 1e-3);
        assert_eq!(after(5.0, 1e-3), LARGEST, "stiffer than the bound");
        assert_eq!(after(-5.0, 1e-3), 0.0, "softening");
        assert_eq!(after(5.0, 0.0), 1000.0, "without motion");
        assert_eq!(after(1e-150, 1e-153), 1000.0, "below the least change");
    }

    /// Eq. (5) with the same K_t as a ratio of small and of large numbers, against the one with divisions.
    #[test]
    fn the_ratio_is_eq_5() {
        let (mass, damping, time_step, stiffness) = (1.3, 2.0, 1e-2, 327.65);
        let (velocity, acceleration, force) = (0.7, -20.0, 9.0);
        let half = 0.5 * time_step;
        let drift = time_step * velocity + half * half * acceleration;
        let push = -force - damping * (velocity + half * acceleration) - stiffness * drift;
        let exact = push / (mass + half * damping + half * half * stiffness);
        let body = Body::new([mass, damping], time_step);
        for change in [1e-12, -1e-3, 1.0, 1e3] {
            let secant = Secant {
                force: stiffness * change,
                displacement: change,
            };
            let unforced = body.unforced(true, [velocity, acceleration], -force, &secant);
            let found = unforced.top / unforced.bottom;
            assert!((found / exact - 1.0).abs() < 1e-14, "{change}: {found}");
        }
    }
}
