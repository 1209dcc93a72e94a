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
use super::sweeps::{set_out, set_out_tridiagonal, travel};
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
    struck: Option<Struck>,
    scratch: Vec<f64>,
    product: Vec<f64>,
}

/// The motion at one instant, and the force and load there.
#[derive(Clone, Copy)]
pub(super) struct Moment<'a> {
    pub displacement: &'a [f64],
    pub velocity: &'a [f64],
    pub acceleration: &'a [f64],
    /// At the computed displacement.
    pub force: &'a [f64],
    pub load: &'a [f64],
}

/// Decides on the contact force of a step, N, from the velocity that the struck degree of freedom would end with (m/s), and
/// from w, how much a force adds to it (m/s/N).
pub(super) type Decide<'a> = &'a mut dyn FnMut(f64, f64) -> f64;

/// Takes a frame through a whole step on a law's own way, from where it is and under the loads at the step's end (N): the
/// end goes into the course, what dampers took is told (J).
pub(super) type Pass<'a> = &'a mut dyn FnMut(&Schemes, Moment, &[f64], &mut Course) -> f64;

/// A degree of freedom that a body strikes.
#[derive(Clone, Debug)]
struct Struck {
    place: usize,
    /// M⁻¹ e_s, 1/kg
    push: Vec<f64>,
    /// M̂⁻¹ e_s in tangent form, 1/kg; under the others M̂⁻¹ (1+α)(β_cΔt²K_I + ½ΔtC) M⁻¹ e_s, what the structure takes back.
    response: Vec<f64>,
    /// F of the step under way or, before it is decided, of the last one, N.
    force: f64,
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
            struck: None,
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
        self.factor.renew(&self.effective)?;
        self.respond();
        Ok(())
    }

    /// A body may strike this degree of freedom.
    pub fn strike(&mut self, place: usize) -> Result<(), NotPositiveDefinite> {
        let mut push = vec![0.0; self.matrices.order()];
        push[place] = 1.0;
        BandFactor::new(&self.matrices.mass)?.solve_in_place(&mut push);
        self.struck = Some(Struck { place, response: push.clone(), push, force: 0.0 });
        self.respond();
        Ok(())
    }

    /// β of the contact's part: the trapezoidal rule, but for explicit Newmark, which has none.
    fn contact_beta(&self) -> f64 {
        if self.integrator == Integrator::Explicit { 0.0 } else { 0.25 }
    }

    /// What the factor makes of a unit force at the struck degree of freedom.
    fn respond(&mut self) {
        let (time_step, beta) = (self.time_step, self.contact_beta());
        let Some(struck) = &mut self.struck else { return };
        struck.response.fill(0.0);
        if self.integrator == Integrator::Tangent {
            struck.response[struck.place] = 1.0;
        } else {
            let now = 1.0 + self.coefficients.alpha;
            if beta > 0.0 {
                self.operator.mul_add(now * beta * time_step * time_step, &struck.push, &mut struck.response);
            }
            self.matrices.damping.mul_add(now * 0.5 * time_step, &struck.push, &mut struck.response);
        }
        self.factor.solve_in_place(&mut struck.response);
    }

    /// x ← x + `force` M⁻¹e_s, `force` on the struck degree of freedom.
    pub fn push(&self, force: f64, x: &mut [f64]) {
        if let Some(struck) = &self.struck {
            add(x, force, &struck.push);
        }
    }

    /// F of the last step, N.
    pub fn contact_force(&self) -> f64 {
        self.struck.as_ref().map_or(0.0, |struck| struck.force)
    }
}

