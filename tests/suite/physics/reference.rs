//! The reference results: each a case of the paper, at its step and converged.

use psd_physics::contact::ContactLaw;
use psd_physics::critical_time_step;
use psd_physics::impact::ImpactInput;

use super::support::{Run, event_driven, impact, run};

#[track_caller]
fn near(what: &str, value: f64, expected: f64, tolerance: f64) {
    assert!(
        (value - expected).abs() <= tolerance,
        "{what}: {value} is not {expected} ± {tolerance}"
    );
}

const LIMIT_1500: ContactLaw = ContactLaw::Limit { force: 1500.0 };
const LIMIT_5000: ContactLaw = ContactLaw::Limit { force: 5000.0 };

/// Largest X, the time at which the striker stops and the largest contact force.
#[track_caller]
fn expect(run: &Run, max_displacement: f64, stop_time: f64, peak_force: f64, force_tolerance: f64) {
    near(
        "largest X",
        run.summary.max_displacement,
        max_displacement,
        5e-7,
    );
    near("stop time", run.stop_time(), stop_time, 1e-9);
    near(
        "peak force",
        run.summary.max_contact_force,
        peak_force,
        force_tolerance,
    );
    assert!(!run.summary.still_rising);
}

#[test]
fn example_1() {
    expect(
        &run(&impact(1.0, 327.65, ContactLaw::Rigid, 0.01)),
        0.157_864,
        0.29,
        252.0,
        0.5,
    );
    expect(
        &run(&impact(1.0, 327.65, ContactLaw::Rigid, 0.001)),
        0.157_353,
        0.284,
        2336.0,
        0.5,
    );
    near(
        "critical time step",
        critical_time_step(1.0, 327.65),
        0.0347,
        5e-5,
    );
    near("energy bound (8)", (10.0 / 327.65_f64).sqrt(), 0.1747, 5e-5);
}

#[test]
fn example_2() {
    expect(
        &run(&impact(0.25, 327.65, ContactLaw::Rigid, 0.01)),
        0.168_965,
        0.28,
        97.7,
        0.05,
    );
}

#[test]
fn figure_11() {
    expect(
        &run(&impact(1.0, 300.0, LIMIT_5000, 0.001)),
        0.164_429,
        0.297,
        2301.0,
        0.5,
    );
    let limited = run(&impact(1.0, 300.0, LIMIT_1500, 0.001));
    expect(&limited, 0.165_524, 0.300, 1500.0, 0.0);
    near(
        "indentation energy",
        limited.summary.indentation_energy,
        3.35,
        0.005,
    );
    near(
        "contact loss",
        limited.last().energies.contact_loss,
        0.89,
        0.005,
    );
}

#[test]
fn converged() {
    let rigid = |mass| run(&impact(mass, 327.65, ContactLaw::Rigid, 2e-6));
    for (mass, max_displacement, stop_time) in
        [(1.0, 0.157_698, 0.280_49), (0.25, 0.168_185, 0.269_22)]
    {
        let run = rigid(mass);
        near(
            "largest X",
            run.summary.max_displacement,
            max_displacement,
            1.5e-6,
        );
        near("stop time", run.stop_time(), stop_time, 3e-5);
        let (exact_displacement, exact_stop) =
            event_driven(mass, 10.0, 1.0, 327.65, 10.0 / (10.0 + 2.0 * mass));
        near(
            "largest X of exact collisions",
            exact_displacement,
            max_displacement,
            1.5e-6,
        );
        near("stop time of exact collisions", exact_stop, stop_time, 3e-5);
    }
    let limited = run(&impact(1.0, 300.0, LIMIT_1500, 2e-6));
    near(
        "largest X",
        limited.summary.max_displacement,
        0.174_078,
        1.5e-6,
    );
    near("stop time", limited.stop_time(), 0.301_09, 3e-5);
    // The first step starts with no contact force in Ẍ₀, so the trapezoid gives the structure half of its share. The structure then lags
    // by ½(F/M)Δt for the whole duration μV0/F of the contact. The indentation is ½(μ/M)V0Δt deeper than its limit.
    let reduced_mass = 10.0 / 11.0;
    let (limit, lag) = (0.5 * reduced_mass / 1500.0, 0.5 * reduced_mass * 2e-6);
    near("limit of the indentation", limit, 0.303e-3, 0.5e-6);
    near(
        "indentation",
        limited.summary.indentation,
        limit + lag,
        1e-4 * limit,
    );
    near(
        "indentation energy",
        limited.summary.indentation_energy,
        1500.0 * (limit + lag),
        1e-4 * 0.4545,
    );
    near("the step's part of it", lag / limit, 0.003, 5e-6);
    near(
        "contact loss",
        limited.last().energies.contact_loss,
        0.4545,
        0.003 * 0.4545,
    );
}

/// Eq. (4) from rest: `Ẋ₁ = ½MsV0 / (M + ½Ms + ¼Δt²K)`, which tends to Ms·V0/(2M + Ms). The force of that one step is the impulse over
/// Δt.
#[test]
fn rigid_force_grows_as_the_step_shrinks() {
    for time_step in [1e-2, 1e-4, 1e-6] {
        let struck = run(&impact(1.0, 327.65, ContactLaw::Rigid, time_step)).states[1];
        let velocity = 5.0 / (6.0 + 0.25 * time_step * time_step * 327.65);
        near("velocity", struck.velocity, velocity, 1e-14);
        near(
            "force",
            struck.contact_force,
            10.0 * (1.0 - velocity) / time_step,
            1e-12 / time_step,
        );
    }
}

#[test]
fn beam() {
    for (mass, max_displacement) in [(0.5, 7.922e-3), (0.75, 7.855e-3)] {
        let input = ImpactInput {
            striker_mass: 20.0,
            ..impact(mass, 3e5, ContactLaw::Rigid, 5e-4)
        };
        let run = run(&input);
        near("input", input.striker_energy(), 10.0, 1e-12);
        near(
            "largest X",
            run.summary.max_displacement,
            max_displacement,
            5e-7,
        );
        near("stop time", run.stop_time(), 0.0135, 1e-9);
    }
}

/// A linear specimen leaves no integration error: the balance is an identity of each law's step. `restitution` adds the loss of each
/// impact at its instant, `hertz` that of each part. Their sub-steps share the step's tangent stiffness. It equals that of the specimen,
/// so the trapezoid over the whole step is still exact.
#[test]
fn energy_closes_at_every_step() {
    for law in [
        ContactLaw::Rigid,
        LIMIT_1500,
        ContactLaw::Restitution { coefficient: 0.5 },
        ContactLaw::Hertz {
            stiffness: 1e7,
            loss: 0.0,
            force_limit: None,
        },
    ] {
        for time_step in [0.01, 0.001] {
            let run = run(&impact(1.0, 327.65, law, time_step));
            assert!(
                run.worst_error < 5e-12,
                "{law:?} at {time_step} s: {} J",
                run.worst_error
            );
        }
    }
}
