//! What an actuator that misses its targets makes of a vibration: by how much the amplitude grows in a cycle, to every order of the
//! step. In: an integrator, one mode, how the actuator follows. Out: the logarithm of the growth. It integrates nothing.
//!
//! An actuator that is linear goes to m = H(z)·d where it was sent to d, z the factor of one step, and the integrator meets the stiffness
//! H·K for K: its amplification factors ([`super::stability`]) are the roots of
//!
//! ```text
//! z(z − 1)² + ((1+α)z − α)·[ c(1−γ+γz)(z−1) + k((1−γ+γz) + (½−β+βz)(z−1)) − β(k − k_I)(z−1)² ] = 0,   k = H(z)·KΔt²/M
//! ```
//!
//! The tangent form foretells the force of a step from the one before it: it meets 1 − (1 − H)/z for H. With the I-modification
//! r* = H·K·d − `K_I`(H − 1)d it is H + (1 − H)`K_I`/K. One step multiplies the vibration by the root near exp(iωΔt), so that in a cycle
//! ln of the amplitude grows by 2π·ln|z|/arg z, of which the part that is there without the actuator (α, C) is not counted.
//!
//! **H of a pause.** The piston falls short of its increment by the share t, which it takes from where it stands, and lags by τ: over a
//! move of T and a rest of P (E = reference − m, `e₁ = (steady + (e₀ − steady)e^(−T/τ))e^(−P/τ)`, steady = τ/T of the increment) with
//! g = (τ/T)(1 − e^(−T/τ))e^(−P/τ) and ρ = e^(−(T+P)/τ)
//!
//! ```text
//! G = g(1 − 1/z)/(1 − ρ/z),   H = (1−t)(1−G)/(1 − (t/z)(1−G)),   late by D = Δt·(t + g/(1−ρ))/(1−t)
//! ```
//!
//! **H of a glide.** It passes its targets on a smooth path: what varies as z^(s/Δt) lags as L = 1/(1 + λ ln z), λ = τ over the rig time of
//! a step. Each step is gone in two ways, the share a of it before the target is known, and each falls short by itself, of what it is then
//! away: by w = t(z^(a−1) − m₋₁) at the end of the first and by t(1 − m_a) at the end of the second, evenly from one to the other. That
//! lags too (ŵ), but as what is bent at every end does: over a way of X time constants, with ρ = e^(−X) and φ = (1 − ρ)/X,
//! `ŵ₁ = (1 − φ)w₁ + (φ − ρ)w₀ + ρŵ₀`. H = L − ŵ solves these.
//!
//! To first order in D an amplitude grows by exp(πωD) a cycle, whatever the integrator: a place late by D is the damper −K·D.

use nalgebra::Complex;

use super::method::Coefficients;
use crate::plan::Integrator;

/// Share of a step of a glide in which its target is not known yet.
pub const AHEAD: f64 = 0.2;

/// Steps of Newton's, at most.
const MOST_STEPS: usize = 60;

/// How an actuator follows its targets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Following {
    /// Share of each increment that is not reached, taken from where it stands: t.
    pub short: f64,
    pub lag: Lag,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lag {
    /// With a stop at every step: g, and ρ.
    Paused { behind: f64, carried: f64 },
    /// Without: λ.
    Gliding { steps: f64 },
}

/// One mode of a structure, as the integrator meets it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// ωΔt
    pub angle: f64,
    pub damping_ratio: f64,
    /// `K_I`/K, of α-OS and the I-modification.
    pub operator: f64,
    pub i_modification: bool,
}

impl Following {
    /// H(z).
    fn transfer(&self, z: Complex<f64>) -> Complex<f64> {
        let (one, short) = (Complex::new(1.0, 0.0), self.short);
        match self.lag {
            Lag::Paused { behind, carried } => {
                let reached = one - (one - one / z) * behind / (one - one / z * carried);
                reached * (1.0 - short) / (one - reached * short / z)
            }
            Lag::Gliding { steps } => glides(z, short, steps),
        }
    }

