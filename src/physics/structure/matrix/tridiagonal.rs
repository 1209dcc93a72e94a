//! Loops over the floors of a frame. In: vectors, matrices. Out: vectors and sums. They know no striker and have no state.
//!
//! Vectors come as arguments, the written ones separate. The compiler therefore knows that they do not overlap; cut to one length, they
//! need no check in the loop. A step of few floors is delayed most by the values that it has just written. A tridiagonal frame is
//! therefore evaluated in one loop, with its neighbours still in registers.

use super::{SetOut, SymmetricBand};

/// F₁ − R − C(Ẋ + ½ΔtẌ) − `K_t`(ΔtẊ + ¼Δt²Ẍ), both matrices tridiagonal.
#[inline(never)]
pub(crate) fn set_out_tridiagonal(
    step: &SetOut<Vec<f64>>,
    damping: &SymmetricBand,
    push: &mut [f64],
) {
    let SetOut {
        time_step,
        velocity,
        acceleration,
        force,
        load_end,
        stiffness,
        ..
    } = *step;
    let (half, quarter) = (0.5 * time_step, 0.5 * (0.5 * time_step));
    let Some((top, lower)) = push.split_last_mut() else {
        return;
    };
    let last = lower.len();
    let travel = |velocity: f64, acceleration: f64| {
        (
            velocity + half * acceleration,
            time_step * (velocity + quarter * acceleration),
        )
    };
    let (c, c_beside, k, k_beside) = (
        damping.band(0),
        damping.band(1),
        stiffness.band(0),
        stiffness.band(1),
    );
    // For damper and spring each: the travel of the floor below and of this one, and the entry that couples them.
    let (mut below, mut coupling) = ((0.0, 0.0), (0.0, 0.0));
    let mut here = travel(velocity[0], acceleration[0]);
    let forces = load_end[..last].iter().zip(&force[..last]);
    let motions = velocity[1..=last].iter().zip(&acceleration[1..=last]);
    let rows = c[..last]
        .iter()
        .zip(&c_beside[..last])
        .zip(k[..last].iter().zip(&k_beside[..last]));
    for ((push, (load, force)), ((velocity, acceleration), ((c, c_above), (k, k_above)))) in
        lower.iter_mut().zip(forces).zip(motions.zip(rows))
    {
        let above = travel(*velocity, *acceleration);
        let braking = coupling.0 * below.0 + c * here.0 + c_above * above.0;
        let pull = coupling.1 * below.1 + k * here.1 + k_above * above.1;
        *push = load - force - braking - pull;
        (below, here, coupling) = (here, above, (*c_above, *k_above));
    }
    let (braking, pull) = (
        coupling.0 * below.0 + c[last] * here.0,
        coupling.1 * below.1 + k[last] * here.1,
    );
    *top = load_end[last] - force[last] - braking - pull;
}

/// Each entry becomes the value of `entry` for it and for the same entries of the others.
#[inline(never)]
pub(crate) fn update<const N: usize>(
    to: &mut [f64],
    others: [&[f64]; N],
    entry: impl Fn(f64, [f64; N]) -> f64,
) {
    let others = others.map(|other| &other[..to.len()]);
    for (index, to) in to.iter_mut().enumerate() {
        *to = entry(*to, others.map(|other| other[index]));
    }
}

/// Eqs. (2c) and (2d): Ẋ₁ = Ẋ + ½Δt(Ẍ + Ẍ₁), X₁ = X + ½Δt(Ẋ + Ẋ₁); from (X, Ẋ, Ẍ).
#[inline(never)]
pub(crate) fn travel(
    time_step: f64,
    from: [&[f64]; 3],
    acceleration: &[f64],
    velocity: &mut [f64],
    displacement: &mut [f64],
) {
    let (half, order) = (0.5 * time_step, acceleration.len());
    let before = from[0][..order]
        .iter()
        .zip(&from[1][..order])
        .zip(&from[2][..order]);
    let after = displacement[..order]
        .iter_mut()
        .zip(&mut velocity[..order])
        .zip(acceleration);
    for (((position, speed), end), ((displacement, velocity), start)) in after.zip(before) {
        *speed = velocity + half * (start + end);
        *position = displacement + half * (velocity + *speed);
    }
}

