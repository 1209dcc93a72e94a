//! The longest stable step of an integrator on a linear structure. In: an integrator, frequencies, the ratio of the true stiffness to the
//! assumed one. Out: seconds. It integrates nothing.
//!
//! α-OS on a linear structure of stiffness K that it splits with `K_I` is one recursion of three numbers, d, v and a: the force at the
//! end of a step is r₁ = K d₁ − (K − `K_I`)βΔt²·a₁ ([`super::coefficients`]). Its amplification factors z are the roots of
//!
//! ```text
//! z(z − 1)² + ((1+α)z − α)·[ c(1−γ+γz)(z−1) + k((1−γ+γz) + (½−β+βz)(z−1)) − β(k − k_I)(z−1)² ] = 0
//! c = CΔt/M,   k = KΔt²/M,   k_I = K_IΔt²/M
//! ```
//!
//! A step is stable if all of them lie in the unit circle (the criterion of Schur and Cohn, in the form of Jury). Without damping two
//! bounds follow in closed form. With s = (K − `K_I`)/K:
//!
//! - at z = −1 the response becomes unstable beyond `k s = 4 / ((1+2α)((1−α)² − α²/s))`, which for α = 0 is Δt = 2√(M/(K − `K_I`));
//! - at z near exp(iωΔt), ln|z| = ½(ωΔt)⁴·¼|α|·((1−α)²s − (1+α)²) to leading order: if s > ((1+α)/(1−α))² a vibration gains energy from
//!   every step, however short. This gain is small for short steps and is compared with `TRIFLE`.
//!
//! A structure of many degrees of freedom is stable if each pair of Rayleigh quotients of (K, `K_I`) is, because z and its vector x make
//! xᴴ(…)x = 0 the same cubic. The largest s, the highest ω² and the highest K − `K_I` therefore bound all of them.

use super::coefficients::Coefficients;
use crate::integrator::Integrator;
use crate::structure::Matrices;

/// Negative damping ratio of an integrator that is neglected: an amplitude grows by 0.06 % per cycle.
const TRIFLE: f64 = 1e-4;

/// The properties of a structure that determine the stability of an integrator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// ω² of the structure at its largest stiffness \[rad²/s²\].
    pub highest: f64,
    /// The highest of M⁻¹(`K_t` − `K_I`) \[rad²/s²\]; 0 or less if no part is stiffer than its operator.
    pub shortfall: f64,
    /// The largest (`K_t` − `K_I`)/`K_t` of its springs.
    pub share: f64,
    /// Damping ratio of the highest frequency.
    pub damping_ratio: f64,
}

impl Met {
    /// One degree of freedom and the operator stiffness \[N/m\].
    #[must_use]
    pub fn one(structure: &Matrices<f64>, operator_stiffness: f64) -> Self {
        let Matrices {
            mass,
            damping,
            stiffness,
            ..
        } = *structure;
        let beyond = stiffness - operator_stiffness;
        Self {
            highest: stiffness / mass,
            shortfall: beyond / mass,
            share: beyond / stiffness,
            damping_ratio: 0.5 * damping / (stiffness * mass).sqrt(),
        }
    }
}

/// Longest stable Δt \[s\]; infinite if there is no limit.
///
/// - Explicit Newmark: Δt ≤ T/π = 2/ω for the highest frequency of the structure. Beyond it the roots of z² − (2 − ω²Δt²)z + 1 leave the
///   unit circle.
/// - α-OS: no limit while `K_I ≥ K_t`; otherwise from its amplification factors, above.
/// - Tangent: constant average acceleration has no limit as long as its tangent is that of the structure. See [`super::tangent`] for a
///   changing tangent.
#[must_use]
pub fn longest_stable_step(integrator: Integrator, met: &Met) -> f64 {
    match integrator {
        Integrator::Explicit if met.highest > 0.0 => 2.0 / met.highest.sqrt(),
        Integrator::AlphaOs { .. } if met.shortfall > 0.0 => {
            let (alpha, largest) = (
                Coefficients::of(integrator).alpha,
                longest_angle(integrator, met),
            );
            let gains = met.share > ((1.0 + alpha) / (1.0 - alpha)).powi(2);
            largest
                / if gains {
                    met.highest.sqrt()
                } else {
                    (met.shortfall / met.share).sqrt()
                }
        }
        Integrator::Tangent | Integrator::Explicit | Integrator::AlphaOs { .. } => f64::INFINITY,
    }
}

