//! Integrators that impose a predicted place and solve after the force was read there: explicit Newmark and α-operator
//! splitting, with the paper's contact. In: the state at a step's start; the place to impose comes out; the force read
//! there goes in; the end of the step comes out. It commands no rig.
//!
//! ## The contact step
//! The paper's eq. (4) is eq. (5) with the contact force F₁ = (Ms/Δt)(Ẋs − Ẋs₁) on its right and Ẋs₁ = Ẋ₁. Said for any
//! integrator whose end velocity is linear in F₁, Ẋ₁ = `v_free` + w·F₁ with `v_free` that of the step without contact, it
//! is
//!
//! ```text
//! F₁ = (Ẋs − v_free) / (Δt/Ms + w)
//! ```
//!
//! In the tangent form w = ½Δt/M̂, and the line above is eq. (4) again. Here the acceleration is kept in two parts,
//! a = s + c with c = F/M of the contact alone. The contact part is an impulse and is always integrated by the trapezoidal
//! rule, as in the paper; only s, what the structure itself does, is weighed with α, β, γ:
//!
//! ```text
//! d̃₁ = d + Δt·v + Δt²((½−β)s + (½−β_c)c)      ṽ₁ = v + Δt((1−γ)s + ½c)       (impose d̃₁, read r̃₁)
//! M̂ s₁ = −(1+α)(r̃₁ + Cṽ₁) + α(r₀ + Cv₀) − (1+α)(β_cΔt²K_I + ½ΔtC)·c₁,     M̂ = M + (1+α)(γΔtC + βΔt²K_I)
//! d₁ = d̃₁ + Δt²(β s₁ + β_c c₁),   v₁ = ṽ₁ + γΔt·s₁ + ½Δt·c₁,   r₁ = r̃₁ + K_I(d₁ − d̃₁)
//! w = ½Δt/M − γΔt·G/M,   G = (1+α)(β_cΔt²K_I + ½ΔtC)/M̂
//! ```
//!
//! with β_c = ¼ under α-OS and 0 under explicit Newmark. Without contact this is each of them as published (r₀ and v₀ with
//! their corrections are what the published start values r̃₀ = r₀ − βΔt²K_I a₀ and ṽ₀ = v₀ − γΔt·a₀ make of them). With
//! α = 0 and `K_I` = `K_t` it is the tangent form. And whatever α is, the rigid contact tends to the paper's collision with
//! e = Ms/(Ms + 2M) as Δt → 0. Weighing F with α too would make it a collision with
//! e = Ms(1 − (1+α)γ)/(M + (1+α)γMs), 0.767 and not 0.833 for α = −0.05 in the paper's first example: numerical damping
//! strikes what is fastest, and nothing is faster than a blow.
//!
//! A tensile F₁ is then dropped, one beyond the limit force is cut to it: c₁ = 0, or `F_lim`/M, in the same lines.
//!
//! ## Energy
//! M·½(v₀+v₁)·Δt·½(c₀+c₁) = ½(F₀+F₁)·½Δt(v₀+v₁) is what the contact gives to the structure, exactly, so that the contact
//! loss counts the way ½Δt(v₀+v₁) and not d₁ − d₀, which under explicit Newmark differ by ¼Δt²(a₀ − a₁).

use super::contact::StepState;
use super::law::{Advance, Bodies, Start, begun};
use super::method::Coefficients;
use crate::plan::Integrator;

/// Explicit Newmark or α-OS, with a contact that is rigid up to a limit force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Split {
    coefficients: Coefficients,
    /// β of the contact's part.
    contact_beta: f64,
    /// `K_I`, N/m; 0 under explicit Newmark.
    operator_stiffness: f64,
    /// N; infinite under the rigid law.
    force_limit: f64,
}

impl Split {
    /// `operator_stiffness` is `K_I` of α-OS (N/m), `force_limit` that of the contact (N), infinite if none.
    #[must_use]
    pub fn new(integrator: Integrator, operator_stiffness: f64, force_limit: f64) -> Self {
        let explicit = integrator == Integrator::Explicit;
        Self {
            coefficients: Coefficients::of(integrator),
            contact_beta: if explicit { 0.0 } else { 0.25 },
            operator_stiffness: if explicit { 0.0 } else { operator_stiffness },
            force_limit,
        }
    }

