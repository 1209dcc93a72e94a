//! Coefficients of the integrators, for one degree of freedom and for many. In: an integrator by name. Out: numbers. It integrates nothing.
//!
//! All three are members of one family. With the displacement `d̃` imposed on the specimen and the force r̃ read there,
//!
//! ```text
//! d̃₁ = d + Δt·v + Δt²(½ − β)a        ṽ₁ = v + Δt(1 − γ)a
//! M a₁ = (1+α)(f₁ − r₁ − C v₁) − α(f₀ − r₀ − C v₀)
//! d₁ = d̃₁ + βΔt²a₁                   v₁ = ṽ₁ + γΔt·a₁
//! ```
//!
//! (that of HHT-α, by Hilber, Hughes and Taylor). They differ in r₁: explicit Newmark has β = 0, so that it is read at the end of the step;
//! α-OS reads r̃₁ at d̃₁ and corrects it, r₁ = r̃₁ + K_I(d₁ − d̃₁); the tangent form predicts it before the step,
//! r₁ = r₀ + `K_t`(d₁ − d₀), and imposes d₁.
//!
//! **Sign of α.** It is 0 or negative, as in HHT-α: −⅓ ≤ α ≤ 0, the more negative the more numerical damping of the modes
//! that the step does not resolve. Programs that weight the new instant by `α` itself (`OpenSees`: ⅔ ≤ `α` ≤ 1) mean our 1 + α.

use crate::integrator::Integrator;

/// Coefficients of a member of this family.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients {
    pub alpha: f64,
    pub beta: f64,
    pub gamma: f64,
}

impl Coefficients {
    /// α-OS: β = (1 − α)²/4 and γ = ½ − α, of second order for every α.
    #[must_use]
    pub fn of(integrator: Integrator) -> Self {
        match integrator {
            Integrator::Tangent => Self {
                alpha: 0.0,
                beta: 0.25,
                gamma: 0.5,
            },
            Integrator::Explicit => Self {
                alpha: 0.0,
                beta: 0.0,
                gamma: 0.5,
            },
            Integrator::AlphaOs { alpha } => Self {
                alpha,
                beta: 0.25 * (1.0 - alpha) * (1.0 - alpha),
                gamma: 0.5 - alpha,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// γ = ½ − α makes every member of second order; without α it is Newmark's constant average acceleration.
    #[test]
    fn without_alpha_splitting_has_the_coefficients_of_the_tangent_form() {
        assert_eq!(
            Coefficients::of(Integrator::AlphaOs { alpha: 0.0 }),
            Coefficients::of(Integrator::Tangent)
        );
        let third = Coefficients::of(Integrator::AlphaOs { alpha: -1.0 / 3.0 });
        assert!((third.beta - 4.0 / 9.0).abs() < 1e-15 && (third.gamma - 5.0 / 6.0).abs() < 1e-15);
    }
}
