//! Strikers that fall, Ms Ẍs = Ms g − F: compared with the flight of a ball, the pair on a spring and the energy balance.

use psd_physics::contact::ContactLaw;

use psd_physics::contact::state::StepState;
use psd_physics::impact::ImpactInput;
use psd_physics::specimen::Elastic;

use super::support::{impact, run, run_while};

const G: f64 = 9.806_65;
const K: f64 = 2e4;

fn falling(law: ContactLaw, time_step: f64) -> ImpactInput {
    ImpactInput {
        gravity: G,
        ..impact(1.0, K, law, time_step)
    }
}

/// The balance includes the work of the weight, and closes to rounding for every contact law and time step.
#[test]
fn the_work_of_the_weight_closes_the_balance() {
    let laws = [
        ContactLaw::Rigid,
        ContactLaw::Limit { force: 900.0 },
        ContactLaw::Hertz {
            stiffness: 1e7,
            loss: 0.0,
            force_limit: None,
        },
    ];
    for law in laws {
        for time_step in [1e-3, 1e-4] {
            let input = ImpactInput {
                gap: 0.02,
                ..falling(law, time_step)
            };
            let mut specimen = Elastic { stiffness: K };
            let run = run_while(&input, &mut specimen, |state| state.time < 0.3);
            let fallen = run.last().striker_displacement - run.states[0].striker_displacement;
            assert!(
                (run.last().energies.weight - 10.0 * G * fallen).abs() < 1e-12,
                "{law:?}"
            );
            assert!(
                run.worst_error < 2e-11,
                "{law:?} at {time_step} s: {} J",
                run.worst_error
            );
        }
    }
}

/// A plastic impact: the pair vibrates about Ms g/K with the velocity by conservation of momentum,
/// X = `x_s` + √(`x_s`² + v²(M + Ms)/K).
#[test]
fn a_weight_that_sticks_swings_about_its_rest() {
    let at = |time_step: f64| {
        let input = falling(ContactLaw::Restitution { coefficient: 0.0 }, time_step);
        run(&input).summary.max_displacement
    };
    let rest: f64 = 10.0 * G / K;
    let common: f64 = 10.0 / 11.0;
    let exact = rest + (rest * rest + common * common * 11.0 / K).sqrt();
    // The largest X of step ends misses the peak by (ωΔt/2)²/2 of the amplitude at most, and the method is of second order.
    let omega = (K / 11.0).sqrt();
    for time_step in [1e-3, 2.5e-4, 6.25e-5] {
        let error = (at(time_step) - exact).abs();
        let most = 0.2 * (omega * time_step).powi(2) * (exact - rest);
        assert!(
            error < most,
            "{error} m off {exact} m at {time_step} s, {most} m at most"
        );
    }
    // Without its weight it would stop 26 % earlier: the test resolves the difference.
    assert!((common * (11.0 / K).sqrt()) < 0.9 * exact);
}

/// A weight that rebounds falls back: on a structure too heavy to move it returns after 2eⁿv/g with eⁿv.
#[test]
fn a_weight_falls_back_and_strikes_again() {
    let (e, time_step, drop) = (0.6, 1e-4, 0.05);
    let law = ContactLaw::Restitution { coefficient: e };
    let input = ImpactInput {
        mass: 1e7,
        stiffness: 1.0,
        striker_mass: 1.0,
        striker_velocity: 1e-9,
        gap: drop,
        gravity: G,
        ..impact(1.0, 1.0, law, time_step)
    };
    let mut solver = psd_physics::impact::ImpactSolver::new(&input, 0.0, 0.0).expect("an impact");
    let mut impact_times = Vec::new();
    let mut before = StepState::Free;
    while solver.state().time < 0.45 {
        let target = solver.predict();
        let state = *solver.complete(target, target);
        if state.state == StepState::Contact && before == StepState::Free {
            impact_times.push(state.time);
        }
        before = state.state;
    }
    let landing = (2.0 * G * drop).sqrt();
    let mut time = landing / G;
    let mut speed = landing;
    for (index, found) in impact_times.iter().take(4).enumerate() {
        assert!(
            (found - time).abs() < 2.0 * time_step,
            "blow {index} at {found} s, not {time} s"
        );
        speed *= e;
        time += 2.0 * speed / G;
    }
    assert!(impact_times.len() >= 4, "{impact_times:?}");
}

/// Without weight the result is bit-identical.
#[test]
fn nothing_is_added_where_nothing_falls() {
    let input = impact(1.0, K, ContactLaw::Rigid, 1e-3);
    assert!(
        run(&input)
            .states
            .iter()
            .all(|state| state.energies.weight == 0.0)
    );
}