impl Schemes {
    /// The whole step in tangent form, all but the force that will be read at its end.
    pub fn foretell(&mut self, from: Moment, load_end: &[f64], to: &mut Course, decide: Decide) {
        let half = 0.5 * self.time_step;
        let (damping, operator) = (&self.matrices.damping, &self.operator);
        if damping.half_bandwidth() == 1 && operator.half_bandwidth() == 1 {
            set_out_tridiagonal(self.time_step, &from, load_end, (damping, operator), &mut to.acceleration);
        } else {
            set_out(self.time_step, &from, load_end, &mut to.acceleration, &mut self.scratch, &mut self.product);
            if self.damped {
                damping.mul_add(-1.0, &self.scratch, &mut to.acceleration);
            }
            operator.mul_add(-1.0, &self.product, &mut to.acceleration);
        }
        self.factor.solve_in_place(&mut to.acceleration);
        if let Some(struck) = &mut self.struck {
            let s = struck.place;
            let velocity = from.velocity[s] + half * (from.acceleration[s] + to.acceleration[s]);
            struck.force = decide(velocity, half * struck.response[s]);
            add(&mut to.acceleration, struck.force, &struck.response);
        }
        travel(self.time_step, &from, &to.acceleration, &mut to.velocity, &mut to.displacement);
    }

    /// d̃₁ of explicit Newmark and α-OS, and ṽ₁ into `to.velocity`.
    pub fn impose(&mut self, from: Moment, to: &mut Course) {
        let (time_step, Coefficients { beta, gamma, .. }) = (self.time_step, self.coefficients);
        let before = from.displacement.iter().zip(from.velocity).zip(from.acceleration);
        let after = to.displacement.iter_mut().zip(&mut to.velocity);
        for ((place, speed), ((displacement, velocity), acceleration)) in after.zip(before) {
            *place = displacement + time_step * (velocity + time_step * ((0.5 - beta) * acceleration));
            *speed = velocity + time_step * ((1.0 - gamma) * acceleration);
        }
        // The contact's share of the acceleration goes by the trapezoidal rule.
        if let Some(struck) = self.struck.as_ref().filter(|struck| struck.force > 0.0) {
            let places = time_step * time_step * (beta - self.contact_beta());
            add(&mut to.displacement, places * struck.force, &struck.push);
            add(&mut to.velocity, time_step * (gamma - 0.5) * struck.force, &struck.push);
        }
    }

    /// The end of the step that imposed `to.displacement`, where `read` (N) is the force.
    pub fn correct(&mut self, from: Moment, load_end: &[f64], read: &[f64], to: &mut Course, decide: Decide) {
        let contact_beta = self.contact_beta();
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
        if let Some(struck) = &mut self.struck {
            let s = struck.place;
            let free = to.velocity[s] + gamma * time_step * to.acceleration[s];
            struck.force = decide(free, time_step * (0.5 * struck.push[s] - gamma * struck.response[s]));
            add(&mut to.acceleration, -struck.force, &struck.response);
            add(&mut to.velocity, 0.5 * time_step * struck.force, &struck.push);
        }
        add(&mut to.velocity, gamma * time_step, &to.acceleration);
        if beta > 0.0 {
            for (correction, acceleration) in self.scratch.iter_mut().zip(&to.acceleration) {
                *correction = beta * time_step * time_step * acceleration;
            }
            if let Some(struck) = &self.struck {
                add(&mut self.scratch, contact_beta * time_step * time_step * struck.force, &struck.push);
            }
            add(&mut to.displacement, 1.0, &self.scratch);
            self.operator.mul_add(1.0, &self.scratch, &mut to.force);
        }
        if let Some(struck) = &self.struck {
            add(&mut to.acceleration, struck.force, &struck.push);
        }
    }

    /// `K_t`, N/m.
    pub const fn operator(&self) -> &SymmetricBand {
        &self.operator
    }

    /// M̂ of a whole step.
    pub const fn effective(&self) -> &SymmetricBand {
        &self.effective
    }

    /// Whether C is other than zero.
    pub const fn is_damped(&self) -> bool {
        self.damped
    }

    /// The frame, whether it is damped, and two vectors of its order for whoever balances energies between steps.
    pub fn scratch(&mut self) -> ((&FrameMatrices, bool), &mut [f64], &mut [f64]) {
        ((&self.matrices, self.damped), &mut self.scratch, &mut self.product)
    }
}

/// x ← x + factor · y.
fn add(x: &mut [f64], factor: f64, y: &[f64]) {
    for (x, y) in x.iter_mut().zip(y) {
        *x += factor * y;
    }
}
