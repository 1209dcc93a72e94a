//! Frames to test on, and runs of them on ideal specimens.

use psd_physics::integrator::input::FrameInput;
use psd_physics::integrator::solver::FrameSolver;
use psd_physics::integrator::state::FrameState;
use psd_physics::integrator::tangents::Tangents;
use psd_physics::structure::{FrameMatrices, SymmetricBand, storey_stiffness};
use psd_plan::Integrator;

/// Storeys of one mass \[kg\] and one stiffness \[N/m\], undamped.
pub fn uniform(storeys: usize, mass: f64, stiffness: f64) -> FrameMatrices {
    FrameMatrices {
        mass: SymmetricBand::diagonal(&vec![mass; storeys]),
        damping: SymmetricBand::zero(storeys, 0),
        stiffness: storey_stiffness(&vec![stiffness; storeys]),
        gravity: None,
    }
}

/// `ω_k` = 2√(k/m) sin((2k − 1)π / (2(2n + 1))), k from 1: a chain of n equal masses fixed at one end.
pub fn uniform_frequency(storeys: usize, mode: usize, mass: f64, stiffness: f64) -> f64 {
    let (n, k) = (number(storeys), number(mode));
    2.0 * (stiffness / mass).sqrt()
        * ((2.0 * k - 1.0) * std::f64::consts::PI / (2.0 * (2.0 * n + 1.0))).sin()
}

/// Its shape, sin((2k − 1) j π / (2n + 1)) at floor j, from 1.
pub fn uniform_shape(storeys: usize, mode: usize) -> Vec<f64> {
    let angle = (2.0 * number(mode) - 1.0) * std::f64::consts::PI / (2.0 * number(storeys) + 1.0);
    (1..=storeys)
        .map(|floor| (angle * number(floor)).sin())
        .collect()
}

pub fn number(count: usize) -> f64 {
    f64::from(u32::try_from(count).expect("small"))
}

/// At rest, unloaded, read without noise.
pub fn at<'a>(
    matrices: &'a FrameMatrices,
    integrator: Integrator,
    time_step: f64,
    zero: &'a [f64],
) -> FrameInput<'a> {
    FrameInput {
        elements: None,
        matrices,
        operator_stiffness: &matrices.stiffness,
        integrator,
        i_modification: false,
        tangents: Tangents::Initial,
        time_step,
        initial_displacement: zero,
        initial_restoring_force: zero,
        initial_load: zero,
        readings: &[],
    }
}

/// `steps` steps on an ideal linear specimen under `load`, from the given displacement at rest; every state is passed on.
pub fn run_linear(
    input: &FrameInput,
    displacement: &[f64],
    steps: u32,
    mut load: impl FnMut(f64, &mut [f64]),
    mut observe: impl FnMut(&FrameState),
) -> FrameState {
    let order = displacement.len();
    let stiffness = &input.matrices.stiffness;
    let (mut force, mut load_end) = (vec![0.0; order], vec![0.0; order]);
    stiffness.mul_into(displacement, &mut force);
    load(0.0, &mut load_end);
    let start = FrameInput {
        initial_displacement: displacement,
        initial_restoring_force: &force,
        initial_load: &load_end,
        ..*input
    };
    let mut solver = FrameSolver::new(&start).expect("a frame");
    for step in 1..=steps {
        load(f64::from(step) * input.time_step, &mut load_end);
        let target = solver.predict(&load_end).to_vec();
        stiffness.mul_into(&target, &mut force);
        observe(solver.complete(&target, &force));
    }
    solver.state().clone()
}
