//! Every integrator, compared with the same closed forms: free vibration, the paper's examples with decreasing step, energy.

use psd_physics::contact::ContactLaw;
use psd_physics::impact::{ImpactInput, ImpactSolver};
use psd_physics::integrator::stability::{Met, longest_stable_step};
use psd_physics::specimen::{RestoringForce, SpecimenModel};
use psd_physics::structure::Matrices;
use psd_plan::{Behaviour, Integrator};

use super::support::{impact, run};

const ALL: [Integrator; 5] = [
    Integrator::Tangent,
    Integrator::Explicit,
    Integrator::AlphaOs { alpha: 0.0 },
    Integrator::AlphaOs { alpha: -0.05 },
    Integrator::AlphaOs { alpha: -0.3 },
];

fn by(integrator: Integrator, input: ImpactInput) -> ImpactInput {
    ImpactInput {
        integrator,
        ..input
    }
}

/// A structure released at 1 m, with the striker out of reach.
pub fn vibration(
    integrator: Integrator,
    mass: f64,
    damping: f64,
    stiffness: f64,
    time_step: f64,
) -> ImpactInput {
    let far = ImpactInput {
        gap: 1e9,
        striker_velocity: 0.0,
        damping,
        ..impact(mass, stiffness, ContactLaw::Rigid, time_step)
    };
    by(integrator, far)
}

/// Released at 1 m: error at 0.37 s relative to e^(−λt)(cos ω't + λ/ω' sin ω't) after `steps` steps.
fn error(integrator: Integrator, damping: f64, steps: u32) -> f64 {
    let (mass, stiffness, end): (f64, f64, f64) = (1.0, 400.0, 0.37);
    let input = vibration(integrator, mass, damping, stiffness, end / f64::from(steps));
    let mut solver = ImpactSolver::new(&input, 1.0, stiffness).expect("an impact");
    for _ in 0..steps {
        let target = solver.predict();
        solver.complete(target, stiffness * target);
    }
    let rate = damping / (2.0 * mass);
    let damped = (stiffness / mass - rate * rate).sqrt();
    let exact = (-rate * end).exp() * ((damped * end).cos() + rate / damped * (damped * end).sin());
    solver.state().displacement - exact
}

#[test]
fn free_vibration_is_of_second_order_under_every_integrator() {
    for integrator in ALL {
        for damping in [0.0, 6.0] {
            let order = (error(integrator, damping, 400) / error(integrator, damping, 800)).log2();
            assert!(
                (order - 2.0).abs() < 0.04,
                "{integrator:?}, C {damping}: order {order}"
            );
            assert!(
                error(integrator, damping, 800).abs() < 2e-4,
                "{integrator:?}: {}",
                error(integrator, damping, 800)
            );
        }
    }
}

/// Largest X of a run: mass, K, law, Δt.
fn largest(
    integrator: Integrator,
    mass: f64,
    stiffness: f64,
    law: ContactLaw,
    time_step: f64,
) -> f64 {
    run(&by(integrator, impact(mass, stiffness, law, time_step)))
        .summary
        .max_displacement
}

/// The exact collisions (reference table): 0.157698, 0.168185 and 0.174078 m. The error shrinks with the step, and is
/// below 0.05 % at 10 µs; at each tenth of a step it is a tenth or less.
#[test]
fn the_papers_examples_converge_to_the_exact_collisions_under_every_integrator() {
    let cases = [
        (1.0, 327.65, ContactLaw::Rigid, 0.157_698),
        (0.25, 327.65, ContactLaw::Rigid, 0.168_185),
        (1.0, 300.0, ContactLaw::Limit { force: 1500.0 }, 0.174_078),
    ];
    for integrator in ALL {
        for (mass, stiffness, law, exact) in cases {
            let error = |time_step| largest(integrator, mass, stiffness, law, time_step) - exact;
            let (coarse, fine) = (error(1e-4), error(1e-5));
            assert!(
                fine.abs() < 8e-5,
                "{integrator:?}, {mass} kg, {law:?}: {fine} m at 10 µs, {coarse} m at 0.1 ms"
            );
        }
    }
}

