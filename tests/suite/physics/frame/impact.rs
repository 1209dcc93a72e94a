//! A blow on one floor: one degree of freedom is the impact of old, many close their energy and tend to what mechanics says.

use psd::mechanics::contact::ContactLaw;
use psd::mechanics::frame::impact::{FrameImpactError, FrameImpactInput, FrameImpactSolver};
use psd::mechanics::frame::{FrameInput, FrameMatrices, SymmetricBand, Tangents, storey_stiffness};
use psd::mechanics::impact::ImpactInput;
use psd::plan::Integrator;

use super::super::support::{Run, impact, run};
use super::support::{at, uniform};

const RIGID: ContactLaw = ContactLaw::Rigid;
const LIMIT: ContactLaw = ContactLaw::Limit { force: 1500.0 };

/// A run to its end on an ideal linear frame: displacements of the struck floor, the solver as it ended, the largest error of
/// the energy balance.
fn strike(input: &FrameImpactInput) -> (Vec<f64>, FrameImpactSolver, f64) {
    let order = input.frame.matrices.order();
    let mut solver = FrameImpactSolver::new(input).expect("an impact");
    let (mut force, load) = (vec![0.0; order], vec![0.0; order]);
    let (mut places, mut worst) = (vec![0.0], 0.0_f64);
    while !solver.finished() && solver.frame().time < 10.0 {
        let target = solver.predict(&load).to_vec();
        input.frame.matrices.stiffness.mul_into(&target, &mut force);
        let (frame, striker) = solver.complete(&target, &force);
        places.push(frame.displacement[input.struck]);
        worst = worst.max(striker.energies.error.abs());
    }
    (places, solver, worst)
}

fn blow(frame: FrameInput, struck: usize, law: ContactLaw) -> FrameImpactInput {
    FrameImpactInput { frame, struck, striker_mass: 10.0, striker_velocity: 1.0, gap: 0.0, gravity: 0.0, law }
}

fn single(mass: f64, stiffness: f64) -> FrameMatrices {
    FrameMatrices {
        mass: SymmetricBand::diagonal(&[mass]),
        damping: SymmetricBand::zero(1, 0),
        stiffness: storey_stiffness(&[stiffness]),
    }
}

/// Every step of both, to rounding: the factor of one degree of freedom is a division, but ½Ms enters by another line.
#[test]
fn one_degree_of_freedom_is_the_impact_of_old_to_rounding() {
    for (law, mass, stiffness, time_step) in
        [(RIGID, 1.0, 327.65, 0.01), (RIGID, 1.0, 327.65, 0.001), (RIGID, 0.25, 327.65, 0.01), (LIMIT, 1.0, 300.0, 0.001)]
    {
        let frame = single(mass, stiffness);
        let old: Run = run(&impact(mass, stiffness, law, time_step));
        let tangents = Tangents::Storeys { largest_ratio: 2.0 };
        let input = blow(FrameInput { tangents, ..at(&frame, Integrator::Tangent, time_step, &[0.0]) }, 0, law);
        let (places, solver, worst) = strike(&input);
        assert_eq!(places.len(), old.states.len());
        for (place, state) in places.iter().zip(&old.states) {
            assert!((place - state.displacement).abs() < 1e-14, "{law:?} {mass} kg at {}: {place}, {state:?}", state.time);
        }
        let (new, old) = (solver.striker(), old.last());
        assert_eq!((new.state, solver.frame().step), (old.state, old.step));
        for (new, old) in [
            (new.velocity, old.striker_velocity),
            (new.displacement, old.striker_displacement),
            (new.indentation, old.indentation),
            (new.energies.contact_loss, old.energies.contact_loss),
            (new.energies.indentation, old.energies.indentation),
            (new.energies.restoring, old.energies.restoring),
            (new.energies.structure, old.energies.structure),
        ] {
            assert!((new - old).abs() < 1e-12, "{law:?}: {new} is not {old}");
        }
        assert!(worst < 1e-12, "{worst} J");
    }
}

/// Laws that act inside a step, with a weight that falls a way before it strikes and a damper: every step of both. Where
/// two searches halve an interval to the resolution of a double, their instants differ by some of it.
#[test]
fn one_degree_of_freedom_is_the_impact_of_old_under_every_law() {
    let hertz = |loss, force_limit| ContactLaw::Hertz { stiffness: 4e6, loss, force_limit };
    let bounce = |coefficient| ContactLaw::Restitution { coefficient };
    let laws = [RIGID, LIMIT, hertz(0.0, None), hertz(0.1, None), hertz(0.0, Some(900.0)), bounce(0.0), bounce(0.6), bounce(1.0)];
    for law in laws {
        for (damping, gravity, gap) in [(0.0, 0.0, 0.0), (6.0, 0.0, 2e-3), (6.0, 9.81, 2e-3)] {
            let (mass, stiffness, time_step) = (1.0, 327.65, 1e-3);
            let frame = FrameMatrices { damping: SymmetricBand::diagonal(&[damping]), ..single(mass, stiffness) };
            let old = run(&ImpactInput { damping, gravity, gap, ..impact(mass, stiffness, law, time_step) });
            let input = blow(at(&frame, Integrator::Tangent, time_step, &[0.0]), 0, law);
            let (places, solver, _) = strike(&FrameImpactInput { gravity, gap, ..input });
            assert_eq!(places.len(), old.states.len(), "{law:?}, {gravity} m/s²");
            for (place, state) in places.iter().zip(&old.states) {
                let difference = (place - state.displacement).abs();
                assert!(difference < 1e-11, "{law:?} {damping} {gravity} at {}: {difference}", state.time);
            }
            let (new, old) = (solver.striker(), old.last());
            assert_eq!((new.state, solver.frame().step), (old.state, old.step), "{law:?}");
            for (new, old) in [
                (new.velocity, old.striker_velocity),
                (new.displacement, old.striker_displacement),
                (new.indentation, old.indentation),
                (new.energies.contact_loss, old.energies.contact_loss),
                (new.energies.indentation, old.energies.indentation),
                (new.energies.weight, old.energies.weight),
                (new.energies.damping, old.energies.damping),
                (new.energies.restoring, old.energies.restoring),
                (new.energies.structure, old.energies.structure),
                (new.energies.error, old.energies.error),
            ] {
                assert!((new - old).abs() < 1e-9, "{law:?} {gravity}: {new} is not {old}");
            }
        }
    }
}