    /// D over Δt, to first order.
    #[must_use]
    pub fn delay(&self) -> f64 {
        let short = self.short;
        match self.lag {
            Lag::Paused { behind, carried } => {
                (short + if behind > 0.0 { behind / (1.0 - carried) } else { 0.0 }) / (1.0 - short)
            }
            Lag::Gliding { .. } => {
                // Of a mode so slow that the next order is far below rounding.
                let angle = 1e-5;
                -self.transfer(Complex::new(0.0, angle).exp()).im / angle
            }
        }
    }

    /// ln of what an amplitude grows by in a cycle; None where the mode does not vibrate, or a step is too long for it.
    #[must_use]
    pub fn growth(&self, integrator: Integrator, mode: &Mode) -> Option<f64> {
        let exact = |_: Complex<f64>| Complex::new(1.0, 0.0);
        let found = factor(integrator, mode, &|z| self.transfer(z))?;
        let undisturbed = factor(integrator, mode, &exact)?;
        let a_cycle = |z: Complex<f64>| std::f64::consts::TAU * z.norm().ln() / z.arg();
        let growth = a_cycle(found) - a_cycle(undisturbed);
        growth.is_finite().then_some(growth)
    }
}

/// H(z) of a glide with the lag λ.
fn glides(z: Complex<f64>, short: f64, steps: f64) -> Complex<f64> {
    let one = Complex::new(1.0, 0.0);
    let (before, known) = (one / z, (z.ln() * (AHEAD - 1.0)).exp());
    let lag = one / (one + z.ln() * steps);
    // Shares of w₁, w₀ and ŵ₀ in ŵ₁.
    let way = |share: f64| {
        let constants = share / steps;
        let (fall, mean) = if steps > 0.0 { ((-constants).exp(), -(-constants).exp_m1() / constants) } else { (0.0, 0.0) };
        [1.0 - mean, mean - fall, fall]
    };
    let ([now, from, kept], [now_2, from_2, kept_2]) = (way(AHEAD), way(1.0 - AHEAD));
    // ŵ at the end of the first way and of the second, by w at those ends.
    let each = one / (one - before * (kept * kept_2));
    let first = [(one * now + before * (kept * from_2)) * each, before * (from + kept * now_2) * each];
    let second = [each * (kept_2 * now + from_2), (before * (kept_2 * from) + one * now_2) * each];
    // w₁ = t(z^(a−1) − L/z + ŵ₂/z) and w₂ = t(1 − L z^(a−1) + ŵ₁).
    let matrix = [[one - before * second[0] * short, -before * second[1] * short], [-first[0] * short, one - first[1] * short]];
    let right = [(known - before * lag) * short, (one - lag * known) * short];
    let determinant = matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0];
    let ends = [
        (right[0] * matrix[1][1] - matrix[0][1] * right[1]) / determinant,
        (matrix[0][0] * right[1] - right[0] * matrix[1][0]) / determinant,
    ];
    lag - second[0] * ends[0] - second[1] * ends[1]
}

/// The amplification factor of one step near exp(iωΔt), by Newton's method.
fn factor(integrator: Integrator, mode: &Mode, transfer: &dyn Fn(Complex<f64>) -> Complex<f64>) -> Option<Complex<f64>> {
    let left = |z: Complex<f64>| characteristic(integrator, mode, transfer, z);
    let mut z = Complex::new(0.0, mode.angle).exp();
    for _ in 0..MOST_STEPS {
        let by = Complex::new(1e-6, 0.0);
        let slope = (left(z + by) - left(z - by)) / (by * 2.0);
        let step = left(z) / slope;
        z -= step;
        if step.norm() <= 1e-15 * z.norm() {
            break;
        }
        if !z.norm().is_finite() {
            return None;
        }
    }
    let small = left(z).norm() <= 1e-9 * mode.angle.powi(2).min(1.0);
    (small && z.arg() > 0.0 && z.arg() < std::f64::consts::PI).then_some(z)
}

