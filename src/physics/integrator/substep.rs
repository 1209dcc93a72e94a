//! Structure and striker between two instants of one step, for a contact law with its own instants. In: a structure, the state at the
//! step's start. Out: the motion after any part of the step. It knows no contact law.

use super::step_form::{Moment, Motion, StepForm};
use crate::structure::matrix::{Factor, Matrix, Vector};

/// The striker, and the degree of freedom that it hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Striker {
    /// The struck degree of freedom, from 0.
    pub struck: usize,
    /// Ms \[kg\]
    pub mass: f64,
    /// g of Ms Ẍs = Ms g − F, \[m/s²\]; 0 for a striker that does not fall.
    pub gravity: f64,
    /// Δt \[s\]
    pub time_step: f64,
}

/// Memory of a divided step, reused in every step.
#[derive(Clone, Debug)]
pub(crate) struct Workspace<V: Vector> {
    pub now: Motion<V>,
    pub mean: V,
    pub response: V,
    glide: V,
    drift: V,
    effective: V::Matrix,
    factor: <V::Matrix as Matrix>::Factor,
}

impl<V: Vector> Workspace<V> {
    pub fn new(form: &StepForm<V>) -> Self {
        let order = form.matrices.mass.rows();
        let zero = || V::zero(order);
        Self {
            now: Motion::at_rest(order),
            mean: zero(),
            response: zero(),
            glide: zero(),
            drift: zero(),
            effective: form.operator().clone(),
            factor: form.factor().clone(),
        }
    }
}

/// A structure between two instants of a step.
pub(crate) struct Substep<'a, V: Vector> {
    pub form: &'a StepForm<V>,
    /// The struck degree of freedom, and M⁻¹ e_s \[1/kg\].
    pub struck: usize,
    pub push: &'a V,
    load: [&'a V; 2],
    glide: &'a mut V,
    drift: &'a mut V,
    effective: &'a mut V::Matrix,
    factor: &'a mut <V::Matrix as Matrix>::Factor,
}

impl<'a, V: Vector> Substep<'a, V> {
    /// From a step's start; loads vary linearly from their values there to those at the end. Motion, mean velocity and response of the
    /// workspace are for the contact law. None if no degree of freedom can be struck.
    #[inline]
    pub fn new(
        form: &'a StepForm<V>,
        from: &Moment<'a, V>,
        load_end: &'a V,
        workspace: &'a mut Workspace<V>,
    ) -> Option<(Self, Scratch<'a, V>)> {
        let (struck, push) = form.struck()?;
        let Workspace {
            now,
            mean,
            response,
            glide,
            drift,
            effective,
            factor,
        } = workspace;
        now.set(from);
        let substep = Self {
            form,
            struck,
            push,
            load: [from.load, load_end],
            glide,
            drift,
            effective,
            factor,
        };
        Some((
            substep,
            Scratch {
                now,
                mean,
                response,
            },
        ))
    }

    /// Displacement and velocity of the struck degree of freedom.
    #[inline]
    pub fn of_struck(&self, motion: &Motion<V>) -> (f64, f64) {
        (
            motion.displacement.as_slice()[self.struck],
            motion.velocity.as_slice()[self.struck],
        )
    }

    /// Effective mass of the struck degree of freedom \[kg\]: the mass that an impulse meets.
    #[inline]
    pub fn struck_mass(&self) -> f64 {
        1.0 / self.push.as_slice()[self.struck]
    }

    /// Forms M̂ = M + ½hC + ¼h²K_t, with `joined` kg added to the struck degree of freedom: the matrix for [`Self::solve`].
    #[inline]
    pub fn prepare(&mut self, duration: f64, joined: f64) {
        let half = 0.5 * duration;
        self.effective.become_copy(self.form.operator());
        self.effective.multiply(half);
        if let Some(damping) = self.form.damping() {
            self.effective.add_scaled(damping, 1.0);
        }
        self.effective.multiply(half);
        self.effective.add_scaled(&self.form.matrices.mass, 1.0);
        self.effective.add_at(self.struck, joined);
        // M̂ is positive definite because M is; if rounding ever prevents it, the last factor remains in use.
        let _ = self.factor.replace(self.effective);
    }

    /// x ← M̂⁻¹ x.
    #[inline]
    pub fn solve(&self, x: &mut V) {
        self.factor.solve(x);
    }

    /// f − R at a part of the step, 0 to 1 \[N\].
    #[inline]
    fn pushing(&self, part: f64, force: &V, to: &mut V) {
        to.update(
            [self.load[0], self.load[1], force],
            |_, [first, last, force]| first + part * (last - first) - force,
        );
    }

