//! One step of a structure under each integrator (coefficients in [`super::coefficients`]), for one degree of freedom and for many. In:
//! the state at a step's start, loads, the measured force. Out: the position to impose, the end of the step. It keeps no history.
//!
//! Weights on the floors add −G X to the restoring force, and −G to every stiffness below: R is R − G X, `K_t` is `K_t` − G, `K_I` is
//! `K_I` − G. A tangent or secant is measured without G, and has its bounds before G is subtracted.
//!
//! A contact force F acts on one degree of freedom s. Every end velocity there is linear in it, Ẋ₁ = `v_free` + w F, with
//! `v_free` that of the step without contact, and a contact law decides on F from those two. In the tangent form
//!
//! ```text
//! (M + ½ΔtC + ¼Δt²K_t) Ẍ₁ = f₁ − R − C(Ẋ + ½ΔtẌ) − K_t(ΔtẊ + ¼Δt²Ẍ) + F e_s,    w = ½Δt · e_sᵀ M̂⁻¹ e_s
//! ```
//!
//! With M̂Ẍ added on both sides, it has one product with a velocity, and two accelerations as its unknown:
//!
//! ```text
//! M̂ (Ẍ + Ẍ₁) = f₁ − R − (C + ΔtK_t)Ẋ + MẌ + F e_s
//! ```
//!
//! Explicit Newmark and α-operator splitting keep the contact's acceleration c = M⁻¹ e_s F apart from the structure's own,
//! s = Ẍ − c. The contact part is an impulse and is always integrated by the trapezoidal rule, as in the paper; only s is
//! weighted with α, β, γ:
//!
//! ```text
//! d̃₁ = d + Δt·v + Δt²((½−β)s + (½−β_c)c)      ṽ₁ = v + Δt((1−γ)s + ½c)       (impose d̃₁, read r̃₁)
//! M̂ s₁ = (1+α)(f₁ − r̃₁ − Cṽ₁) − α(f₀ − r₀ − Cv₀) − (1+α)(β_cΔt²K_I + ½ΔtC)·c₁,   M̂ = M + (1+α)(γΔtC + βΔt²K_I)
//! d₁ = d̃₁ + Δt²(β s₁ + β_c c₁),   v₁ = ṽ₁ + γΔt·s₁ + ½Δt·c₁,   r₁ = r̃₁ + K_I(d₁ − d̃₁)
//! w = Δt·e_sᵀ(½M⁻¹ − γM̂⁻¹(1+α)(β_cΔt²K_I + ½ΔtC)M⁻¹)e_s
//! ```
//!
//! with β_c = ¼ under α-OS and 0 under explicit Newmark. Without contact each scheme is the published one: r₀ and v₀ with their
//! corrections equal those by the published start values r̃₀ = r₀ − βΔt²K_I a₀ and ṽ₀ = v₀ − γΔt·a₀. With α = 0 and `K_I` = `K_t` it is
//! the tangent form. Whatever α is, the rigid contact tends to the paper's collision with e = Ms/(Ms + 2M) as Δt → 0. If F were also
//! weighted with α, the collision would have e = Ms(1 − (1+α)γ)/(M + (1+α)γMs), 0.767 and not 0.833 for α = −0.05 in the paper's first
//! example: numerical damping acts most on the fastest motion, which is the impact.

use super::coefficients::Coefficients;
use crate::integrator::Integrator;
use crate::structure::matrix::one_degree::Unforced;
use crate::structure::matrix::{Factor, Matrix, SetOut, Vector};
use crate::structure::{Matrices, NotPositiveDefinite};

/// A structure and how it is integrated.
#[derive(Clone, Debug)]
pub(crate) struct StepForm<V: Vector> {
    pub matrices: Matrices<V>,
    pub integrator: Integrator,
    pub time_step: f64,
    coefficients: Coefficients,
    shares: Shares,
    /// `K_t` − G of the tangent form, `K_I` − G of α-OS; not used by explicit Newmark.
    operator: V::Matrix,
    /// C + ΔtK of the tangent form \[N·s/m\]; not used by the others.
    drag: V::Matrix,
    effective: V::Matrix,
    factor: Factored<V>,
    mass_factor: Factored<V>,
    /// Whether there is any damping.
    damped: bool,
    struck: Option<Struck<V>>,
    /// A contact law divides steps.
    pub is_divided: bool,
    scratch: V,
    product: V,
}

/// What decides on the contact force of a step, from its end without contact.
pub(crate) trait StepContact {
    /// F \[N\] from `v_free` \[m/s\] and w \[m/s/N\].
    fn force(&mut self, free: f64, compliance: f64) -> f64;

    /// Ẍ₁ of one degree of freedom with its contact, as a ratio; `half` is ½Δt \[s\].
    fn joined(&mut self, half: f64, unforced: &Unforced) -> [f64; 2];

