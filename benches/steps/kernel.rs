//! The least that a step of an impact or of one degree of freedom can be: the same formulas with every number in a register, one division a
//! step, and no other law, integrator, noise or end condition. The bench compares psd with it in one run.

#![allow(clippy::inline_always, reason = "a row is a part of its loop")]

use psd_physics::impact::{ImpactInput, StepRow};
use psd_physics::specimen::RestoringForce;

/// Takes the rows of a run.
pub trait Record {
    fn put(&mut self, row: StepRow);
}

impl Record for () {
    #[inline(always)]
    fn put(&mut self, _: StepRow) {}
}

impl Record for Vec<StepRow> {
    #[inline(always)]
    fn put(&mut self, row: StepRow) {
        self.push(row);
    }
}

/// The end of an impact: X, Ẋ, ∫R dX, and what is missing of the energy.
pub type End = [f64; 4];

/// An impact under the rigid law, with its energies.
#[inline(never)]
pub fn impact<S: RestoringForce, R: Record>(
    input: &ImpactInput,
    specimen: &mut S,
    steps: u32,
    record: &mut R,
) -> End {
    let (mass, damping, striker_mass, time_step) = (
        input.mass,
        input.damping,
        input.striker_mass,
        input.time_step,
    );
    let largest = input.max_tangent_ratio * input.stiffness;
    let half = 0.5 * time_step;
    let quarter = half * half;
    let damped_mass = mass + half * damping;
    let (mut x, mut v, mut r) = (0.0_f64, 0.0_f64, specimen.move_to(0.0));
    let mut a = (0.0 - r) / mass;
    let (mut rise, mut run) = (input.stiffness, 1.0_f64);
    let (mut xs, mut vs) = (0.0 - input.gap, input.striker_velocity);
    let fall = input.gravity * time_step;
    let (per_step, half_mass) = (striker_mass / time_step, 0.5 * striker_mass);
    let mut force = 0.0;
    let (mut restoring, mut damped, mut loss, mut weight, mut missing) = (0.0, 0.0, 0.0, 0.0, 0.0);
    let brought = input.striker_energy();
    for step in 0..steps {
        let glide = v + half * a;
        let drift = time_step * (v + 0.5 * half * a);
        let mut push = 0.0 - r;
        if damping != 0.0 {
            push -= damping * glide;
        }
        let mut top = push * run - rise * drift;
        let mut bottom = damped_mass * run + quarter * rise;
        let falling = vs + fall;
        let mut touches = false;
        if xs >= x {
            touches = (falling - glide) * bottom >= half * top;
            if touches {
                top += (per_step * (falling - v) - half_mass * a) * run;
                bottom += half_mass * run;
            }
        }
        let a1 = top / bottom;
        let moved = half * (v + v + half * a) + quarter * a1;
        let x1 = x + moved;
        let v1 = glide + half * a1;
        let r1 = specimen.move_to(x1);
        let change = x1 - x;
        if change.abs() > 0.0 {
            let (change, risen) = if change < 0.0 {
                (-change, r - r1)
            } else {
                (change, r1 - r)
            };
            (rise, run) = (risen.max(0.0).min(largest * change), change);
        }
        let (vs1, force1) = if touches {
            (v1, per_step * (falling - v1))
        } else {
            (falling, 0.0)
        };
        let striker_moved = half * (vs + vs1);
        loss += force1 * striker_moved - 0.5 * (force + force1) * moved;
        restoring += 0.5 * ((r + r1) * change);
        if damping != 0.0 {
            let mean = 0.5 * (v + v1);
            damped += time_step * (mean * (damping * mean));
        }
        weight += striker_mass * input.gravity * striker_moved;
        missing = brought + weight
            - (0.5 * striker_mass * vs1 * vs1
                + 0.5 * (v1 * (mass * v1))
                + restoring
                + damped
                + loss);
        (x, v, a, r, force) = (x1, v1, a1, r1, force1);
        (xs, vs) = (xs + striker_moved, vs1);
        record.put(StepRow {
            time: f64::from(step + 1) * time_step,
            displacement: x,
            velocity: v,
            restoring_force: r,
            contact_force: force,
            striker_displacement: xs,
            striker_velocity: vs,
            tangent_stiffness: rise / run,
        });
    }
    [x, v, restoring, missing]
}

/// Newmark's constant average acceleration of a mass on a spring, with its energies; the rows are X, Ẋ and Ẍ.
#[inline(never)]
pub fn linear(
    [mass, damping, stiffness]: [f64; 3],
    velocity: f64,
    time_step: f64,
    steps: u32,
    rows: &mut Vec<[f64; 3]>,
) -> f64 {
    let half = 0.5 * time_step;
    let response = 1.0 / (mass + half * (damping + half * stiffness));
    let (mut x, mut v, mut a, mut r) = (0.0, velocity, 0.0, 0.0);
    let (mut restoring, mut damped, mut error) = (0.0, 0.0, 0.0);
    for _ in 0..steps {
        let drift = time_step * (v + 0.5 * half * a);
        let push = 0.0 - r - damping * (v + half * a) - stiffness * drift;
        let a1 = push * response;
        let v1 = v + half * (a + a1);
        let x1 = x + half * (v + v1);
        let r1 = stiffness * x1;
        restoring += 0.5 * ((r + r1) * (x1 - x));
        let mean = 0.5 * (v + v1);
        damped += time_step * (mean * (damping * mean));
        error = 0.5 * (mass * v1 * v1) + restoring + damped;
        (x, v, a, r) = (x1, v1, a1, r1);
        rows.push([x, v, a]);
    }
    x + error * 1e-300
}