/// What is 0 where z is an amplification factor.
fn characteristic(
    integrator: Integrator,
    mode: &Mode,
    transfer: &dyn Fn(Complex<f64>) -> Complex<f64>,
    z: Complex<f64>,
) -> Complex<f64> {
    let Coefficients { alpha, beta, gamma } = Coefficients::of(integrator);
    let (one, exact) = (Complex::new(1.0, 0.0), mode.angle * mode.angle);
    let (damping, splits) = (2.0 * mode.damping_ratio * mode.angle, matches!(integrator, Integrator::AlphaOs { .. }));
    let mut met = transfer(z);
    if mode.i_modification {
        met += (one - met) * mode.operator;
    }
    if integrator == Integrator::Tangent {
        met = one - (one - met) / z;
    }
    let stiffness = met * exact;
    let beyond = if splits { stiffness - one * (mode.operator * exact) } else { Complex::new(0.0, 0.0) };
    let (turn, end) = (z - one, one * (1.0 - gamma) + z * gamma);
    let place = end + (one * (0.5 - beta) + z * beta) * turn;
    let bracket = end * turn * damping + stiffness * place - beyond * turn * turn * beta;
    z * turn * turn + (z * (1.0 + alpha) - one * alpha) * bracket
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::contact::ContactLaw;
    use crate::mechanics::following::{Followers, Manner, Pace};
    use crate::mechanics::impact::{ImpactInput, ImpactSolver};

    const OMEGA: f64 = 4.0 * std::f64::consts::PI;
    const AT_ONCE: Lag = Lag::Paused { behind: 0.0, carried: 0.0 };
    const MODE: Mode = Mode { angle: 0.0, damping_ratio: 0.0, operator: 1.0, i_modification: false };
    const ALL: [Integrator; 4] =
        [Integrator::Tangent, Integrator::Explicit, Integrator::AlphaOs { alpha: 0.0 }, Integrator::AlphaOs { alpha: -0.1 }];

    /// A mass of 1 kg on a spring, pulled to 1 m, sent where the solver says and read where `go` says: ln of the growth of a cycle and
    /// the angle of a step, by the recursion d₁ = 2·Re z·d − |z|²·d₋₁ that is left when all else has died.
    fn vibrating(integrator: Integrator, mode: &Mode, go: &mut dyn FnMut(f64) -> f64) -> f64 {
        let (stiffness, time_step) = (OMEGA * OMEGA, mode.angle / OMEGA);
        let input = ImpactInput {
            mass: 1.0,
            damping: 2.0 * mode.damping_ratio * OMEGA,
            stiffness,
            striker_mass: 1.0,
            striker_velocity: 0.0,
            gap: 1e6,
            gravity: 0.0,
            time_step,
            max_tangent_ratio: 10.0,
            law: ContactLaw::Rigid,
            integrator,
            operator_stiffness: mode.operator * stiffness,
            i_modification: mode.i_modification,
            force_noise: 0.0,
            resolution: 0.0,
        };
        let mut solver = ImpactSolver::new(&input, 0.0, 0.0);
        let mut last = [0.0; 4];
        // Set off by a force that is read at the first step.
        for step in 0..400 {
            let target = solver.predict();
            let place = go(target);
            let kick = if step == 0 { -1.0 } else { 0.0 };
            let state = solver.complete(place, stiffness * place + kick);
            last = [last[1], last[2], last[3], state.displacement];
        }
        let [a, b, c, d] = last;
        let size = (c * c - b * d) / (b * b - a * c);
        let twice = (d * a - b * c) / (a * c - b * b);
        let angle = (0.5 * twice / size.sqrt()).acos();
        std::f64::consts::PI * size.ln() / angle
    }

    /// The solver itself, on a spring with actuators that fall short, go too far, or lag with a pause and without: the growth of a
    /// cycle is the root's, to rounding.
    #[test]
    fn the_growth_of_the_solver_is_the_roots() {
        for integrator in ALL {
            for (damping_ratio, operator, i_modification) in [(0.0, 1.0, false), (0.02, 1.2, false), (0.01, 0.8, true)] {
                for (short, behind) in [(0.1, 0.0), (-0.1, 0.0), (0.0, 0.2), (0.05, 0.1)] {
                    let mode = Mode { angle: 0.12, damping_ratio, operator, i_modification };
                    let carried = 0.5 * behind;
                    let following = Following { short, lag: Lag::Paused { behind, carried } };
                    let told = following.growth(integrator, &mode).unwrap();
                    let (mut reference, mut lagging) = (0.0, 0.0);
                    let mut go = |target: f64| {
                        let aim = target - short * (target - (reference - lagging));
                        lagging = behind * (aim - reference) + carried * lagging;
                        reference = aim;
                        reference - lagging
                    };
                    let alone = vibrating(integrator, &mode, &mut |target| target);
                    let found = vibrating(integrator, &mode, &mut go) - alone;
                    assert!((found - told).abs() < 1e-6, "{integrator:?}, {short} short, {behind} behind: {found}, told {told}");
                }
            }
        }
    }

    /// The published ten cycles of fifty steps (`tests/suite/physics/tracking.rs`) with explicit Newmark: what is printed is the largest
    /// |d| in the tenth of them, which is where it ends of one that grows and where it begins of one that shrinks.
    #[test]
    fn the_published_growth_is_foretold() {
        let mode = Mode { angle: OMEGA * 0.01, ..MODE };
        let over = |short: f64, cycles: f64| {
            let following = Following { short, lag: AT_ONCE };
            (following.growth(Integrator::Explicit, &mode).unwrap() * cycles).exp()
        };
        assert!((over(0.1, 10.0) - 1.549).abs() < 1e-3, "{}", over(0.1, 10.0));
        assert!((over(-0.1, 9.0) - 0.723).abs() < 1e-3, "{}", over(-0.1, 9.0));
    }

    /// πωD is the growth to the first order of ωΔt: what is left falls with the square of the step, for every integrator.
    #[test]
    fn a_delay_is_a_negative_damper_to_the_second_order_of_the_step() {
        for integrator in ALL {
            for following in [
                Following { short: 0.1, lag: AT_ONCE },
                Following { short: -0.1, lag: AT_ONCE },
                Following { short: 0.0, lag: Lag::Paused { behind: 0.3, carried: 0.4 } },
                Following { short: 0.05, lag: Lag::Gliding { steps: 0.5 } },
            ] {
                let off = |angle: f64| {
                    let mode = Mode { angle, ..MODE };
                    let first = std::f64::consts::PI * angle * following.delay();
                    following.growth(integrator, &mode).unwrap() / first - 1.0
                };
                let [coarse, fine, finest] = [0.08, 0.04, 0.02].map(off);
                for order in [(coarse / fine).abs().log2(), (fine / finest).abs().log2()] {
                    assert!((1.8..2.2).contains(&order), "{integrator:?} {following:?}: {coarse} {fine} {finest}, {order}");
                }
            }
        }
    }

    /// Where the operator is the spring's own, the I-modification leaves nothing of it.
    #[test]
    fn a_force_corrected_along_the_spring_grows_by_nothing() {
        let following = Following { short: 0.2, lag: Lag::Paused { behind: 0.3, carried: 0.1 } };
        for integrator in ALL {
            let growth = following.growth(integrator, &Mode { angle: 0.2, i_modification: true, ..MODE });
            assert!(growth.unwrap().abs() < 1e-9, "{integrator:?}");
        }
    }

    /// D of the closed form is the delay of actuators on a slow sine.
    #[test]
    fn the_delay_is_that_of_actuators_on_a_slow_way() {
        let angle = 1e-3;
        for (short, lag, move_time, rest) in
            [(0.1, 0.0, 0.1, 0.0), (0.1, 0.05, 0.1, 0.02), (0.0, 0.2, 0.1, 0.05), (-0.1, 0.1, 0.1, 0.0)]
        {
            // Evenly gone ways, all of one length.
            let pace = Pace::Paused { speed: angle / move_time, band: 0.0, slow: f64::INFINITY, rest };
            let mut followers = Followers::new(Manner { short, lag, pace }, 1);
            let mut place = [0.0];
            for step in 1..=2000_u32 {
                followers.go(&[angle * f64::from(step)], &mut place);
            }
            let delay = (angle * 2000.0 - place[0]) / angle;
            let (behind, carried) = if lag > 0.0 {
                let fall = |time: f64| f64::exp(-time / lag);
                (lag / move_time * (1.0 - fall(move_time)) * fall(rest), fall(move_time + rest))
            } else {
                (0.0, 0.0)
            };
            let told = Following { short, lag: Lag::Paused { behind, carried } }.delay();
            assert!((delay / told - 1.0).abs() < 1e-6, "{short}, {lag}: {delay} steps, told {told}");
        }
    }
}
