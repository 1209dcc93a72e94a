//! The contact laws, compared with closed forms and exact collisions.

use psd_physics::contact::ContactLaw;

use psd_physics::contact::state::StepState;
use psd_physics::impact::ImpactInput;
use psd_physics::specimen::{Bilinear, BilinearCurve, Elastic, RestoringForce};
use psd_physics::statistics::DeclaredNoise;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::support::{Run, event_driven, impact, run, run_on, run_while};

const K: f64 = 327.65;

/// The noise of a load cell.
const NOISE: DeclaredNoise = DeclaredNoise {
    force: 5.0,
    resolution: 0.0,
};

/// Relative tolerance.
#[track_caller]
fn near(what: &str, value: f64, expected: f64, tolerance: f64) {
    assert!(
        (value / expected - 1.0).abs() <= tolerance,
        "{what}: {value} is not {expected} within {tolerance}"
    );
}

const fn restitution(coefficient: f64) -> ContactLaw {
    ContactLaw::Restitution { coefficient }
}

#[test]
fn exact_collisions_give_the_converged_references() {
    for (mass, displacement, stop) in [(1.0, 0.157_698, 0.280_49), (0.25, 0.168_185, 0.269_22)] {
        let (found, stopped) = event_driven(mass, 10.0, 1.0, K, 10.0 / (10.0 + 2.0 * mass));
        assert!(
            (found - displacement).abs() < 1e-6 && (stopped - stop).abs() < 1e-5,
            "{mass} kg: {found} m, {stopped} s"
        );
    }
}

#[test]
fn rigid_tends_to_its_implied_restitution() {
    for mass in [0.25, 1.0, 4.0, 10.0] {
        let e = 10.0 / (10.0 + 2.0 * mass);
        let run = run(&impact(mass, K, ContactLaw::Rigid, 1e-6));
        let (displacement, stop) = event_driven(mass, 10.0, 1.0, K, e);
        near(
            "restitution",
            run.summary.restitution.expect("a blow"),
            e,
            1e-4,
        );
        near(
            "largest X",
            run.summary.max_displacement,
            displacement,
            1e-4,
        );
        near("stop time", run.stop_time(), stop, 1e-4);
    }
}

#[test]
fn limit_tends_to_a_plastic_collision() {
    for force in [1500.0, 6000.0] {
        let run = run(&impact(1.0, K, ContactLaw::Limit { force }, 1e-6));
        near(
            "indentation",
            run.summary.indentation,
            0.5 * (10.0 / 11.0) / force,
            0.01,
        );
        near(
            "largest X",
            run.summary.max_displacement,
            10.0 / (K * 11.0).sqrt(),
            2e-4,
        );
    }
}

#[test]
fn restitution_follows_exact_collisions() {
    for e in [0.0, 0.5, 0.9, 1.0] {
        for mass in [0.25, 1.0, 4.0] {
            let run = run(&impact(mass, K, restitution(e), 1e-5));
            let (displacement, stop) = event_driven(mass, 10.0, 1.0, K, e);
            near(
                "largest X",
                run.summary.max_displacement,
                displacement,
                2e-6,
            );
            near("stop time", run.stop_time(), stop, 2e-4);
        }
    }
}

/// e = 0: one impact, after which the two bodies move as one.
#[test]
fn without_restitution_they_stick() {
    let run = run(&impact(1.0, K, restitution(0.0), 1e-4));
    near(
        "largest X",
        run.summary.max_displacement,
        10.0 / (K * 11.0).sqrt(),
        1e-6,
    );
    near(
        "loss",
        run.last().energies.contact_loss,
        0.5 * 10.0 / 11.0,
        1e-12,
    );
    assert_eq!(run.summary.contacts, 1);
    assert!(
        run.states[1..]
            .iter()
            .all(|state| state.velocity == state.striker_velocity)
    );
}