    /// F \[N\] of that step, which ends with Ẋ₁ \[m/s\].
    fn settled(&mut self, velocity: f64) -> f64;
}

/// No contact.
impl StepContact for () {
    #[inline]
    fn force(&mut self, _: f64, _: f64) -> f64 {
        0.0
    }

    #[inline]
    fn joined(&mut self, _: f64, unforced: &Unforced) -> [f64; 2] {
        [unforced.top, unforced.bottom]
    }

    #[inline]
    fn settled(&mut self, _: f64) -> f64 {
        0.0
    }
}

type Factored<V> = <<V as Vector>::Matrix as Matrix>::Factor;

/// The motion at one instant, and the force and load there.
#[derive(Clone, Copy)]
pub(crate) struct Moment<'a, V> {
    pub displacement: &'a V,
    pub velocity: &'a V,
    pub acceleration: &'a V,
    /// R − G X at the computed displacement.
    pub force: &'a V,
    pub load: &'a V,
}

/// A degree of freedom that a striker can hit.
#[derive(Clone, Debug)]
struct Struck<V> {
    index: usize,
    /// M⁻¹ e_s \[1/kg\]
    push: V,
    /// M̂⁻¹ e_s in tangent form \[1/kg\]; for the others M̂⁻¹ (1+α)(β_cΔt²K_I + ½ΔtC) M⁻¹ e_s, the reaction of the structure.
    response: V,
    /// F of the step in progress or, before it is decided, of the last one \[N\].
    force: f64,
}

/// The end of a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Motion<V> {
    pub displacement: V,
    pub velocity: V,
    pub acceleration: V,
    /// At the computed displacement.
    pub force: V,
}

impl<V: Vector> Motion<V> {
    pub fn at_rest(order: usize) -> Self {
        let zero = || V::zero(order);
        Self {
            displacement: zero(),
            velocity: zero(),
            acceleration: zero(),
            force: zero(),
        }
    }

    /// Becomes the motion at this moment.
    #[inline]
    pub fn set(&mut self, moment: &Moment<V>) {
        self.displacement.set(moment.displacement.view());
        self.velocity.set(moment.velocity.view());
        self.acceleration.set(moment.acceleration.view());
        self.force.set(moment.force.view());
    }
}

impl<V: Vector> StepForm<V> {
    pub fn new(
        matrices: &Matrices<V>,
        operator: &V::Matrix,
        integrator: Integrator,
        time_step: f64,
    ) -> Result<Self, NotPositiveDefinite> {
        let order = matrices.mass.rows();
        let net = matrices.net(operator);
        if let Some(gravity) = &matrices.gravity
            && integrator == Integrator::Tangent
        {
            // K_t ≥ 0, so that M̂ stays positive definite if M − ¼Δt²G is.
            let mut least = matrices.mass.clone();
            least.add_scaled(gravity, -0.25 * time_step * time_step);
            <V::Matrix as Matrix>::Factor::of(&least)?;
        }
        let mut effective = V::Matrix::zero_of(order);
        let coefficients = Coefficients::of(integrator);
        let shares = Shares::new(&coefficients, time_step);
        shares.compose(matrices, &net, &mut effective);
        let mut drag = V::Matrix::zero_of(order);
        compose_drag(&net, &matrices.damping, time_step, &mut drag);
        Ok(Self {
            integrator,
            time_step,
            coefficients,
            shares,
            operator: net,
            factor: Factor::of(&effective)?,
            mass_factor: Factor::of(&matrices.mass)?,
            drag,
            effective,
            damped: !matrices.damping.vanishes(),
            struck: None,
            is_divided: false,
            scratch: V::zero(order),
            product: V::zero(order),
            matrices: matrices.clone(),
        })
    }

    /// Sets a different `K_t`, written by `stiffness`. M̂ stays positive definite: no storey of `K_t` is negative.
    #[inline]
    pub fn set_tangent(
        &mut self,
        stiffness: impl FnOnce(&mut V::Matrix),
    ) -> Result<(), NotPositiveDefinite> {
        stiffness(&mut self.operator);
        if let Some(gravity) = &self.matrices.gravity {
            self.operator.add_scaled(gravity, -1.0);
        }
        self.shares
            .compose(&self.matrices, &self.operator, &mut self.effective);
        compose_drag(
            &self.operator,
            &self.matrices.damping,
            self.time_step,
            &mut self.drag,
        );
        self.factor.replace(&self.effective)?;
        self.respond();
        Ok(())
    }

    /// A striker can hit this degree of freedom.
    pub fn strike(&mut self, index: usize) {
        let mut push = V::zero(self.matrices.mass.rows());
        push.as_mut_slice()[index] = 1.0;
        self.mass_factor.solve(&mut push);
        self.struck = Some(Struck {
            index,
            response: push.clone(),
            push,
            force: 0.0,
        });
        self.respond();
    }

