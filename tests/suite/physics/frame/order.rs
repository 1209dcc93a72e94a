//! The integrators on linear frames: order of convergence, the stability limit, the energy balance, and the effect of a storey's own
//! tangent changes (nothing).

use psd_physics::integrator::input::FrameInput;
use psd_physics::integrator::solver::FrameSolver;
use psd_physics::integrator::state::FrameState;
use psd_physics::integrator::tangents::Tangents;
use psd_physics::structure::{Damping, FrameMatrices, damping_matrix, modes};
use psd_plan::Integrator;

use super::support::{at, run_linear, uniform, uniform_frequency, uniform_shape};

const ALL: [Integrator; 4] = [
    Integrator::Tangent,
    Integrator::Explicit,
    Integrator::AlphaOs { alpha: 0.0 },
    Integrator::AlphaOs { alpha: -0.1 },
];

/// Five storeys with 5 % in every mode.
fn damped() -> FrameMatrices {
    let mut frame = uniform(5, 1500.0, 2e6);
    let found = modes(&frame.mass, &frame.stiffness).expect("modes");
    let damping = Damping::Modal(vec![0.05; 5]);
    frame.damping =
        damping_matrix(&damping, &frame.mass, &frame.stiffness, &found).expect("ratios of modes");
    frame
}

/// Free vibration from a displacement at rest: the exact top displacement at `time`.
fn exact_top(time: f64) -> f64 {
    (1..=5)
        .map(|mode| {
            let (shape, omega) = (
                uniform_shape(5, mode),
                uniform_frequency(5, mode, 1500.0, 2e6),
            );
            let (sum, square) = (
                shape.iter().sum::<f64>(),
                shape.iter().map(|entry| entry * entry).sum::<f64>(),
            );
            let (rate, rung) = (0.05 * omega, omega * (1.0_f64 - 0.05 * 0.05).sqrt());
            let amplitude = 0.01 * sum / square * shape[4];
            amplitude
                * (-rate * time).exp()
                * ((rung * time).cos() + rate / rung * (rung * time).sin())
        })
        .sum()
}

#[test]
fn every_integrator_is_of_second_order() {
    let frame = damped();
    let end = 0.4;
    for integrator in ALL {
        let error = |steps: u32| {
            let input = at(&frame, integrator, end / f64::from(steps), &[0.0; 5]);
            run_linear(&input, &[0.01; 5], steps, |_, load| load.fill(0.0), |_| ()).displacement[4]
                - exact_top(end)
        };
        let order = (error(1600) / error(3200)).log2();
        assert!((order - 2.0).abs() < 0.02, "{integrator:?}: order {order}");
        assert!(error(3200).abs() < 2e-7, "{integrator:?}: {}", error(3200));
    }
}

/// Two storeys excited in their highest mode: the largest displacement of the second thousand steps over that of the first.
fn growth(integrator: Integrator, time_step: f64, operator: f64) -> f64 {
    let frame = uniform(2, 1500.0, 2e6);
    let mut operator_stiffness = frame.stiffness.clone();
    operator_stiffness.scale(operator);
    let shape: Vec<f64> = uniform_shape(2, 2)
        .iter()
        .map(|entry| 1e-6 * entry)
        .collect();
    let zero = [0.0; 2];
    let input = FrameInput {
        operator_stiffness: &operator_stiffness,
        ..at(&frame, integrator, time_step, &zero)
    };
    let mut largest = [0.0_f64; 2];
    let observe = |state: &FrameState| {
        let half = &mut largest[usize::from(state.step > 1000)];
        *half = half.max(state.displacement[0].abs());
    };
    run_linear(&input, &shape, 2000, |_, load| load.fill(0.0), observe);
    largest[1] / largest[0]
}

#[test]
fn explicit_newmark_is_stable_up_to_the_shortest_period_over_pi() {
    let limit = 2.0 / uniform_frequency(2, 2, 1500.0, 2e6);
    let (below, above) = (
        growth(Integrator::Explicit, 0.999 * limit, 1.0),
        growth(Integrator::Explicit, 1.001 * limit, 1.0),
    );
    assert!(below < 1.0 + 1e-3, "{below}");
    assert!(above > 1e10, "{above}");
}