    /// Eq. (5) from `from` over `duration`, to an end that is `part` of the step away from its start. The prepared matrix is that of
    /// `joined` kg and `weight` N that move with the struck degree of freedom.
    #[inline]
    pub fn follow(
        &mut self,
        from: &Motion<V>,
        [duration, part]: [f64; 2],
        joined: Option<[f64; 2]>,
        to: &mut Motion<V>,
    ) {
        // Until `travel`, Ẍ + Ẍ₁.
        let sum = &mut to.acceleration;
        self.pushing(part, &from.force, sum);
        if let Some(damping) = self.form.damping() {
            damping.mul_add(-1.0, &from.velocity, sum);
        }
        self.form.operator().mul_add(-duration, &from.velocity, sum);
        self.form
            .matrices
            .mass
            .mul_add(1.0, &from.acceleration, sum);
        let [mass, weight] = joined.unwrap_or([0.0; 2]);
        sum.as_mut_slice()[self.struck] +=
            weight + mass * from.acceleration.as_slice()[self.struck];
        // The factor of a whole step exists already.
        if joined.is_none() && duration == self.form.time_step {
            self.form.factor().solve(&mut to.acceleration);
        } else {
            self.prepare(duration, mass);
            self.solve(&mut to.acceleration);
        }
        let start = [&from.displacement, &from.velocity, &from.acceleration];
        V::travel(
            duration,
            start,
            &mut to.acceleration,
            &mut to.velocity,
            &mut to.displacement,
        );
        self.drift
            .update([&to.displacement, &from.displacement], |_, [to, from]| {
                to - from
            });
        to.force.set(from.force.view());
        self.form.operator().mul_add(1.0, self.drift, &mut to.force);
    }

    /// M v + ½h(f − R) in the middle of a part of duration h, `part` of the step away from its start: M̂ times the velocity there
    /// before the contact acts.
    #[inline]
    pub fn momentum(&self, motion: &Motion<V>, half: f64, part: f64, to: &mut V) {
        self.form.matrices.mass.product(&motion.velocity, to);
        to.update(
            [self.load[0], self.load[1], &motion.force],
            |momentum, [first, last, force]| {
                momentum + half * (first + part * (last - first) - force)
            },
        );
    }

    /// M Ẍ = f − R − CẊ + F e_s at the end of the step: the acceleration of an instant.
    #[inline]
    pub fn settle(&self, force: f64, at: &mut Motion<V>) {
        let Motion {
            velocity,
            acceleration,
            force: restoring,
            ..
        } = at;
        self.pushing(1.0, restoring, acceleration);
        acceleration.as_mut_slice()[self.struck] += force;
        if let Some(damping) = self.form.damping() {
            damping.mul_add(-1.0, velocity, acceleration);
        }
        self.form.mass_factor().solve(acceleration);
    }

    /// ∫ ẊᵀCẊ dt over `duration` with the mean velocity v \[J\].
    #[inline]
    pub fn damped(&mut self, mean_velocity: &V, duration: f64) -> f64 {
        self.form.damping().map_or(0.0, |damping| {
            damping.product(mean_velocity, self.glide);
            duration * mean_velocity.dot(self.glide)
        })
    }

    /// The same for a constant acceleration between two instants.
    #[inline]
    pub fn damped_between(&mut self, from: &Motion<V>, to: &Motion<V>, duration: f64) -> f64 {
        self.form.damping().map_or(0.0, |damping| {
            self.drift
                .update([&from.velocity, &to.velocity], |_, [from, to]| {
                    0.5 * (from + to)
                });
            damping.product(self.drift, self.glide);
            duration * self.drift.dot(self.glide)
        })
    }

    /// Continues over a part of this `duration` with the mean velocity v: X + hv, 2v − Ẋ, R + `K_t` hv.
    #[inline]
    pub fn drift(&mut self, motion: &mut Motion<V>, mean_velocity: &V, duration: f64) {
        self.drift
            .update([mean_velocity], |_, [mean]| duration * mean);
        motion
            .displacement
            .update([self.drift], |displacement, [moved]| displacement + moved);
        motion
            .velocity
            .update([mean_velocity], |velocity, [mean]| 2.0 * mean - velocity);
        self.form
            .operator()
            .mul_add(1.0, self.drift, &mut motion.force);
    }

    /// Momentum p \[N·s\] passes to the structure, with the contribution of the dampers to M Ẍ.
    #[inline]
    pub fn strike(&mut self, impulse: f64, motion: &mut Motion<V>) {
        motion
            .velocity
            .update([self.push], |velocity, [push]| velocity + impulse * push);
        if let Some(damping) = self.form.damping() {
            self.drift.update([self.push], |_, [push]| impulse * push);
            self.glide.update([], |_, []| 0.0);
            damping.mul_add(-1.0, self.drift, self.glide);
            self.form.mass_factor().solve(self.glide);
            motion
                .acceleration
                .update([self.glide], |acceleration, [braked]| acceleration + braked);
        }
    }

    /// A contact force \[N\] begins or ends: M Ẍ changes by it on the struck degree of freedom.
    #[inline]
    pub fn press(&self, force: f64, motion: &mut Motion<V>) {
        motion
            .acceleration
            .update([self.push], |acceleration, [push]| {
                acceleration + force * push
            });
    }
}

/// Memory for a contact law; the motion is that at the step's start.
pub(crate) struct Scratch<'a, V> {
    pub now: &'a mut Motion<V>,
    pub mean: &'a mut V,
    pub response: &'a mut V,
}
