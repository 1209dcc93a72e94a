//! An impact on one of two floors compared with closed forms: the joined chain of a plastic impact, free masses under Hertz's contact,
//! momentum and energy.

use psd_physics::contact::ContactLaw;
use psd_physics::impact::{FrameImpactSolver, ImpactSetup};
use psd_physics::structure::{FrameMatrices, SymmetricBand, storey_stiffness};
use psd_plan::Integrator;

use super::support::{at, number};

const STRIKER: f64 = 10.0;
const SPEED: f64 = 1.0;
const MASSES: [f64; 2] = [4.0, 3.0];
const STOREYS: [f64; 2] = [3e4, 2e4];

fn frame(damping: f64) -> FrameMatrices {
    let stiffness = storey_stiffness(&STOREYS);
    let mut matrix = stiffness.clone();
    matrix.scale(damping);
    FrameMatrices {
        mass: SymmetricBand::diagonal(&MASSES),
        damping: matrix,
        stiffness,
        gravity: None,
    }
}

fn solver(
    frame: &FrameMatrices,
    struck: usize,
    law: ContactLaw,
    integrator: Integrator,
    time_step: f64,
) -> FrameImpactSolver {
    let input = at(frame, integrator, time_step, &[0.0; 2]);
    let setup = ImpactSetup {
        struck,
        mass: STRIKER,
        velocity: SPEED,
        gap: 0.0,
        gravity: 0.0,
        law,
    };
    FrameImpactSolver::on(&input, &setup).expect("an impact")
}

/// One step on the linear frame of the matrices.
fn step(solver: &mut FrameImpactSolver, frame: &FrameMatrices) {
    let target = solver.predict().to_vec();
    let mut force = [0.0; 2];
    frame.stiffness.mul_into(&target, &mut force);
    solver.complete(&target, &force);
}

/// Two masses on two springs that leave X = 0 with the velocities `v`: eigenvalues of the two by two problem by its
/// characteristic equation, X = Σ φ (φᵀMv)/(ω φᵀMφ) sin ωt.
fn modal(masses: [f64; 2], v: [f64; 2], time: f64) -> [f64; 2] {
    let (k11, k12, k22) = (STOREYS[0] + STOREYS[1], -STOREYS[1], STOREYS[1]);
    // det(K − λM) = m₁m₂λ² − (k₁₁m₂ + k₂₂m₁)λ + k₁₁k₂₂ − k₁₂².
    let (a, b, c) = (
        masses[0] * masses[1],
        k11 * masses[1] + k22 * masses[0],
        k11 * k22 - k12 * k12,
    );
    let root = (b * b - 4.0 * a * c).sqrt();
    let mut x = [0.0; 2];
    for squared in [(b - root) / (2.0 * a), (b + root) / (2.0 * a)] {
        let shape = [1.0, (squared * masses[0] - k11) / k12];
        let modal_mass = masses[0] + shape[1] * shape[1] * masses[1];
        let given = masses[0] * v[0] + shape[1] * masses[1] * v[1];
        let size = given / (squared.sqrt() * modal_mass) * (squared.sqrt() * time).sin();
        x[0] += size;
        x[1] += size * shape[1];
    }
    x
}

/// Largest error of either floor after 12 ms of an impact on `struck`, over the peak displacement, in `steps` steps.
fn error(struck: usize, coefficient: f64, steps: u32) -> f64 {
    const END: f64 = 0.012;
    let frame = frame(0.0);
    let law = ContactLaw::Restitution { coefficient };
    let mut solver = solver(
        &frame,
        struck,
        law,
        Integrator::Tangent,
        END / f64::from(steps),
    );
    for _ in 0..steps {
        step(&mut solver, &frame);
    }
    assert!(
        solver.state().energies.error.abs() < 1e-12,
        "{} J",
        solver.state().energies.error
    );
    // e = 0: the striker is part of that floor from the first instant on. Else floor and striker part.
    let (mut masses, mut velocity) = (MASSES, [0.0; 2]);
    if coefficient == 0.0 {
        masses[struck] += STRIKER;
        velocity[struck] = STRIKER * SPEED / masses[struck];
    } else {
        velocity[struck] = (1.0 + coefficient) * STRIKER * SPEED / (MASSES[struck] + STRIKER);
    }
    let exact = modal(masses, velocity, END);
    let size = exact[0].abs().max(exact[1].abs());
    let found = &solver.structure().displacement;
    found
        .iter()
        .zip(exact)
        .map(|(found, exact)| (found - exact).abs() / size)
        .fold(0.0, f64::max)
}

