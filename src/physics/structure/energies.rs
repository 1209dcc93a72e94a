//! The energy balance of a structure, step by step. In: the ends of a step. Out: energies in the relative form.

use std::ops::{Add as _, Sub as _};

use super::matrices::Matrices;
use super::matrix::{Matrix as _, Vector};

/// Energies at the end of a step, all in J, cumulated from the start; of displacements and velocities against the ground
/// (the relative form, Uang and Bertero, Earthquake Engng Struct. Dyn. 19 (1990) 77–90; the absolute form adds the work of the ground).
/// They add up: `kinetic + restoring + damping + error = input + gravity`.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct FrameEnergies {
    /// ½ ẊᵀMẊ
    pub kinetic: f64,
    /// ∫ Rᵀ dX over the computed X, trapezoid.
    pub restoring: f64,
    /// ∫ ẊᵀCẊ dt
    pub damping: f64,
    /// ∫ FᵀẊ dt; under a ground motion −∫ ẊᵀMι `ü_g` dt.
    pub input: f64,
    /// ½ XᵀGX, minus that of the start: work of the weights, which sink as the storeys drift.
    pub gravity: f64,
    /// The rest of the input: the integration error, and under α-OS with α < 0 the numerical damping. With the
    /// tangent form it is rounding as long as the specimen is linear.
    pub error: f64,
}

/// Both ends of a step: vectors before and after.
#[derive(Clone, Copy)]
pub(crate) struct Ends<'a, V> {
    pub displacement: [&'a V; 2],
    pub velocity: [&'a V; 2],
    /// At the computed displacement.
    pub restoring_force: [&'a V; 2],
    pub load: [&'a V; 2],
}

impl FrameEnergies {
    /// The balance one step on. `damping_work` \[J\] is given if the velocity has jumped inside the step, otherwise that of the mean
    /// velocity is used. `scratch` is two vectors of the structure's order.
    #[inline]
    pub(crate) fn advance<V: Vector>(
        &self,
        matrices: &Matrices<V>,
        time_step: f64,
        ends: &Ends<V>,
        damping_work: Option<f64>,
        [first, second]: [&mut V; 2],
    ) -> Self {
        let restoring = V::trapezoid(ends.restoring_force, ends.displacement, f64::sub);
        let input = V::trapezoid(ends.load, ends.velocity, f64::add);
        let damping_work = damping_work.unwrap_or_else(|| {
            let of_twice_the_mean = matrices
                .damping
                .quadratic_of_sum(ends.velocity, [first, second]);
            time_step * (0.25 * of_twice_the_mean)
        });
        let mut next = Self {
            kinetic: 0.5 * matrices.mass.quadratic(ends.velocity[1], second),
            restoring: self.restoring + 0.5 * restoring,
            damping: self.damping + damping_work,
            input: self.input + time_step * (0.25 * input),
            gravity: self.gravity,
            error: 0.0,
        };
        if let Some(gravity) = &matrices.gravity {
            first.update(ends.displacement, |_, [before, after]| before + after);
            gravity.product(first, second);
            first.update(ends.displacement, |_, [before, after]| after - before);
            next.gravity += 0.5 * first.dot(second);
        }
        next.error = next.input + next.gravity - (next.kinetic + next.restoring + next.damping);
        next
    }
}