/// No body passes through another for any step size. A step counts as contact only if it transferred momentum.
#[test]
fn bodies_never_pass_through_each_other() {
    for e in [0.0, 0.3, 0.9, 0.999, 1.0] {
        for (mass, damping) in [(0.01, 0.0), (0.25, 2.0), (1.0, 10.0), (30.0, 0.0)] {
            for time_step in [1e-2, 1e-3, 1e-4] {
                let input = ImpactInput {
                    damping,
                    gap: 0.003,
                    ..impact(mass, K, restitution(e), time_step)
                };
                let run = run_while(&input, &mut Elastic { stiffness: K }, |state| {
                    state.time < 1.5
                });
                for state in &run.states {
                    let overlap = state.striker_displacement - state.displacement;
                    assert!(
                        overlap < 1e-13,
                        "e {e}, {mass} kg, {time_step} s: {overlap} m at {} s",
                        state.time
                    );
                    assert_eq!(
                        state.state == StepState::Contact,
                        state.contact_force > 0.0,
                        "{state:?}"
                    );
                }
                assert!(
                    run.worst_error < 5e-12,
                    "e {e}, {mass} kg, {time_step} s: {} J",
                    run.worst_error
                );
            }
        }
    }
}

/// Free masses under Hertz's law, to the end of the contact.
fn free_masses(loss: f64, force_limit: Option<f64>) -> (Run, f64) {
    let input = impact(
        1.0,
        0.0,
        ContactLaw::Hertz {
            stiffness: 1e7,
            loss,
            force_limit,
        },
        2e-6,
    );
    let run = run_while(&input, &mut Elastic { stiffness: 0.0 }, |state| {
        state.step == 0 || state.state != StepState::Free
    });
    let last = run.last();
    let restitution = last.velocity - last.striker_velocity;
    (run, restitution)
}

fn deepest(run: &Run) -> f64 {
    run.states
        .iter()
        .map(|state| state.striker_displacement - state.displacement)
        .fold(0.0, f64::max)
}

const REDUCED: f64 = 10.0 / 11.0;

#[test]
fn hertz_on_free_masses() {
    let (run, restitution) = free_masses(0.0, None);
    let depth = (1.25 * REDUCED / 1e7_f64).powf(0.4);
    near(
        "peak force",
        run.summary.max_contact_force,
        1e7_f64.powf(0.4) * (1.25 * REDUCED).powf(0.6),
        1e-5,
    );
    near("depth", deepest(&run), depth, 1e-5);
    let touching = run
        .states
        .iter()
        .filter(|state| state.contact_force > 0.0)
        .count();
    near(
        "duration",
        f64::from(u32::try_from(touching).expect("few")) * 2e-6,
        2.943 * depth,
        1e-3,
    );
    near("restitution", restitution, 1.0, 1e-9);
    near(
        "restitution",
        run.summary.restitution.expect("a blow"),
        1.0,
        1e-9,
    );
}

/// μ v dv/(1 + λv) = −k δ^1.5 dδ. With G(v) = v/λ − ln(1 + λv)/λ², the depth follows from 0.4 k δ^2.5 = μ G(u). The bodies separate at
/// the −v with G(−v) = G(u).
#[test]
fn hertz_loss_dissipates_the_energy_of_hunt_and_crossley() {
    const LOSS: f64 = 0.3;
    let g = |v: f64| v / LOSS - (LOSS * v).ln_1p() / (LOSS * LOSS);
    let (run, restitution) = free_masses(LOSS, None);
    near(
        "depth",
        deepest(&run),
        (REDUCED * g(1.0) / (0.4 * 1e7)).powf(0.4),
        1e-5,
    );
    near("G at parting", g(-restitution), g(1.0), 1e-4);
    assert!(restitution < 0.9);
    near(
        "loss",
        run.last().energies.contact_loss,
        0.5 * REDUCED * (1.0 - restitution * restitution),
        1e-9,
    );
}

/// Beyond the limit the surface yields: 0.4 F δ is stored elastically and released, the rest is F δp.
#[test]
fn hertz_limit_dents() {
    const FORCE: f64 = 500.0;
    let (run, restitution) = free_masses(0.0, Some(FORCE));
    let held = 0.4 * FORCE * (FORCE / 1e7).powf(2.0 / 3.0);
    assert_eq!(run.summary.max_contact_force, FORCE);
    near(
        "dent",
        run.summary.indentation,
        (0.5 * REDUCED - held) / FORCE,
        1e-4,
    );
    near(
        "indentation energy",
        run.summary.indentation_energy,
        0.5 * REDUCED - held,
        1e-4,
    );
    near(
        "restitution",
        restitution,
        (2.0 * held / REDUCED).sqrt(),
        1e-4,
    );
    assert!(
        run.states
            .iter()
            .any(|state| state.state == StepState::Limit)
    );
}