/// A first blow takes ½(1 − e²)μu² with μ of the struck floor's own mass, whatever stands on it.
#[test]
fn a_blow_on_one_floor_meets_that_floor_s_mass() {
    let frame = uniform(5, 4.0, 3e4);
    for (law, e) in [
        (RIGID, 10.0 / (10.0 + 2.0 * 4.0)),
        (ContactLaw::Restitution { coefficient: 0.3 }, 0.3),
        (ContactLaw::Restitution { coefficient: 1.0 }, 1.0),
    ] {
        let input = blow(at(&frame, Integrator::Tangent, 1e-7, &[0.0; 5]), 2, law);
        let mut solver = FrameImpactSolver::new(&input).expect("an impact");
        for _ in 0..2 {
            let target = solver.predict(&[0.0; 5]).to_vec();
            let mut force = [0.0; 5];
            frame.stiffness.mul_into(&target, &mut force);
            solver.complete(&target, &force);
        }
        let reduced_mass = 40.0 / 14.0;
        let (striker, floor) = (solver.striker(), solver.frame().velocity[2]);
        let common = 10.0 / 14.0;
        assert!((striker.velocity - (common - e * 4.0 / 14.0)).abs() < 1e-6, "{law:?}: {}", striker.velocity);
        assert!((floor - (common + e * 10.0 / 14.0)).abs() < 1e-6, "{law:?}: {floor}");
        let lost = 0.5 * (1.0 - e * e) * reduced_mass;
        assert!((striker.energies.contact_loss - lost).abs() < 1e-6, "{law:?}: {} is not {lost}", striker.energies.contact_loss);
    }
}

/// The same blow through every integrator, and its energy.
#[test]
fn every_integrator_tends_to_the_same_blow() {
    let frame = uniform(3, 4.0, 3e4);
    for law in [RIGID, ContactLaw::Limit { force: 800.0 }] {
        let peak = |integrator, time_step| {
            let (places, _, worst) = strike(&blow(at(&frame, integrator, time_step, &[0.0; 3]), 1, law));
            (places.into_iter().fold(0.0, f64::max), worst)
        };
        let (reference, error) = peak(Integrator::Tangent, 2e-6);
        assert!(error < 1e-11, "{error} J");
        let others = [Integrator::Explicit, Integrator::AlphaOs { alpha: 0.0 }, Integrator::AlphaOs { alpha: -0.1 }];
        for integrator in others {
            let (found, error) = peak(integrator, 2e-6);
            assert!((found - reference).abs() < 2e-4 * reference, "{law:?} {integrator:?}: {found} is not {reference}");
            assert!(error < 1e-2, "{law:?} {integrator:?}: {error} J of 5 J");
        }
        // α-OS with K_I = K is the tangent form on a linear frame.
        let (coarse, error) = peak(Integrator::AlphaOs { alpha: 0.0 }, 1e-3);
        assert!((coarse - peak(Integrator::Tangent, 1e-3).0).abs() < 1e-13, "{coarse}");
        assert!(error < 1e-11, "{error} J");
    }
}

#[test]
fn what_is_no_impact_on_a_frame_is_refused() {
    let frame = uniform(2, 4.0, 3e4);
    let refused = |integrator, struck, law| {
        let input = blow(at(&frame, integrator, 1e-3, &[0.0; 2]), struck, law);
        FrameImpactSolver::new(&input).expect_err("no impact")
    };
    let hertz = ContactLaw::Hertz { stiffness: 1e8, loss: 0.0, force_limit: None };
    assert_eq!(refused(Integrator::Tangent, 2, RIGID), FrameImpactError::NoSuchPlace { struck: 2, order: 2 });
    assert_eq!(refused(Integrator::AlphaOs { alpha: 0.0 }, 0, hertz), FrameImpactError::NeedsTangent("hertz"));
    let bounce = ContactLaw::Restitution { coefficient: 0.5 };
    assert_eq!(refused(Integrator::Explicit, 0, bounce), FrameImpactError::NeedsTangent("restitution"));
}