    /// β of the contact's part: the trapezoidal rule, except for explicit Newmark, which has none.
    fn contact_beta(&self) -> f64 {
        if self.integrator == Integrator::Explicit {
            0.0
        } else {
            0.25
        }
    }

    /// The solution for a unit force at the struck degree of freedom.
    #[inline]
    fn respond(&mut self) {
        let (time_step, beta) = (self.time_step, self.contact_beta());
        let Some(struck) = &mut self.struck else {
            return;
        };
        let response = &mut struck.response;
        response.update([], |_, []| 0.0);
        if self.integrator == Integrator::Tangent {
            response.as_mut_slice()[struck.index] = 1.0;
        } else {
            let now = 1.0 + self.coefficients.alpha;
            if beta > 0.0 {
                self.operator
                    .mul_add(now * beta * time_step * time_step, &struck.push, response);
            }
            self.matrices
                .damping
                .mul_add(now * 0.5 * time_step, &struck.push, response);
        }
        self.factor.solve(response);
    }

    /// x ← x + `force` M⁻¹e_s, `force` on the struck degree of freedom.
    pub fn push(&self, force: f64, x: &mut V) {
        if let Some(struck) = &self.struck {
            add(x, force, &struck.push);
        }
    }

    /// F of the last step \[N\].
    #[inline]
    pub fn contact_force(&self) -> f64 {
        self.struck.as_ref().map_or(0.0, |struck| struck.force)
    }
}

/// C + ΔtK into `drag`. K comes first: its band is hardly ever narrower than that of C, and `drag` then keeps its memory.
#[inline]
fn compose_drag<M: Matrix>(operator: &M, damping: &M, time_step: f64, drag: &mut M) {
    drag.become_copy(operator);
    drag.multiply(time_step);
    drag.add_scaled(damping, 1.0);
}

/// The factors of K and of C in M̂ = M + (1+α)Δt(γC + βΔtK), computed once.
#[derive(Clone, Copy, Debug)]
struct Shares {
    /// βΔt/γ \[s\], of K in its sum with C; none without β.
    stiffness: Option<f64>,
    /// (1+α)γΔt \[s\]
    damping: f64,
}

impl Shares {
    fn new(coefficients: &Coefficients, time_step: f64) -> Self {
        let Coefficients { alpha, beta, gamma } = *coefficients;
        Self {
            stiffness: (beta != 0.0).then(|| beta / gamma * time_step),
            damping: (1.0 + alpha) * gamma * time_step,
        }
    }

    /// M̂ into `effective`.
    #[inline]
    fn compose<V: Vector>(
        self,
        matrices: &Matrices<V>,
        operator: &V::Matrix,
        effective: &mut V::Matrix,
    ) {
        if let Some(stiffness) = self.stiffness {
            effective.become_copy(operator);
            effective.multiply(stiffness);
            effective.add_scaled(&matrices.damping, 1.0);
        } else {
            effective.become_copy(&matrices.damping);
        }
        effective.multiply(self.damping);
        effective.add_scaled(&matrices.mass, 1.0);
    }
}

impl<V: Vector> StepForm<V> {
    /// The whole step in tangent form, except the force at its end, which is read later.
    #[inline]
    pub fn predict(
        &mut self,
        from: &Moment<V>,
        load_end: &V,
        to: &mut Motion<V>,
        mut contact: impl StepContact,
    ) {
        self.sum_without_contact(from, load_end, &mut to.acceleration);
        if let Some(struck) = &mut self.struck {
            let (half, s) = (0.5 * self.time_step, struck.index);
            let free = from.velocity.as_slice()[s] + half * to.acceleration.as_slice()[s];
            struck.force = contact.force(free, half * struck.response.as_slice()[s]);
            add(&mut to.acceleration, struck.force, &struck.response);
        }
        let start = [from.displacement, from.velocity, from.acceleration];
        V::travel(
            self.time_step,
            start,
            &mut to.acceleration,
            &mut to.velocity,
            &mut to.displacement,
        );
    }

    /// Ẍ + Ẍ₁ of the whole step in tangent form with F = 0.
    #[inline]
    fn sum_without_contact(&self, from: &Moment<V>, load_end: &V, sum: &mut V) {
        let step = SetOut {
            velocity: from.velocity,
            acceleration: from.acceleration,
            force: from.force,
            load_end,
            mass: &self.matrices.mass,
            drag: &self.drag,
        };
        V::set_out(&step, sum);
        self.factor.solve(sum);
    }

