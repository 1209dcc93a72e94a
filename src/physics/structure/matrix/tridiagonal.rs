//! Loops over the floors of a frame. In: vectors, matrices. Out: vectors and sums. They know no striker and have no state.
//!
//! Vectors come as arguments, the written ones separate. The compiler therefore knows that they do not overlap; cut to one length, they
//! need no check in the loop. A step of few floors is delayed most by the values that it has just written: the loop over a tridiagonal frame
//! reads what the last step wrote.

use super::SetOut;

/// F₁ − R − (C + Δt`K_t`)Ẋ + MẌ, the sum tridiagonal and M diagonal.
pub(crate) fn set_out_tridiagonal(step: &SetOut<Vec<f64>>, push: &mut [f64]) {
    set_out(
        push,
        [step.load_end, step.force, step.mass.band(0)],
        [step.velocity, step.acceleration],
        [step.drag.band(0), step.drag.band(1)],
    );
}

#[inline(never)]
fn set_out(
    push: &mut [f64],
    [load, force, mass]: [&[f64]; 3],
    [velocity, acceleration]: [&[f64]; 2],
    [drag, beside]: [&[f64]; 2],
) {
    let last = push.len() - 1;
    let at = |floor: usize, braking: f64| {
        load[floor] - force[floor] - braking + mass[floor] * acceleration[floor]
    };
    push[0] = at(0, drag[0] * velocity[0] + beside[0] * velocity[1]);
    let braking = beside[last - 1] * velocity[last - 1] + drag[last] * velocity[last];
    push[last] = at(last, braking);
    let inner = &mut push[1..last];
    let count = inner.len();
    let [load, force, mass, acceleration, drag] =
        [load, force, mass, acceleration, drag].map(|all| &all[1..=count]);
    let [below, here, above] = [0, 1, 2].map(|first| &velocity[first..first + count]);
    let [to_below, to_above] = [0, 1].map(|first| &beside[first..first + count]);
    for (floor, push) in inner.iter_mut().enumerate() {
        let braking = to_below[floor] * below[floor]
            + drag[floor] * here[floor]
            + to_above[floor] * above[floor];
        *push = load[floor] - force[floor] - braking + mass[floor] * acceleration[floor];
    }
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

/// Eqs. (2c) and (2d): Ẋ₁ = Ẋ + ½Δt(Ẍ + Ẍ₁), X₁ = X + ½Δt(Ẋ + Ẋ₁); from (X, Ẋ, Ẍ). `acceleration` is Ẍ + Ẍ₁ and becomes Ẍ₁.
#[inline(never)]
pub(crate) fn travel(
    time_step: f64,
    from: [&[f64]; 3],
    acceleration: &mut [f64],
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
        *speed = velocity + half * *end;
        *position = displacement + half * (velocity + *speed);
        *end -= start;
    }
}

/// Number of parallel partial sums: in a single sum each addition waits for the one before.
const LANES: usize = 4;

/// The sum of a term of each floor, which has one number of each of these.
#[inline]
fn sum<const N: usize>(floors: [&[f64]; N], term: impl Fn([f64; N]) -> f64) -> f64 {
    let count = floors[0].len();
    let turns = count / LANES;
    let floors = floors.map(|all| &all[..count]);
    let lanes = floors.map(|all| &all.as_chunks::<LANES>().0[..turns]);
    let mut sums = [0.0; LANES];
    for turn in 0..turns {
        for (lane, sum) in sums.iter_mut().enumerate() {
            *sum += term(lanes.map(|all| all[turn][lane]));
        }
    }
    let rest: f64 = (LANES * turns..count)
        .map(|floor| term(floors.map(|all| all[floor])))
        .sum();
    (sums[0] + sums[2]) + (sums[1] + sums[3]) + rest
}

/// xᵀ y.
pub(crate) fn dot(x: &[f64], y: &[f64]) -> f64 {
    sum([x, y], |[x, y]| x * y)
}

/// xᵀ D x, D diagonal.
pub(crate) fn weighted(x: &[f64], weights: &[f64]) -> f64 {
    sum([x, weights], |[x, weight]| weight * x * x)
}

/// (x₀ + x₁)ᵀ (y₁ ± y₀), with the sign from `join`.
pub(crate) fn trapezoid(
    [x0, x1]: [&[f64]; 2],
    [y0, y1]: [&[f64]; 2],
    join: impl Fn(f64, f64) -> f64,
) -> f64 {
    sum([x0, x1, y0, y1], |[x0, x1, y0, y1]| {
        (x0 + x1) * join(y1, y0)
    })
}

/// xᵀ A x of a sum x = x₀ + x₁ and a tridiagonal A: its diagonal, and the entries beside it, which are in both triangles.
#[inline(never)]
pub(crate) fn quadratic_of_sum([diagonal, beside]: [&[f64]; 2], [x0, x1]: [&[f64]; 2]) -> f64 {
    let last = beside.len();
    let below = [&x0[..last], x1, &x0[1..], &x1[1..], diagonal, beside];
    let below = sum(below, |[x0, x1, above0, above1, diagonal, beside]| {
        let (x, coupled) = (x0 + x1, beside * (above0 + above1));
        x * (diagonal * x + (coupled + coupled))
    });
    let top = x0[last] + x1[last];
    below + diagonal[last] * top * top
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::matrix::{Matrix as _, SymmetricBand, Vector as _, set_out_by_products};

    fn numbers(order: u32, seed: f64) -> Vec<f64> {
        (0..order)
            .map(|i| (seed + 1.7 * f64::from(i)).sin())
            .collect()
    }

    fn matrix(order: u32, seed: f64) -> SymmetricBand {
        let diagonal = numbers(order, seed);
        let mut matrix = SymmetricBand::zero(diagonal.len(), 1);
        matrix.band_mut(0).copy_from_slice(&diagonal);
        matrix
            .band_mut(1)
            .copy_from_slice(&numbers(order, seed + 0.5)[1..]);
        matrix
    }

    /// Both give bit-identical numbers, from two floors to more than one vector register contains.
    #[test]
    fn one_loop_gives_what_the_products_give() {
        for order in 2..20 {
            let (mass, drag) = (
                SymmetricBand::diagonal(&numbers(order, 0.1)),
                matrix(order, 0.2),
            );
            let [velocity, acceleration, force, load_end] =
                [0.3, 0.5, 0.6, 0.7].map(|seed| numbers(order, seed));
            let step = SetOut {
                velocity: &velocity,
                acceleration: &acceleration,
                force: &force,
                load_end: &load_end,
                mass: &mass,
                drag: &drag,
            };
            let [mut push, mut once] = [0.0; 2].map(|seed| numbers(order, seed));
            set_out_by_products(&step, &mut push);
            Vec::set_out(&step, &mut once);
            assert_eq!(once, push, "{order} floors");
        }
    }

    #[test]
    fn the_form_of_a_sum_is_that_of_the_products() {
        for order in 2..20 {
            let matrix = matrix(order, 0.2);
            let [x0, x1] = [0.3, 0.4].map(|seed| numbers(order, seed));
            let [mut sum, mut product] = [0.0; 2].map(|seed| numbers(order, seed));
            let once = matrix.quadratic_of_sum([&x0, &x1], [&mut sum, &mut product]);
            sum.update([&x0, &x1], |_, [before, after]| before + after);
            let products = matrix.quadratic(&sum, &mut product);
            assert!((once - products).abs() < 1e-14, "{order} floors");
        }
    }
}