/// Without α, and with the specimen's own stiffness as operator, α-OS is the tangent form: the same numbers at any step.
#[test]
fn splitting_without_alpha_is_the_tangent_form_of_a_linear_specimen() {
    for (law, time_step) in [
        (ContactLaw::Rigid, 0.01),
        (ContactLaw::Limit { force: 1500.0 }, 1e-3),
    ] {
        let input = ImpactInput {
            damping: 2.0,
            gap: 0.003,
            ..impact(1.0, 327.65, law, time_step)
        };
        let (tangent, split) = (
            run(&input),
            run(&by(Integrator::AlphaOs { alpha: 0.0 }, input)),
        );
        assert_eq!(tangent.states.len(), split.states.len());
        for (one, other) in tangent.states.iter().zip(&split.states) {
            assert!((one.displacement - other.displacement).abs() < 1e-12);
            assert!((one.contact_force - other.contact_force).abs() < 1e-8);
            assert_eq!(one.state, other.state);
        }
    }
}

/// Energy balance: to rounding if the trapezoid is exact, and of second order or better otherwise.
#[test]
fn energy_closes_under_every_integrator() {
    for integrator in ALL {
        let worst = |time_step| {
            run(&by(
                integrator,
                impact(1.0, 327.65, ContactLaw::Rigid, time_step),
            ))
            .worst_error
                / 5.0
        };
        let (coarse, fine) = (worst(1e-3), worst(1e-4));
        match integrator {
            Integrator::Tangent => assert!(coarse < 1e-12),
            Integrator::AlphaOs { alpha: 0.0 } => assert!(coarse < 1e-12, "{coarse}"),
            _ => assert!(
                coarse < 0.02 && fine < 0.15 * coarse,
                "{integrator:?}: {coarse} at 1 ms, {fine} at 0.1 ms"
            ),
        }
    }
}

/// The rigid impact of α-OS is the paper's collision, e = Ms/(Ms + 2M), for every α.
#[test]
fn numerical_damping_does_not_soften_the_impact() {
    for integrator in ALL {
        let found = run(&by(
            integrator,
            impact(1.0, 327.65, ContactLaw::Rigid, 1e-5),
        ))
        .summary
        .restitution
        .unwrap();
        assert!(
            (found - 10.0 / 12.0).abs() < 2e-3,
            "{integrator:?}: {found}"
        );
    }
}

/// Just below the limit a free vibration is bounded for a thousand steps. Just above it, it diverges.
#[test]
fn the_stability_limits_are_as_stated() {
    let (mass, stiffness): (f64, f64) = (1.0, 400.0);
    let farthest = |integrator, operator, time_step| {
        let input = ImpactInput {
            operator_stiffness: operator,
            ..vibration(integrator, mass, 0.0, stiffness, time_step)
        };
        let mut solver = ImpactSolver::new(&input, 1.0, stiffness).expect("an impact");
        (0..1000).fold(0.0_f64, |farthest, _| {
            let target = solver.predict();
            solver.complete(target, stiffness * target);
            farthest.max(solver.state().displacement.abs())
        })
    };
    let explicit = longest_stable_step(
        Integrator::Explicit,
        &Met::one(
            &Matrices {
                mass,
                damping: 0.0,
                stiffness,
                gravity: None,
            },
            0.0,
        ),
    );
    assert!(
        (explicit - 2.0 * std::f64::consts::PI / 20.0 / std::f64::consts::PI).abs() < 1e-15,
        "T/π"
    );
    assert!(farthest(Integrator::Explicit, 0.0, 0.99 * explicit) < 20.0);
    assert!(farthest(Integrator::Explicit, 0.0, 1.01 * explicit) > 1e20);

    let soft = 300.0;
    let split = Integrator::AlphaOs { alpha: 0.0 };
    let limit = longest_stable_step(
        split,
        &Met::one(
            &Matrices {
                mass,
                damping: 0.0,
                stiffness,
                gravity: None,
            },
            soft,
        ),
    );
    assert!(farthest(split, soft, 0.99 * limit) < 20.0);
    assert!(farthest(split, soft, 1.01 * limit) > 1e20);
    for alpha in [0.0, -0.05, -0.3] {
        assert!(
            farthest(Integrator::AlphaOs { alpha }, stiffness, 10.0) < 1.001,
            "as stiff as the specimen: no limit"
        );
        assert!(
            farthest(
                Integrator::AlphaOs { alpha },
                2.0 * stiffness,
                2.0 * explicit
            ) < 5.0,
            "stiffer: none either"
        );
    }
}