/// Number of parallel partial sums: in a single sum each addition waits for the one before.
const LANES: usize = 8;

/// xᵀ y.
pub(crate) fn dot(x: &[f64], y: &[f64]) -> f64 {
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
pub(crate) fn weighted(x: &[f64], weights: &[f64]) -> f64 {
    let (x, weights) = (
        x.as_chunks::<LANES>(),
        weights[..x.len()].as_chunks::<LANES>(),
    );
    let rest: f64 =
        x.1.iter()
            .zip(weights.1)
            .map(|(x, weight)| weight * x * x)
            .sum();
    let mut sums = [0.0; LANES];
    for (x, weights) in x.0.iter().zip(weights.0) {
        for ((sum, x), weight) in sums.iter_mut().zip(x).zip(weights) {
            *sum += weight * x * x;
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// (x₀ + x₁)ᵀ (y₁ ± y₀), with the sign from `join`.
pub(crate) fn trapezoid(x: [&[f64]; 2], y: [&[f64]; 2], join: impl Fn(f64, f64) -> f64) -> f64 {
    let order = x[0].len();
    let (x0, x1) = (
        x[0].as_chunks::<LANES>(),
        x[1][..order].as_chunks::<LANES>(),
    );
    let (y0, y1) = (
        y[0][..order].as_chunks::<LANES>(),
        y[1][..order].as_chunks::<LANES>(),
    );
    let rest = x0.1.iter().zip(x1.1).zip(y0.1.iter().zip(y1.1));
    let rest: f64 = rest
        .map(|((x0, x1), (y0, y1))| (x0 + x1) * join(*y1, *y0))
        .sum();
    let mut sums = [0.0; LANES];
    for ((x0, x1), (y0, y1)) in x0.0.iter().zip(x1.0).zip(y0.0.iter().zip(y1.0)) {
        for (sum, (x, y)) in sums
            .iter_mut()
            .zip(x0.iter().zip(x1).zip(y0.iter().zip(y1)))
        {
            *sum += (x.0 + x.1) * join(*y.1, *y.0);
        }
    }
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::matrix::{Vector as _, set_out_by_products};

    /// Both loops give bit-identical numbers, from two floors to more than one vector register contains.
    #[test]
    fn one_loop_gives_what_the_products_give() {
        for order in 2..20_u32 {
            let numbers = |seed: f64| {
                (0..order)
                    .map(|i| (seed + 1.7 * f64::from(i)).sin())
                    .collect::<Vec<f64>>()
            };
            let matrix = |seed: f64| {
                let mut matrix = SymmetricBand::zero(numbers(0.0).len(), 1);
                matrix.band_mut(0).copy_from_slice(&numbers(seed));
                matrix
                    .band_mut(1)
                    .copy_from_slice(&numbers(seed + 0.5)[1..]);
                matrix
            };
            let (damping, stiffness, load_end) = (matrix(0.1), matrix(0.2), numbers(0.3));
            let [velocity, acceleration, force] = [0.5, 0.6, 0.7].map(numbers);
            let step = SetOut {
                time_step: 0.02,
                velocity: &velocity,
                acceleration: &acceleration,
                force: &force,
                load_end: &load_end,
                damping: Some(&damping),
                stiffness: &stiffness,
            };
            let [mut push, mut glide, mut drift, mut once] = [0.0; 4].map(numbers);
            set_out_by_products(&step, &mut push, &mut glide, &mut drift);
            Vec::set_out(&step, &mut once, &mut glide, &mut drift);
            assert_eq!(once, push, "{order} floors");
        }
    }
}
