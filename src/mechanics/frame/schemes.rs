//! One step of a frame under each integrator, as `method` says them for one degree of freedom, with vectors. In: the state at
//! a step's start, loads, the force read. Out: the place to impose, the end of the step. It keeps no history.
//!
//! A blow on one floor enters as a contact force F on that degree of freedom s. Every end velocity is linear in it,
//! Ẋ₁ = `Ẋ_free` + w F there, and whoever knows the striker decides on F from those two. In the tangent form
//!
//! ```text
//! (M + ½ΔtC + ¼Δt²K_t) Ẍ₁ = f₁ − R − C(Ẋ + ½ΔtẌ) − K_t(ΔtẊ + ¼Δt²Ẍ) + F e_s,    w = ½Δt · e_sᵀ M̂⁻¹ e_s
//! ```
//!
//! With F = (Ms/Δt)(Ẋs − Ẋ₁) this is eq. (4) with ½Ms added at (s, s) and nowhere else: the sum of M̂ and one entry is
//! solved through the factor of M̂ (Sherman and Morrison). Explicit Newmark and α-OS keep the contact's acceleration
//! c = M⁻¹ e_s F apart from the structure's own, as the impact of one degree of freedom does:
//!
//! ```text
//! d̃₁ = d + Δt·v + Δt²((½−β)s + (½−β_c)c)      ṽ₁ = v + Δt((1−γ)s + ½c)       (impose d̃₁, read r̃₁)
//! M̂ s₁ = (1+α)(f₁ − r̃₁ − Cṽ₁) − α(f₀ − r₀ − Cv₀) − (1+α)(β_cΔt²K_I + ½ΔtC)·c₁,   M̂ = M + (1+α)(γΔtC + βΔt²K_I)
//! d₁ = d̃₁ + Δt²(β s₁ + β_c c₁),   v₁ = ṽ₁ + γΔt·s₁ + ½Δt·c₁,   r₁ = r̃₁ + K_I(d₁ − d̃₁)
//! ```
//!
//! Without a blow r₀ and v₀ here are the published r̃₀ and ṽ₀ with the corrections of their own step, so that the exact start
//! r̃₀ = r₀ − βΔt²K_I a₀, ṽ₀ = v₀ − γΔt·a₀ needs no line.

use super::FrameMatrices;
use super::band::SymmetricBand;
use super::factor::{BandFactor, NotPositiveDefinite};
use crate::mechanics::method::Coefficients;
use crate::plan::Integrator;

/// A frame and how it is integrated.
#[derive(Clone, Debug)]
pub(super) struct Schemes {
    pub matrices: FrameMatrices,
    pub integrator: Integrator,
    pub time_step: f64,
    coefficients: Coefficients,
    /// `K_t` of the tangent form, K_I of α-OS; not used by explicit Newmark.
    operator: SymmetricBand,
    effective: SymmetricBand,
    factor: BandFactor,
    /// Whether there is damping at all.
    damped: bool,
    scratch: Vec<f64>,
    product: Vec<f64>,
}

/// The motion at one instant, and the force and load there.
#[derive(Clone, Copy)]
pub(super) struct Instant<'a> {
    pub displacement: &'a [f64],
    pub velocity: &'a [f64],
    pub acceleration: &'a [f64],
    /// At the computed displacement.
    pub force: &'a [f64],
    pub load: &'a [f64],
}

/// Where a step leads.
#[derive(Clone, Debug, Default)]
pub(super) struct Course {
    pub displacement: Vec<f64>,
    pub velocity: Vec<f64>,
    pub acceleration: Vec<f64>,
    /// At the computed displacement.
    pub force: Vec<f64>,
}

impl Schemes {
    pub fn new(
        matrices: &FrameMatrices,
        operator: &SymmetricBand,
        integrator: Integrator,
        time_step: f64,
    ) -> Result<Self, NotPositiveDefinite> {
        let order = matrices.order();
        let mut schemes = Self {
            matrices: matrices.clone(),
            integrator,
            time_step,
            coefficients: Coefficients::of(integrator),
            operator: operator.clone(),
            effective: SymmetricBand::zero(order, 0),
            factor: BandFactor::Diagonal(Vec::new()),
            damped: !matrices.damping.is_zero(),
            scratch: vec![0.0; order],
            product: vec![0.0; order],
        };
        schemes.compose();
        schemes.factor = BandFactor::new(&schemes.effective)?;
        Ok(schemes)
    }

    /// M̂ = M + (1+α)Δt(γC + βΔtK).
    fn compose(&mut self) {
        let Coefficients { alpha, beta, gamma } = self.coefficients;
        let half = (1.0 + alpha) * gamma * self.time_step;
        let effective = &mut self.effective;
        if beta == 0.0 {
            effective.copy_from(&self.matrices.damping);
        } else {
            effective.copy_from(&self.operator);
            effective.scale(beta / gamma * self.time_step);
            if self.damped {
                effective.add(&self.matrices.damping, 1.0);
            }
        }
        effective.scale(half);
        effective.add(&self.matrices.mass, 1.0);
    }