/// The two-mass chain, struck below or above, joined by a plastic impact or separated by an elastic one: the modal solution,
/// with the square of the step.
#[test]
fn a_struck_chain_is_its_modal_solution_to_second_order() {
    for (struck, coefficient) in [(0, 0.0), (1, 0.0), (0, 1.0), (1, 1.0)] {
        let (coarse, fine) = (
            error(struck, coefficient, 40),
            error(struck, coefficient, 80),
        );
        let order = (coarse / fine).log2();
        assert!(
            (order - 2.0).abs() < 0.05,
            "floor {struck}, e = {coefficient}: {coarse}, {fine}, order {order}"
        );
        assert!(fine < 1e-3, "floor {struck}, e = {coefficient}: {fine}");
    }
}

/// Hertz between free masses, also approximated by a stiff contact on a soft frame: F = k^(2/5) (5/4 μu²)^(3/5), duration 2.943 δ/u. All
/// elastic energy is released.
#[test]
fn a_hertz_impact_on_a_floor_is_that_of_free_masses() {
    const STIFFNESS: f64 = 1e9;
    let frame = frame(0.0);
    for struck in [0, 1] {
        let reduced = STRIKER * MASSES[struck] / (STRIKER + MASSES[struck]);
        let deepest = (1.25 * reduced * SPEED * SPEED / STIFFNESS).powf(0.4);
        let (peak, contact_time) = (STIFFNESS * deepest.powf(1.5), 2.943 * deepest / SPEED);
        let law = ContactLaw::Hertz {
            stiffness: STIFFNESS,
            loss: 0.0,
            force_limit: None,
        };
        let time_step = contact_time / 50.0;
        let mut solver = solver(&frame, struck, law, Integrator::Tangent, time_step);
        let (mut largest, mut touching) = (0.0_f64, 0);
        for _ in 0..100 {
            step(&mut solver, &frame);
            largest = largest.max(solver.state().contact_force);
            touching += usize::from(solver.state().contact_force > 0.0);
        }
        // The mean over a fiftieth of the contact at its peak, and the compliance of the frame.
        assert!(
            (largest / peak - 1.0).abs() < 2e-3,
            "{largest} is not {peak}"
        );
        assert!(
            (number(touching) * time_step / contact_time - 1.0).abs() < 0.03,
            "{touching} steps of {time_step}, not {contact_time}"
        );
        let energies = solver.state().energies;
        assert!(
            energies.contact_loss.abs() < 2e-4 * 5.0,
            "{} J",
            energies.contact_loss
        );
        assert!(energies.error.abs() < 1e-9, "{} J", energies.error);
    }
}

/// The momentum that the striker loses is that of the floors and of the ground: Σ M Ẋ + Ms Ẋs + ∫ V dt = Ms V0, the shear by the
/// trapezoid; and the energy closes to rounding, damped or not.
#[test]
fn momentum_and_energy_close_under_the_laws_of_impulses() {
    for law in [ContactLaw::Rigid, ContactLaw::Limit { force: 800.0 }] {
        for damping in [0.0, 2e-4] {
            let frame = frame(damping);
            let mut solver = solver(&frame, 1, law, Integrator::Tangent, 1e-4);
            let (mut ground, mut before) = (0.0, 0.0);
            let mut checked = 0;
            for _ in 0..2000 {
                step(&mut solver, &frame);
                let state = solver.structure();
                let mut braked = [0.0; 2];
                frame.damping.mul_into(&state.velocity, &mut braked);
                let shear: f64 = state.restoring_force.iter().chain(&braked).sum();
                ground += 0.5e-4 * (before + shear);
                before = shear;
                let carried: f64 = state
                    .velocity
                    .iter()
                    .zip(MASSES)
                    .map(|(velocity, mass)| mass * velocity)
                    .sum();
                // A force acts at both ends of its step; half of it is still to come.
                let pending = 0.5e-4 * solver.state().contact_force;
                let whole = carried + pending + STRIKER * solver.state().striker_velocity + ground;
                assert!(
                    (whole - STRIKER * SPEED).abs() < 1e-11,
                    "{law:?}, {damping} s: {whole} N·s"
                );
                assert!(
                    solver.state().energies.error.abs() < 1e-11,
                    "{} J",
                    solver.state().energies.error
                );
                checked += 1;
            }
            assert_eq!(checked, 2000);
        }
    }
}
