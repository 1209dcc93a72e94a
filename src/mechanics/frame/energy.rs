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
    /// The balance one step on, of a frame that is damped or not; `damping_work` where the velocity has jumped on the way, J.
    /// `scratch` is two vectors of the frame's order.
    pub(super) fn advance(
        &self,
        (matrices, damped): (&FrameMatrices, bool),
        time_step: f64,
        from: End,
        to: End,
        damping_work: Option<f64>,
        scratch: (&mut [f64], &mut [f64]),
    ) -> Self {
        let (first, second) = scratch;
        let restoring = 0.5 * sums(from.restoring_force, to.restoring_force, from.displacement, to.displacement, -1.0);
        let input = 0.25 * sums(from.load, to.load, from.velocity, to.velocity, 1.0);
        let mut damping = 0.0;
        if damped && damping_work.is_none() {
            for ((mean, before), after) in first.iter_mut().zip(from.velocity).zip(to.velocity) {
                *mean = 0.5 * (before + after);
            }
            matrices.damping.mul_into(first, second);
            damping = dot(first, second);
        }
        matrices.mass.mul_into(to.velocity, second);
        let mut next = Self {
            kinetic: 0.5 * dot(second, to.velocity),
            restoring: self.restoring + restoring,
            damping: self.damping + damping_work.unwrap_or(time_step * damping),
            input: self.input + time_step * input,
            error: 0.0,
        };
        next.error = next.input - (next.kinetic + next.restoring + next.damping);
        next
    }
}

/// Sums side by side: one sum waits for each addition before the next.
const LANES: usize = 8;

/// xᵀ y.
pub(super) fn dot(x: &[f64], y: &[f64]) -> f64 {
    let (x, y) = (x.chunks_exact(LANES), y.chunks_exact(LANES));
    let rest: f64 = x.remainder().iter().zip(y.remainder()).map(|(x, y)| x * y).sum();
    let mut sums = [0.0; LANES];
    for (x, y) in x.zip(y) {
        for ((sum, x), y) in sums.iter_mut().zip(x).zip(y) {
            *sum += x * y;
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// (x₀ + x₁)ᵀ (y₁ + sign · y₀).
fn sums(x0: &[f64], x1: &[f64], y0: &[f64], y1: &[f64], sign: f64) -> f64 {
    let term = |x: (&f64, &f64), y: (&f64, &f64)| (x.0 + x.1) * (y.1 + sign * y.0);
    let (x0, x1, y0, y1) = (x0.chunks_exact(LANES), x1.chunks_exact(LANES), y0.chunks_exact(LANES), y1.chunks_exact(LANES));
    let rest = x0.remainder().iter().zip(x1.remainder()).zip(y0.remainder().iter().zip(y1.remainder()));
    let rest: f64 = rest.map(|(x, y)| term(x, y)).sum();
    let mut sums = [0.0; LANES];
    for ((x0, x1), (y0, y1)) in x0.zip(x1).zip(y0.zip(y1)) {
        for (sum, (x, y)) in sums.iter_mut().zip(x0.iter().zip(x1).zip(y0.iter().zip(y1))) {
            *sum += term(x, y);
        }
    }
    sums.iter().sum::<f64>() + rest
}