    /// d̃₁, m: where the specimen is to be bent to.
    #[inline]
    #[must_use]
    pub fn predict(&self, bodies: &Bodies, start: &Start) -> f64 {
        let time_step = bodies.time_step;
        let (smooth, contact) = parts(bodies, start);
        let from = start.structure;
        let pushed = (0.5 - self.coefficients.beta) * smooth + (0.5 - self.contact_beta) * contact;
        from.displacement + time_step * (from.velocity + time_step * pushed)
    }

    /// Velocity foretold for the end of the step, m/s: what the structure does by itself it keeps doing; a blow is over, and the
    /// half of its impulse that this step still has is all that comes of it; a limit force lasts.
    #[must_use]
    pub fn foretold_velocity(&self, bodies: &Bodies, start: &Start) -> f64 {
        let (smooth, contact) = parts(bodies, start);
        let to_come = if start.contact_force >= self.force_limit { 1.0 } else { 0.5 };
        start.structure.velocity + bodies.time_step * (smooth + to_come * contact)
    }

    /// The end of the step, with the force `read` (N) at d̃₁ = `imposed` (m).
    #[inline]
    #[must_use]
    pub fn complete(&self, bodies: &Bodies, start: &Start, imposed: f64, read: f64) -> Advance {
        let Bodies { mass, damping, striker_mass, gravity, time_step } = *bodies;
        let falling = start.striker_velocity + gravity * time_step;
        let Coefficients { alpha, beta, gamma } = self.coefficients;
        let from = start.structure;
        let (smooth, contact) = parts(bodies, start);
        let now = 1.0 + alpha;
        let predicted = from.velocity + time_step * ((1.0 - gamma) * smooth + 0.5 * contact);
        let inertia = mass + now * time_step * (gamma * damping + beta * time_step * self.operator_stiffness);
        let load = alpha * (from.restoring_force + damping * from.velocity) - now * (read + damping * predicted);
        let unpushed = load / inertia;
        // What the structure's own resistance takes back of the contact's acceleration, by part.
        let resisted = now * time_step * (0.5 * damping + self.contact_beta * time_step * self.operator_stiffness) / inertia;
        let velocity_by_force = (0.5 - gamma * resisted) * time_step / mass;

        let mut state = StepState::Free;
        let mut force = 0.0;
        // No tolerance: δp was stored as this very difference.
        if start.striker_displacement - from.displacement >= start.indentation {
            let closing = falling - (predicted + gamma * time_step * unpushed);
            let needed = closing / (time_step / striker_mass + velocity_by_force);
            if needed > self.force_limit {
                (state, force) = (StepState::Limit, self.force_limit);
            } else if needed >= 0.0 {
                (state, force) = (StepState::Contact, needed);
            }
        }
        let contact = force / mass;
        let smooth = unpushed - resisted * contact;
        let velocity = predicted + time_step * (gamma * smooth + 0.5 * contact);
        let corrected = time_step * time_step * (beta * smooth + self.contact_beta * contact);
        let displacement = imposed + corrected;
        let striker_velocity = match state {
            StepState::Free => falling,
            StepState::Contact => velocity,
            StepState::Limit => falling - force * time_step / striker_mass,
        };
        let striker_moved = 0.5 * time_step * (start.striker_velocity + striker_velocity);
        let striker_displacement = start.striker_displacement + striker_moved;
        let mut indentation = start.indentation;
        if state == StepState::Limit {
            indentation = indentation.max(striker_displacement - displacement);
        }
        let way = 0.5 * time_step * (from.velocity + velocity);
        Advance {
            structure: super::integrator::Motion {
                displacement,
                velocity,
                acceleration: smooth + contact,
                restoring_force: read + self.operator_stiffness * corrected,
            },
            striker_displacement,
            striker_velocity,
            state,
            contact_force: force,
            indentation,
            contact_loss: force * striker_moved - 0.5 * (start.contact_force + force) * way,
            damping_work: 0.5 * damping * (from.velocity + velocity) * way,
            indentation_work: if state == StepState::Limit { force * (indentation - start.indentation) } else { 0.0 },
            contacts: begun(start.touching, state),
        }
    }
}

/// s and c at the start of a step, m/s².
#[inline]
fn parts(bodies: &Bodies, start: &Start) -> (f64, f64) {
    let contact = start.contact_force / bodies.mass;
    (start.structure.acceleration - contact, contact)
}