    /// d̃₁ of explicit Newmark and α-OS, and ṽ₁ into `to.velocity`.
    #[inline]
    pub fn impose(&self, from: &Moment<V>, to: &mut Motion<V>) {
        let (time_step, Coefficients { beta, gamma, .. }) = (self.time_step, self.coefficients);
        to.displacement.update(
            [from.displacement, from.velocity, from.acceleration],
            |_, [displacement, velocity, acceleration]| {
                displacement + time_step * (velocity + time_step * ((0.5 - beta) * acceleration))
            },
        );
        to.velocity.update(
            [from.velocity, from.acceleration],
            |_, [velocity, acceleration]| velocity + time_step * ((1.0 - gamma) * acceleration),
        );
        // The contact's share of the acceleration follows the trapezoidal rule.
        if let Some(struck) = self.struck.as_ref().filter(|struck| struck.force > 0.0) {
            let displacements = time_step * time_step * (beta - self.contact_beta());
            add(
                &mut to.displacement,
                displacements * struck.force,
                &struck.push,
            );
            add(
                &mut to.velocity,
                time_step * (gamma - 0.5) * struck.force,
                &struck.push,
            );
        }
    }

    /// The end of the step that imposed `to.displacement`, with the measured force `read` \[N\].
    #[inline]
    pub fn correct(
        &mut self,
        from: &Moment<V>,
        load_end: &V,
        read: &V,
        to: &mut Motion<V>,
        mut contact: impl StepContact,
    ) {
        let contact_beta = self.contact_beta();
        let (time_step, Coefficients { alpha, beta, gamma }) = (self.time_step, self.coefficients);
        let now = 1.0 + alpha;
        to.acceleration.update(
            [load_end, read, from.load, from.force],
            |_, [load, force, load_before, force_before]| {
                now * (load - force) - alpha * (load_before - force_before)
            },
        );
        if self.damped {
            self.scratch
                .update([&to.velocity, from.velocity], |_, [after, before]| {
                    now * after - alpha * before
                });
            self.matrices
                .damping
                .mul_add(-1.0, &self.scratch, &mut to.acceleration);
        }
        self.factor.solve(&mut to.acceleration);
        to.force.set(read.view());
        if let Some(struck) = &mut self.struck {
            let s = struck.index;
            let free =
                to.velocity.as_slice()[s] + gamma * time_step * to.acceleration.as_slice()[s];
            let compliance = time_step
                * (0.5 * struck.push.as_slice()[s] - gamma * struck.response.as_slice()[s]);
            struck.force = contact.force(free, compliance);
            add(&mut to.acceleration, -struck.force, &struck.response);
            add(
                &mut to.velocity,
                0.5 * time_step * struck.force,
                &struck.push,
            );
        }
        add(&mut to.velocity, gamma * time_step, &to.acceleration);
        if beta > 0.0 {
            self.scratch
                .update([&to.acceleration], |_, [acceleration]| {
                    beta * time_step * time_step * acceleration
                });
            if let Some(struck) = &self.struck {
                add(
                    &mut self.scratch,
                    contact_beta * time_step * time_step * struck.force,
                    &struck.push,
                );
            }
            add(&mut to.displacement, 1.0, &self.scratch);
            self.operator.mul_add(1.0, &self.scratch, &mut to.force);
        }
        if let Some(struck) = &self.struck {
            add(&mut to.acceleration, struck.force, &struck.push);
        }
    }

    /// Sets F of the step in progress \[N\].
    #[inline]
    pub fn set_contact_force(&mut self, force: f64) {
        if let Some(struck) = &mut self.struck {
            struck.force = force;
        }
    }

    /// `K_t` − G \[N/m\].
    pub const fn operator(&self) -> &V::Matrix {
        &self.operator
    }

    /// M̂ of a whole step, as a factor.
    pub const fn factor(&self) -> &Factored<V> {
        &self.factor
    }

    /// M as a factor.
    pub const fn mass_factor(&self) -> &Factored<V> {
        &self.mass_factor
    }

    /// M⁻¹ e_s of the struck degree of freedom \[1/kg\].
    pub const fn struck(&self) -> Option<(usize, &V)> {
        match &self.struck {
            Some(struck) => Some((struck.index, &struck.push)),
            None => None,
        }
    }

    /// C, if it is not zero.
    #[inline]
    pub fn damping(&self) -> Option<&V::Matrix> {
        Some(&self.matrices.damping).filter(|_| self.damped)
    }

    /// The matrices, and two vectors of their order for energy balances between steps.
    #[inline]
    pub fn scratch(&mut self) -> (&Matrices<V>, bool, [&mut V; 2]) {
        (
            &self.matrices,
            self.damped,
            [&mut self.scratch, &mut self.product],
        )
    }
}

/// x ← x + factor · y.
#[inline]
fn add<V: Vector>(x: &mut V, factor: f64, y: &V) {
    x.update([y], |x, [y]| x + factor * y);
}