/// A stiff contact without loss is a collision with e = 1.
#[test]
fn hertz_tends_to_a_hard_collision() {
    let run = run(&impact(
        1.0,
        K,
        ContactLaw::Hertz {
            stiffness: 1e13,
            loss: 0.0,
            force_limit: None,
        },
        1e-4,
    ));
    let (displacement, stop) = event_driven(1.0, 10.0, 1.0, K, 1.0);
    near(
        "largest X",
        run.summary.max_displacement,
        displacement,
        1e-4,
    );
    near("stop time", run.stop_time(), stop, 1e-3);
}

#[test]
fn a_gap_delays_the_first_contact() {
    let hertz = ContactLaw::Hertz {
        stiffness: 1e7,
        loss: 0.0,
        force_limit: None,
    };
    for (law, steps_late) in [
        (ContactLaw::Rigid, 2.0),
        (restitution(0.5), 1.0),
        (hertz, 1.0),
    ] {
        let time_step = 1e-3;
        let run = run(&ImpactInput {
            gap: 0.0505,
            ..impact(1.0, K, law, time_step)
        });
        let first = run
            .states
            .iter()
            .find(|state| state.contact_force > 0.0)
            .expect("contact");
        assert!(
            run.states
                .iter()
                .take_while(|state| state.time < 0.0505)
                .all(|state| state.displacement == 0.0)
        );
        assert!(
            first.time > 0.0505 && first.time <= 0.0505 + steps_late * time_step,
            "{law:?}: {}",
            first.time
        );
    }
    let touching = run(&impact(1.0, K, restitution(0.5), 1e-5));
    let apart = run(&ImpactInput {
        gap: 0.05,
        ..impact(1.0, K, restitution(0.5), 1e-5)
    });
    near(
        "largest X",
        apart.summary.max_displacement,
        touching.summary.max_displacement,
        1e-6,
    );
    near(
        "stop time",
        apart.stop_time(),
        touching.stop_time() + 0.05,
        1e-4,
    );
}

/// e = 0 on a bilinear specimen stops when its energy is dissipated: ½(M+Ms)v² = ½Fy²/K + Fy p + ½hKp², X = Fy/K + p.
#[test]
fn a_yielding_specimen_stops_at_the_position_from_its_energy() {
    let (yield_force, post_yield_ratio): (f64, f64) = (20.0, 0.1);
    let at = |time_step| {
        let mut specimen = Bilinear::new(BilinearCurve {
            stiffness: K,
            yield_force,
            post_yield_ratio,
        });
        run_on(&impact(1.0, K, restitution(0.0), time_step), &mut specimen)
    };
    let energy = 0.5 * 100.0 / 11.0 - 0.5 * yield_force * yield_force / K;
    let slope = post_yield_ratio * K;
    let plastic = ((yield_force * yield_force + 2.0 * slope * energy).sqrt() - yield_force) / slope;
    near(
        "largest X",
        at(1e-5).summary.max_displacement,
        yield_force / K + plastic,
        2e-5,
    );
    let (coarse, fine) = (at(1e-3).worst_error, at(1e-4).worst_error);
    assert!(
        fine > 0.0 && coarse > 5.0 * fine,
        "integration error {coarse} J, then {fine} J"
    );
}

/// Eq. (6) with ±5 N of noise: a secant counts only over at least 10·σ/K0. 10 N of change is then at most 20 % of K0. At the small step,
/// no single step determines the stiffness; the window of several steps determines it better.
#[test]
fn noise_does_not_become_a_stiffness() {
    struct Noisy {
        sign: f64,
    }
    impl RestoringForce for Noisy {
        fn move_to(&mut self, displacement: f64) -> f64 {
            self.sign = -self.sign;
            3e5 * displacement + 5.0 * self.sign
        }
        fn initial_stiffness(&self) -> f64 {
            3e5
        }
    }
    for (time_step, within) in [(1e-5, 0.12), (5e-4, 0.25)] {
        let input = ImpactInput {
            noise: NOISE,
            ..impact(1.0, 3e5, ContactLaw::Rigid, time_step)
        };
        let run = run_on(&input, &mut Noisy { sign: 1.0 });
        for state in &run.states {
            assert!((0.0..=6e5).contains(&state.tangent_stiffness));
            assert!(
                (state.tangent_stiffness / 3e5 - 1.0).abs() < within,
                "{} N/m",
                state.tangent_stiffness
            );
        }
        assert!(
            run.states
                .iter()
                .any(|state| state.tangent_stiffness != 3e5)
        );
    }
}