/// Without a limit if `K_I` ≥ `K_t`; with `K_I` = ¾ `K_t` up to 2√(M/(`K_t` − `K_I`)) = 4/ω.
#[test]
fn splitting_is_stable_at_any_step_while_its_operator_is_stiff_enough() {
    let splitting = Integrator::AlphaOs { alpha: 0.0 };
    let limit = 4.0 / uniform_frequency(2, 2, 1500.0, 2e6);
    for time_step in [limit, 10.0 * limit, 1000.0 * limit] {
        for operator in [1.0, 1.5] {
            let found = growth(splitting, time_step, operator);
            assert!(
                found < 1.0 + 1e-3,
                "Δt {time_step}, K_I {operator} K: {found}"
            );
        }
    }
    let (below, above) = (
        growth(splitting, 0.999 * limit, 0.75),
        growth(splitting, 1.001 * limit, 0.75),
    );
    assert!(below < 1.0 + 1e-3, "{below}");
    assert!(above > 1e10, "{above}");
}

#[test]
fn the_tangent_form_is_stable_at_any_step_on_a_linear_frame() {
    for time_step in [0.01, 1.0, 100.0] {
        let found = growth(Integrator::Tangent, time_step, 1.0);
        assert!(found < 1.0 + 1e-3, "Δt {time_step}: {found}");
    }
}

/// Input = kinetic + restoring + damping, to rounding: under the trapezoidal forms with loads, on a damped linear frame, at
/// a step far from convergence.
#[test]
fn the_energy_balance_of_a_linear_frame_closes_to_rounding() {
    let frame = damped();
    let shaken = |time: f64, load: &mut [f64]| frame.ground_load(3.0 * (17.0 * time).sin(), load);
    for integrator in [Integrator::Tangent, Integrator::AlphaOs { alpha: 0.0 }] {
        let mut worst = 0.0_f64;
        let observe = |state: &FrameState| worst = worst.max(state.energies.error.abs());
        let last = run_linear(
            &at(&frame, integrator, 0.02, &[0.0; 5]),
            &[0.0; 5],
            1000,
            shaken,
            observe,
        );
        assert!(last.energies.input > 100.0, "{:?}", last.energies);
        assert!(
            worst < 1e-12 * last.energies.input,
            "{integrator:?}: {worst} of {:?}",
            last.energies
        );
    }
}

/// The residual of explicit Newmark's balance oscillates and does not grow; it decreases with Δt².
#[test]
fn the_error_of_the_explicit_balance_shrinks_with_the_square_of_the_step() {
    let frame = uniform(5, 1500.0, 2e6);
    let worst = |steps: u32| {
        let mut worst = 0.0_f64;
        let observe = |state: &FrameState| worst = worst.max(state.energies.error.abs());
        let input = at(
            &frame,
            Integrator::Explicit,
            2.0 / f64::from(steps),
            &[0.0; 5],
        );
        run_linear(&input, &[0.01; 5], steps, |_, load| load.fill(0.0), observe);
        worst
    };
    let order = (worst(4000) / worst(8000)).log2();
    assert!((order - 2.0).abs() < 0.05, "order {order}");
}

/// Tangents from exact readings of a linear frame equal its stiffness: the run is bit-identical.
#[test]
fn storey_tangents_of_a_linear_frame_change_no_bit() {
    let frame = uniform(20, 1500.0, 2e6);
    let run = |tangents: Tangents| {
        let zero = [0.0; 20];
        let mut solver = FrameSolver::new(&FrameInput {
            tangents,
            ..at(&frame, Integrator::Tangent, 1e-3, &zero)
        })
        .expect("20");
        let (mut load, mut force) = ([0.0; 20], [0.0; 20]);
        for step in 1..=3000_u32 {
            frame.ground_load((f64::from(step) * 0.013).sin(), &mut load);
            let target = solver.predict(&load).to_vec();
            frame.stiffness.mul_into(&target, &mut force);
            solver.complete(&target, &force);
        }
        solver.state().displacement.clone()
    };
    assert_eq!(
        run(Tangents::Initial),
        run(Tangents::Storeys { largest_ratio: 2.0 })
    );
}