    /// Another `K_t`. M̂ stays positive definite: storeys are not negative.
    pub fn set_storeys(&mut self, stiffnesses: &[f64]) -> Result<(), NotPositiveDefinite> {
        super::storeys::set_storeys(stiffnesses, &mut self.operator);
        self.compose();
        self.factor.renew(&self.effective)
    }
}

impl Schemes {
    /// The whole step in tangent form, all but the force that will be read at its end.
    pub fn foretell(&mut self, from: Instant, load_end: &[f64], to: &mut Course) {
        let time_step = self.time_step;
        let half = 0.5 * time_step;
        for ((to, load), force) in to.acceleration.iter_mut().zip(load_end).zip(from.force) {
            *to = load - force;
        }
        if self.damped {
            for ((glide, velocity), acceleration) in self.scratch.iter_mut().zip(from.velocity).zip(from.acceleration) {
                *glide = velocity + half * acceleration;
            }
            self.matrices.damping.mul_add(-1.0, &self.scratch, &mut to.acceleration);
        }
        for ((drift, velocity), acceleration) in self.scratch.iter_mut().zip(from.velocity).zip(from.acceleration) {
            *drift = time_step * (velocity + 0.5 * half * acceleration);
        }
        self.operator.mul_add(-1.0, &self.scratch, &mut to.acceleration);
        self.factor.solve_in_place(&mut to.acceleration);
        self.follow(from, to);
    }

    /// Eqs. (2c), (2d): on with the acceleration found.
    pub fn follow(&self, from: Instant, to: &mut Course) {
        let half = 0.5 * self.time_step;
        let before = from.velocity.iter().zip(from.acceleration);
        for ((to, after), (velocity, acceleration)) in to.velocity.iter_mut().zip(&to.acceleration).zip(before) {
            *to = velocity + half * (acceleration + after);
        }
        let before = from.displacement.iter().zip(from.velocity);
        for ((to, after), (displacement, velocity)) in to.displacement.iter_mut().zip(&to.velocity).zip(before) {
            *to = displacement + half * (velocity + after);
        }
    }

    /// d̃₁ of explicit Newmark and α-OS, and ṽ₁ into `to.velocity`.
    pub fn impose(&mut self, from: Instant, to: &mut Course) {
        let (time_step, Coefficients { beta, gamma, .. }) = (self.time_step, self.coefficients);
        let before = from.displacement.iter().zip(from.velocity).zip(from.acceleration);
        let after = to.displacement.iter_mut().zip(&mut to.velocity);
        for ((place, speed), ((displacement, velocity), acceleration)) in after.zip(before) {
            *place = displacement + time_step * (velocity + time_step * ((0.5 - beta) * acceleration));
            *speed = velocity + time_step * ((1.0 - gamma) * acceleration);
        }
    }

    /// The end of the step that imposed `to.displacement`, where `read` (N) is the force.
    pub fn correct(&mut self, from: Instant, load_end: &[f64], read: &[f64], to: &mut Course) {
        let (time_step, Coefficients { alpha, beta, gamma }) = (self.time_step, self.coefficients);
        let now = 1.0 + alpha;
        let ends = load_end.iter().zip(read).zip(from.load.iter().zip(from.force));
        for (to, ((load, force), (load_before, force_before))) in to.acceleration.iter_mut().zip(ends) {
            *to = now * (load - force) - alpha * (load_before - force_before);
        }
        if self.damped {
            for ((weighed, after), before) in self.scratch.iter_mut().zip(&to.velocity).zip(from.velocity) {
                *weighed = now * after - alpha * before;
            }
            self.matrices.damping.mul_add(-1.0, &self.scratch, &mut to.acceleration);
        }
        self.factor.solve_in_place(&mut to.acceleration);
        to.force.copy_from_slice(read);
        for (velocity, acceleration) in to.velocity.iter_mut().zip(&to.acceleration) {
            *velocity += gamma * time_step * acceleration;
        }
        if beta > 0.0 {
            let ways = self.scratch.iter_mut().zip(&to.acceleration);
            for ((correction, acceleration), displacement) in ways.zip(&mut to.displacement) {
                *correction = beta * time_step * time_step * acceleration;
                *displacement += *correction;
            }
            self.operator.mul_add(1.0, &self.scratch, &mut to.force);
        }
    }

    /// Two vectors of the frame's order for whoever balances energies between steps.
    pub fn scratch(&mut self) -> (&FrameMatrices, &mut [f64], &mut [f64]) {
        (&self.matrices, &mut self.scratch, &mut self.product)
    }
}
