//! Sweeps over the floors of a frame, in tangent form. In: the state at a step's start, matrices. Out: vectors of its end.
//! They know no striker and keep nothing.
//!
//! Vectors come as arguments, the written ones apart: so they are known not to overlap, and cut to one length they need no
//! check in the loop. A step of few floors waits longest for what it has just written; a tridiagonal frame is therefore set
//! out in one sweep, whose neighbours are still at hand.

use super::band::SymmetricBand;
use super::schemes::Moment;

/// F₁ − R, Ẋ + ½ΔtẌ and Δt(Ẋ + ¼ΔtẌ).
#[inline(never)]
pub(super) fn set_out(time_step: f64, from: &Moment, load_end: &[f64], push: &mut [f64], glide: &mut [f64], drift: &mut [f64]) {
    let (half, order) = (0.5 * time_step, push.len());
    let forces = load_end[..order].iter().zip(&from.force[..order]);
    let ways = from.velocity[..order].iter().zip(&from.acceleration[..order]);
    let found = push.iter_mut().zip(&mut glide[..order]).zip(&mut drift[..order]);
    for (((push, glide), drift), ((load, force), (velocity, acceleration))) in found.zip(forces.zip(ways)) {
        *push = load - force;
        *glide = velocity + half * acceleration;
        *drift = time_step * (velocity + 0.5 * half * acceleration);
    }
}

/// F₁ − R − C(Ẋ + ½ΔtẌ) − `K_t`(ΔtẊ + ¼Δt²Ẍ), both matrices tridiagonal.
#[inline(never)]
pub(super) fn set_out_tridiagonal(
    time_step: f64,
    from: &Moment,
    load_end: &[f64],
    (damping, stiffness): (&SymmetricBand, &SymmetricBand),
    push: &mut [f64],
) {
    let (half, quarter) = (0.5 * time_step, 0.5 * (0.5 * time_step));
    let Some((top, lower)) = push.split_last_mut() else { return };
    let last = lower.len();
    let way =
        |velocity: f64, acceleration: f64| (velocity + half * acceleration, time_step * (velocity + quarter * acceleration));
    let (c, c_beside, k, k_beside) = (damping.band(0), damping.band(1), stiffness.band(0), stiffness.band(1));
    // Of damper and spring each: the way of the floor below and of this one, and the entry that couples them.
    let (mut below, mut coupling) = ((0.0, 0.0), (0.0, 0.0));
    let mut here = way(from.velocity[0], from.acceleration[0]);
    let forces = load_end[..last].iter().zip(&from.force[..last]);
    let ways = from.velocity[1..=last].iter().zip(&from.acceleration[1..=last]);
    let rows = c[..last].iter().zip(&c_beside[..last]).zip(k[..last].iter().zip(&k_beside[..last]));
    for ((push, (load, force)), ((velocity, acceleration), ((c, c_above), (k, k_above)))) in
        lower.iter_mut().zip(forces).zip(ways.zip(rows))
    {
        let above = way(*velocity, *acceleration);
        let braking = coupling.0 * below.0 + c * here.0 + c_above * above.0;
        let pull = coupling.1 * below.1 + k * here.1 + k_above * above.1;
        *push = load - force - braking - pull;
        (below, here, coupling) = (here, above, (*c_above, *k_above));
    }
    let (braking, pull) = (coupling.0 * below.0 + c[last] * here.0, coupling.1 * below.1 + k[last] * here.1);
    *top = load_end[last] - from.force[last] - braking - pull;
}

/// Eqs. (2c) and (2d): Ẋ₁ = Ẋ + ½Δt(Ẍ + Ẍ₁), X₁ = X + ½Δt(Ẋ + Ẋ₁).
#[inline(never)]
pub(super) fn travel(time_step: f64, from: &Moment, acceleration: &[f64], velocity: &mut [f64], displacement: &mut [f64]) {
    let (half, order) = (0.5 * time_step, acceleration.len());
    let before = from.displacement[..order].iter().zip(&from.velocity[..order]).zip(&from.acceleration[..order]);
    let after = displacement[..order].iter_mut().zip(&mut velocity[..order]).zip(acceleration);
    for (((place, speed), end), ((displacement, velocity), start)) in after.zip(before) {
        *speed = velocity + half * (start + end);
        *place = displacement + half * (velocity + *speed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both ways to set out give the same numbers to the last bit, from two floors to more than one vector register holds.
    #[test]
    fn one_sweep_says_what_three_say() {
        for order in 2..20_u32 {
            let numbers = |seed: f64| (0..order).map(|i| (seed + 1.7 * f64::from(i)).sin()).collect::<Vec<f64>>();
            let matrix = |seed: f64| {
                let mut matrix = SymmetricBand::zero(numbers(0.0).len(), 1);
                matrix.band_mut(0).copy_from_slice(&numbers(seed));
                matrix.band_mut(1).copy_from_slice(&numbers(seed + 0.5)[1..]);
                matrix
            };
            let (damping, stiffness, load) = (matrix(0.1), matrix(0.2), numbers(0.3));
            let [displacement, velocity, acceleration, force] = [0.4, 0.5, 0.6, 0.7].map(numbers);
            let from = Moment {
                displacement: &displacement,
                velocity: &velocity,
                acceleration: &acceleration,
                force: &force,
                load: &load,
            };
            let [mut push, mut glide, mut drift, mut once] = [0.0; 4].map(numbers);
            set_out(0.02, &from, &load, &mut push, &mut glide, &mut drift);
            damping.mul_add(-1.0, &glide, &mut push);
            stiffness.mul_add(-1.0, &drift, &mut push);
            set_out_tridiagonal(0.02, &from, &load, (&damping, &stiffness), &mut once);
            assert_eq!(once, push, "{order} floors");
        }
    }
}
