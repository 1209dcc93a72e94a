//! The energy balance of a frame, step by step. In: the ends of a step. Out: energies in the relative form.

use std::ops::{Add as _, Sub as _};

use super::FrameMatrices;

/// Energies at the end of a step, all in J, cumulated from the start; of displacements and velocities against the ground
/// (the relative form, Uang and Bertero, Earthquake Engng Struct. Dyn. 19 (1990) 77–90: what an absolute one adds is the ground's own work). They add up:
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
        let braked = damped && damping_work.is_none();
        if braked {
            mean(from.velocity, to.velocity, first);
        }
        let restoring = trapezoid([from.restoring_force, to.restoring_force], [from.displacement, to.displacement], f64::sub);
        let input = trapezoid([from.load, to.load], [from.velocity, to.velocity], f64::add);
        let damping = if braked {
            matrices.damping.mul_into(first, second);
            dot(first, second)
        } else {
            0.0
        };
        let kinetic = if matrices.mass.half_bandwidth() == 0 {
            weighed(to.velocity, matrices.mass.band(0))
        } else {
            matrices.mass.mul_into(to.velocity, second);
            dot(second, to.velocity)
        };
        let mut next = Self {
            kinetic: 0.5 * kinetic,
            restoring: self.restoring + 0.5 * restoring,
            damping: self.damping + damping_work.unwrap_or(time_step * damping),
            input: self.input + time_step * (0.25 * input),
            error: 0.0,
        };
        next.error = next.input - (next.kinetic + next.restoring + next.damping);
        next
    }
}

/// ½(x + y)
#[inline(never)]
fn mean(x: &[f64], y: &[f64], mean: &mut [f64]) {
    let order = mean.len();
    for ((mean, x), y) in mean.iter_mut().zip(&x[..order]).zip(&y[..order]) {
        *mean = 0.5 * (x + y);
    }
}

/// Numbers side by side: one sum waits for each addition before the next.
const LANES: usize = 8;

/// xᵀ y.
fn dot(x: &[f64], y: &[f64]) -> f64 {
    let (x, y) = (x.as_chunks::<LANES>(), y[..x.len()].as_chunks::<LANES>());
    let rest: f64 = x.1.iter().zip(y.1).map(|(x, y)| x * y).sum();
    let mut sums = [0.0; LANES];
    for (x, y) in x.0.iter().zip(y.0) {
        for ((sum, x), y) in sums.iter_mut().zip(x).zip(y) {
            *sum += x * y;
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// xᵀ D x, D diagonal.
fn weighed(x: &[f64], weights: &[f64]) -> f64 {
    let (x, weights) = (x.as_chunks::<LANES>(), weights[..x.len()].as_chunks::<LANES>());
    let rest: f64 = x.1.iter().zip(weights.1).map(|(x, weight)| weight * x * x).sum();
    let mut sums = [0.0; LANES];
    for (x, weights) in x.0.iter().zip(weights.0) {
        for ((sum, x), weight) in sums.iter_mut().zip(x).zip(weights) {
            *sum += weight * x * x;
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// (x₀ + x₁)ᵀ (y₁ ± y₀), as `join` says.
fn trapezoid(x: [&[f64]; 2], y: [&[f64]; 2], join: impl Fn(f64, f64) -> f64) -> f64 {
    let order = x[0].len();
    let (x0, x1) = (x[0].as_chunks::<LANES>(), x[1][..order].as_chunks::<LANES>());
    let (y0, y1) = (y[0][..order].as_chunks::<LANES>(), y[1][..order].as_chunks::<LANES>());
    let rest = x0.1.iter().zip(x1.1).zip(y0.1.iter().zip(y1.1));
    let rest: f64 = rest.map(|((x0, x1), (y0, y1))| (x0 + x1) * join(*y1, *y0)).sum();
    let mut sums = [0.0; LANES];
    for ((x0, x1), (y0, y1)) in x0.0.iter().zip(x1.0).zip(y0.0.iter().zip(y1.0)) {
        for (sum, (x, y)) in sums.iter_mut().zip(x0.iter().zip(x1).zip(y0.iter().zip(y1))) {
            *sum += (x.0 + x.1) * join(*y.1, *y.0);
        }
    }
    sums.iter().sum::<f64>() + rest
}