/// The smallest ωΔt from which α-OS is unstable, with ω of K.
fn longest_angle(integrator: Integrator, met: &Met) -> f64 {
    let damping_ratio = met.damping_ratio.max(TRIFLE);
    let stable = |angle: f64| {
        let k = angle * angle;
        let step = ScaledStep {
            damping: 2.0 * damping_ratio * angle,
            stiffness: k,
            operator_stiffness: (1.0 - met.share) * k,
        };
        inside(amplification(Coefficients::of(integrator), &step))
    };
    let (mut low, mut high) = (0.0, 0.01);
    while stable(high) {
        (low, high) = (high, 1.02 * high);
        if high > 1e4 {
            return f64::INFINITY;
        }
    }
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return low;
        }
        if stable(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// A step of one degree of freedom, over its mass.
struct ScaledStep {
    /// c = CΔt/M
    damping: f64,
    /// k = KΔt²/M
    stiffness: f64,
    /// `k_I` = `K_I`Δt²/M
    operator_stiffness: f64,
}

/// Coefficients of the cubic, from z³ down.
fn amplification(by: Coefficients, step: &ScaledStep) -> [f64; 4] {
    let Coefficients { alpha, beta, gamma } = by;
    let ScaledStep {
        damping: c,
        stiffness: k,
        operator_stiffness: operator,
    } = *step;
    let beyond = beta * (k - operator);
    // The bracket, from z² down.
    let two = c * gamma + k * beta - beyond;
    let one = c * (1.0 - 2.0 * gamma) + k * (gamma + 0.5 - 2.0 * beta) + 2.0 * beyond;
    let none = -c * (1.0 - gamma) + k * (0.5 - gamma + beta) - beyond;
    let now = 1.0 + alpha;
    [
        1.0 + now * two,
        -2.0 + now * one - alpha * two,
        1.0 + now * none - alpha * one,
        -alpha * none,
    ]
}

/// Whether all roots of a real cubic lie in the unit circle or on it (Jury's criterion). p(1) > 0 is assumed because it equals k.
fn inside([three, two, one, none]: [f64; 4]) -> bool {
    three > 0.0
        && -three + two - one + none <= 0.0
        && none.abs() <= three
        && (none * two - one * three).abs() <= three * three - none * none
}

#[cfg(test)]
mod tests {
    use super::*;

    fn split(alpha: f64, share: f64, damping_ratio: f64) -> f64 {
        let met = Met {
            highest: 400.0,
            shortfall: 400.0 * share,
            share,
            damping_ratio,
        };
        longest_stable_step(Integrator::AlphaOs { alpha }, &met)
    }

    #[test]
    fn explicit_newmark_is_stable_up_to_the_period_over_pi() {
        let omega: f64 = 2.0 * std::f64::consts::PI / 0.5;
        let limit = longest_stable_step(
            Integrator::Explicit,
            &Met::one(
                &Matrices {
                    mass: 1.0,
                    damping: 0.0,
                    stiffness: omega * omega,
                    gravity: None,
                },
                0.0,
            ),
        );
        assert!((limit - 0.5 / std::f64::consts::PI).abs() < 1e-15);
    }

    #[test]
    fn splitting_needs_a_limit_only_where_the_specimen_is_stiffer_than_its_operator() {
        for alpha in [0.0, -0.05, -1.0 / 3.0] {
            assert_eq!(split(alpha, -0.01, 0.0), f64::INFINITY);
            assert_eq!(split(alpha, 0.0, 0.0), f64::INFINITY);
        }
        assert_eq!(
            longest_stable_step(
                Integrator::Tangent,
                &Met::one(
                    &Matrices {
                        mass: 1.0,
                        damping: 0.0,
                        stiffness: 400.0,
                        gravity: None,
                    },
                    300.0
                )
            ),
            f64::INFINITY
        );
    }

    /// Without α it is 2/√(ω² − ω_I²), whatever the damping.
    #[test]
    fn without_alpha_the_limit_is_that_of_the_shortfall() {
        for (share, damping_ratio) in [(0.25, 0.0), (0.25, 0.1), (0.9, 0.0), (0.5, 0.02)] {
            let limit = split(0.0, share, damping_ratio);
            assert!(
                (limit / (2.0 / (400.0 * share).sqrt()) - 1.0).abs() < 1e-9,
                "{share} {limit}"
            );
        }
    }

    /// The closed form at z = −1, as long as no vibration gains energy: there α increases the limit.
    #[test]
    fn alpha_moves_the_limit_as_in_the_closed_form() {
        for (alpha, share) in [(-0.05, 0.5), (-0.1, 0.5), (-0.2, 0.25), (-0.3, 0.2)] {
            let room = (1.0_f64 - alpha).powi(2) - alpha * alpha / share;
            let exact = (4.0 / ((1.0 + 2.0 * alpha) * room) / (400.0 * share)).sqrt();
            let limit = split(alpha, share, 0.0);
            assert!(exact > 2.0 / (400.0 * share).sqrt());
            assert!(
                (limit / exact - 1.0).abs() < 1e-3,
                "α {alpha}, share {share}: {limit} {exact}"
            );
        }
        assert_eq!(
            split(-1.0 / 3.0, 0.06, 0.0),
            f64::INFINITY,
            "(1 − α)² s < α²"
        );
    }

    /// Beyond s = ((1+α)/(1−α))² a vibration gains energy in every step; damping compensates it up to a limit that falls with s.
    #[test]
    fn where_a_vibration_gains_the_limit_is_what_damping_pays_for() {
        for (alpha, share) in [(-0.2, 0.5), (-0.3, 0.5), (-1.0_f64 / 3.0, 0.75)] {
            let (plus, less) = ((1.0 + alpha).powi(2), (1.0 - alpha).powi(2));
            assert!(share > plus / less);
            for damping_ratio in [1e-4, 1e-3] {
                // ζ = ½(ωΔt)³·¼|α|·((1−α)²s − (1+α)²), to leading order.
                let angle: f64 = (8.0 * damping_ratio / (-alpha * (less * share - plus))).cbrt();
                let limit = split(alpha, share, damping_ratio);
                assert!(
                    (20.0 * limit / angle - 1.0).abs() < 0.12,
                    "α {alpha}, share {share}: {} {angle}",
                    20.0 * limit
                );
            }
            assert!(split(alpha, share, 0.0) < 0.5 * 2.0 / (400.0 * share).sqrt());
        }
    }
}
