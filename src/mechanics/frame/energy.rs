//! The energy balance of a frame, step by step. In: the ends of a step. Out: energies in the relative form.

use super::FrameMatrices;

/// Energies at the end of a step, all in J, cumulated from the start; of displacements and velocities against the ground
/// (the relative form, Uang and Bertero 1990: what an absolute one adds is the ground's own work). They add up:
/// `kinetic + restoring + damping + error = input`.
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
    /// What remains of the input: the integration error, and under α-OS with α < 0 what it damps numerically. With the
    /// tangent form it is rounding as long as the specimen is linear.
    pub error: f64,
}

/// Vectors at one end of a step.
#[derive(Clone, Copy)]
pub(super) struct End<'a> {
    pub displacement: &'a [f64],
    pub velocity: &'a [f64],
    /// At the computed displacement.
    pub restoring_force: &'a [f64],
    pub load: &'a [f64],
}

impl FrameEnergies {
    /// The balance one step on. `scratch` is two vectors of the frame's order.
    pub(super) fn advance(
        &self,
        matrices: &FrameMatrices,
        time_step: f64,
        from: End,
        to: End,
        scratch: (&mut [f64], &mut [f64]),
    ) -> Self {
        let (mean_velocity, product) = scratch;
        for ((mean, before), after) in mean_velocity.iter_mut().zip(from.velocity).zip(to.velocity) {
            *mean = 0.5 * (before + after);
        }
        let moved = from.displacement.iter().zip(to.displacement).map(|(before, after)| after - before);
        let force = from.restoring_force.iter().zip(to.restoring_force).map(|(before, after)| 0.5 * (before + after));
        let load = from.load.iter().zip(to.load).map(|(before, after)| 0.5 * (before + after));
        let restoring: f64 = force.zip(moved).map(|(force, moved)| force * moved).sum();
        let input: f64 = load.zip(&*mean_velocity).map(|(load, velocity)| load * velocity).sum();
        matrices.damping.mul_into(mean_velocity, product);
        let damping = dot(product, mean_velocity);
        matrices.mass.mul_into(to.velocity, product);
        let mut next = Self {
            kinetic: 0.5 * dot(product, to.velocity),
            restoring: self.restoring + restoring,
            damping: self.damping + time_step * damping,
            input: self.input + time_step * input,
            error: 0.0,
        };
        next.error = next.input - (next.kinetic + next.restoring + next.damping);
        next
    }
}

pub(super) fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}