/// Past yield the tangent is the post-yield stiffness for every time step. At 20 µs no step of some 8 µm exceeds 5 N of noise (10·σ/K0 is
/// 0.17 mm). Single secants would thus keep the initial stiffness to the end.
#[test]
fn the_tangent_follows_a_specimen_that_yields_under_noise() {
    struct Noisy {
        specimen: Bilinear,
        random: Pcg64Mcg,
    }
    impl RestoringForce for Noisy {
        fn move_to(&mut self, displacement: f64) -> f64 {
            // Uniform within ±√3 σ.
            self.specimen.move_to(displacement)
                + 5.0 * 3.0_f64.sqrt() * (2.0 * self.random.random::<f64>() - 1.0)
        }
        fn initial_stiffness(&self) -> f64 {
            3e5
        }
    }
    let followed = |seed| {
        let input = ImpactInput {
            noise: NOISE,
            ..impact(20.0, 3e5, ContactLaw::Rigid, 2e-5)
        };
        let specimen = Bilinear::new(BilinearCurve {
            stiffness: 3e5,
            yield_force: 600.0,
            post_yield_ratio: 0.1,
        });
        let run = run_on(
            &input,
            &mut Noisy {
                specimen,
                random: Pcg64Mcg::seed_from_u64(seed),
            },
        );
        let turn = run
            .states
            .iter()
            .position(|state| state.velocity < 0.0)
            .unwrap_or(run.states.len());
        let yielding = run.states[..turn]
            .iter()
            .filter(|state| state.displacement > 2.2e-3 && state.velocity > 0.1);
        let ratios: Vec<f64> = yielding
            .map(|state| state.tangent_stiffness / 3e5)
            .collect();
        // A line of 21 readings over 0.17 mm has an error of √12·σ/(S√n), 7 % of K0.
        assert!(
            ratios.len() > 100 && ratios.iter().all(|ratio| *ratio < 0.4),
            "seed {seed}"
        );
        #[expect(clippy::cast_precision_loss, reason = "some hundred steps")]
        let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
        assert!(
            (mean - 0.1).abs() < 0.1,
            "seed {seed}: {mean} of K0, 0.1 it is"
        );
        mean
    };
    let mean = (0..20).map(followed).sum::<f64>() / 20.0;
    assert!((mean - 0.1).abs() < 0.02, "{mean} of K0, 0.1 it is");
}

/// A cell with zero drift and noise pushes a light structure in both directions: every step still ends, free or in contact.
#[test]
fn restitution_is_robust_to_a_noisy_cell() {
    struct Rattle {
        random: Pcg64Mcg,
        noise: f64,
        drift: f64,
    }
    impl RestoringForce for Rattle {
        fn move_to(&mut self, displacement: f64) -> f64 {
            K * displacement + self.drift + self.noise * (self.random.random::<f64>() - 0.5)
        }
        fn initial_stiffness(&self) -> f64 {
            K
        }
    }
    for seed in 0..200 {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let mut pick = |values: &[f64]| values[random.random_range(0..values.len())];
        let mass = pick(&[0.01, 0.3, 1.0, 40.0]);
        let law = restitution(pick(&[0.0, 0.2, 0.9, 0.99, 1.0]));
        let input = ImpactInput {
            damping: pick(&[0.0, 1.0, 40.0]),
            gap: pick(&[0.0, 0.01]),
            striker_velocity: pick(&[0.001, 0.1, 1.0]),
            ..impact(mass, K, law, pick(&[1e-2, 1e-3, 1e-4]))
        };
        let mut specimen = Rattle {
            noise: pick(&[0.0, 1.0, 20.0]),
            drift: pick(&[-30.0, 0.0, 5.0]),
            random,
        };
        let run = run_while(&input, &mut specimen, |state| state.time < 1.0);
        for state in &run.states {
            let overlap = state.striker_displacement - state.displacement;
            assert!(
                overlap < 1e-12,
                "seed {seed}, {input:?}: {overlap} m at {} s",
                state.time
            );
            assert!(
                state.contact_force >= 0.0 && state.energies.contact_loss >= 0.0,
                "seed {seed}: {state:?}"
            );
            assert_eq!(
                state.state == StepState::Contact,
                state.contact_force > 0.0,
                "seed {seed}: {state:?}"
            );
        }
    }
}