/// Growth of a free vibration per step, compared with the reported limit: α-OS with an operator below the specimen's stiffness, damped
/// and undamped. Just below the limit, the growth is at most the decay from a damping ratio of 1e-4. Just above it is larger.
#[test]
fn splitting_with_too_little_stiffness_grows_as_its_amplification_factors() {
    let (mass, stiffness): (f64, f64) = (1.0, 400.0);
    let omega = (stiffness / mass).sqrt();
    for (alpha, share, ratio) in [
        (-0.05, 0.5, 0.0),
        (-0.1, 0.25, 0.02),
        (-0.2, 0.5, 0.0),
        (-0.3, 0.5, 0.0),
        (-0.3, 0.5, 0.02),
        (-1.0 / 3.0, 0.9, 0.05),
    ] {
        let integrator = Integrator::AlphaOs { alpha };
        let (damping, soft) = (2.0 * ratio * omega * mass, (1.0 - share) * stiffness);
        let limit = longest_stable_step(
            integrator,
            &Met::one(
                &Matrices {
                    mass,
                    damping,
                    stiffness,
                    gravity: None,
                },
                soft,
            ),
        );
        // ln|z| of the fastest of its motions, by the size of the state over many steps.
        let growth = |time_step: f64| {
            let input = ImpactInput {
                operator_stiffness: soft,
                ..vibration(integrator, mass, damping, stiffness, time_step)
            };
            let mut solver = ImpactSolver::new(&input, 1.0, stiffness).expect("an impact");
            let size = |solver: &ImpactSolver| {
                let state = solver.state();
                (state.displacement * omega)
                    .hypot(state.velocity)
                    .hypot(state.acceleration / omega)
            };
            let mut step = |count: u32| {
                let mut largest = 0.0_f64;
                for _ in 0..count {
                    let target = solver.predict();
                    solver.complete(target, stiffness * target);
                    largest = largest.max(size(&solver));
                    if largest > 1e100 {
                        return f64::INFINITY;
                    }
                }
                largest
            };
            let before = if step(2000).is_finite() {
                step(300)
            } else {
                1.0
            };
            step(3700);
            (step(300) / before).ln() / 4000.0
        };
        let trifle = if ratio == 0.0 {
            1e-4 * omega * limit
        } else {
            0.0
        };
        let (inside, beyond) = (growth(0.97 * limit), growth(1.03 * limit));
        assert!(
            inside < trifle && beyond > trifle,
            "α {alpha}, {share}, ζ {ratio}: {limit} s, {inside} {beyond} {trifle}"
        );
    }
}

/// The tangent form on a specimen that yields. It predicts the force with the slope of the last step. If the slope changes, the force
/// error of that step is δ = (K − `K_t`)ΔX. The error of the balance is −½ΔX(δ + δ₀), with δ₀ from the last step; there is no other
/// error. Thus no step size is stable in itself. At a tenth of the default step a yielding vibration loses almost nothing. At a fifth of
/// the period (twice `critical`) the balance is useless.
#[test]
fn the_tangent_form_errs_by_what_its_slope_is_late() {
    let (mass, stiffness): (f64, f64) = (1.0, 400.0);
    let behaviour = Behaviour::Bilinear {
        stiffness,
        yield_force: 20.0,
        post_yield_ratio: 0.05,
    };
    let off = |time_step: f64| {
        let input = ImpactInput {
            max_tangent_ratio: 10.0,
            ..vibration(Integrator::Tangent, mass, 0.0, stiffness, time_step)
        };
        let mut specimen = SpecimenModel::new(&behaviour);
        let (mut position, mut force) = (0.15, specimen.move_to(0.15));
        let mut solver = ImpactSolver::new(&input, position, force).expect("an impact");
        let began = force * force / (2.0 * stiffness);
        let (mut slope, mut late, mut reckoned, mut largest) = (stiffness, 0.0, 0.0, 0.0_f64);
        let mut time = 0.0;
        while time < 30.0 {
            time += time_step;
            let target = solver.predict();
            let read = specimen.move_to(target);
            solver.complete(target, read);
            let moved = target - position;
            let erred = read - force - slope * moved;
            reckoned -= 0.5 * moved * (erred + late);
            slope = ((read - force) / moved).clamp(0.0, 10.0 * stiffness);
            (position, force, late) = (target, read, erred);
            let error = solver.state().energies.error;
            assert!(
                (error - reckoned).abs() < 1e-9 * (1.0 + reckoned.abs()),
                "{error} {reckoned}"
            );
            largest = largest.max(error.abs() / began);
        }
        largest
    };
    let critical = 0.2 * std::f64::consts::PI * (mass / stiffness).sqrt();
    let (tenth, default, coarse) = (
        off(critical / 200.0),
        off(critical / 20.0),
        off(2.0 * critical),
    );
    assert!(
        tenth < 0.01 && tenth < 0.2 * default && default < 0.05,
        "{tenth} {default}"
    );
    assert!(coarse > 1.0, "{coarse}");
}
