//! An impact on one floor: one storey equals one degree of freedom; many close their energy balance and converge to closed forms.

use psd_physics::contact::ContactLaw;
use psd_physics::contact::NeedsTangent;
use psd_physics::impact::{FrameImpactSolver, ImpactError, ImpactInput, ImpactSetup, ImpactState};
use psd_physics::integrator::input::FrameInput;
use psd_physics::integrator::tangents::Tangents;
use psd_physics::structure::{FrameMatrices, SymmetricBand, storey_stiffness};
use psd_plan::Integrator;

use super::super::support::{impact, run};
use super::support::{at, uniform};

const RIGID: ContactLaw = ContactLaw::Rigid;
const LIMIT: ContactLaw = ContactLaw::Limit { force: 1500.0 };

/// A run to its end on an ideal linear frame: the ends of its steps, the solver as it ended, the largest error of the energy
/// balance.
fn strike(input: &Struck) -> (Vec<ImpactState>, FrameImpactSolver, f64) {
    let order = input.frame.matrices.order();
    let mut solver = FrameImpactSolver::on(&input.frame, &input.setup).expect("an impact");
    let mut force = vec![0.0; order];
    let (mut states, mut worst) = (vec![*solver.state()], 0.0_f64);
    while !solver.finished() && solver.structure().time < 10.0 {
        let target = solver.predict().to_vec();
        input.frame.matrices.stiffness.mul_into(&target, &mut force);
        let state = solver.complete(&target, &force);
        states.push(*state);
        worst = worst.max(state.energies.error.abs());
    }
    (states, solver, worst)
}

/// A frame and its striker.
struct Struck<'a> {
    frame: FrameInput<'a>,
    setup: ImpactSetup,
}

fn impact_on(frame: FrameInput, struck: usize, law: ContactLaw) -> Struck {
    Struck {
        frame,
        setup: ImpactSetup {
            struck,
            mass: 10.0,
            velocity: 1.0,
            gap: 0.0,
            gravity: 0.0,
            law,
        },
    }
}

fn single(mass: f64, stiffness: f64) -> FrameMatrices {
    FrameMatrices {
        mass: SymmetricBand::diagonal(&[mass]),
        damping: SymmetricBand::zero(1, 0),
        stiffness: storey_stiffness(&[stiffness]),
        gravity: None,
    }
}

/// Every number of every step of both is bit-identical for every contact law and integrator. This includes a damper and a weight that
/// falls before the impact.
#[test]
fn one_floor_is_one_degree_of_freedom() {
    let hertz = |loss, force_limit| ContactLaw::Hertz {
        stiffness: 4e6,
        loss,
        force_limit,
    };
    let bounce = |coefficient| ContactLaw::Restitution { coefficient };
    let paper = [RIGID, LIMIT];
    let tangent = [
        hertz(0.0, None),
        hertz(0.1, None),
        hertz(0.0, Some(900.0)),
        bounce(0.0),
        bounce(0.6),
        bounce(1.0),
    ];
    let all = [
        Integrator::Tangent,
        Integrator::Explicit,
        Integrator::AlphaOs { alpha: 0.0 },
        Integrator::AlphaOs { alpha: -0.1 },
    ];
    let impulses = all
        .iter()
        .flat_map(|integrator| paper.map(|law| (*integrator, law)));
    for (integrator, law) in impulses.chain(tangent.map(|law| (Integrator::Tangent, law))) {
        for (damping, gravity, gap) in [(0.0, 0.0, 0.0), (6.0, 0.0, 2e-3), (6.0, 9.81, 2e-3)] {
            let (mass, stiffness, time_step) = (1.0, 327.65, 1e-3);
            let frame = FrameMatrices {
                damping: SymmetricBand::diagonal(&[damping]),
                ..single(mass, stiffness)
            };
            let one = run(&ImpactInput {
                damping,
                gravity,
                gap,
                integrator,
                ..impact(mass, stiffness, law, time_step)
            });
            let tangents = Tangents::Storeys { largest_ratio: 2.0 };
            let input = impact_on(
                FrameInput {
                    tangents,
                    ..at(&frame, integrator, time_step, &[0.0])
                },
                0,
                law,
            );
            let (states, _, worst) = strike(&Struck {
                setup: ImpactSetup {
                    gravity,
                    gap,
                    ..input.setup
                },
                ..input
            });
            assert_eq!(
                states, one.states,
                "{law:?} {integrator:?}, {damping} N·s/m, {gravity} m/s²"
            );
            assert!(
                worst < 1e-9 || integrator != Integrator::Tangent,
                "{law:?}: {worst} J"
            );
        }
    }
}

/// A first impact dissipates ½(1 − e²)μu², with μ from the mass of the struck floor only.
#[test]
fn an_impact_on_one_floor_meets_the_mass_of_that_floor() {
    let frame = uniform(5, 4.0, 3e4);
    for (law, e) in [
        (RIGID, 10.0 / (10.0 + 2.0 * 4.0)),
        (ContactLaw::Restitution { coefficient: 0.3 }, 0.3),
        (ContactLaw::Restitution { coefficient: 1.0 }, 1.0),
    ] {
        let input = impact_on(at(&frame, Integrator::Tangent, 1e-7, &[0.0; 5]), 2, law);
        let mut solver = FrameImpactSolver::on(&input.frame, &input.setup).expect("an impact");
        for _ in 0..2 {
            let target = solver.predict().to_vec();
            let mut force = [0.0; 5];
            frame.stiffness.mul_into(&target, &mut force);
            solver.complete(&target, &force);
        }
        let reduced_mass = 40.0 / 14.0;
        let (striker, floor) = (solver.state(), solver.structure().velocity[2]);
        let common = 10.0 / 14.0;
        assert!(
            (striker.striker_velocity - (common - e * 4.0 / 14.0)).abs() < 1e-6,
            "{law:?}: {}",
            striker.striker_velocity
        );
        assert!(
            (floor - (common + e * 10.0 / 14.0)).abs() < 1e-6,
            "{law:?}: {floor}"
        );
        let lost = 0.5 * (1.0 - e * e) * reduced_mass;
        assert!(
            (striker.energies.contact_loss - lost).abs() < 1e-6,
            "{law:?}: {} is not {lost}",
            striker.energies.contact_loss
        );
    }
}

/// The same impact by every integrator, and its energy.
#[test]
fn every_integrator_converges_to_the_same_impact() {
    let frame = uniform(3, 4.0, 3e4);
    for law in [RIGID, ContactLaw::Limit { force: 800.0 }] {
        let peak = |integrator, time_step| {
            let (states, _, worst) = strike(&impact_on(
                at(&frame, integrator, time_step, &[0.0; 3]),
                1,
                law,
            ));
            (
                states
                    .into_iter()
                    .map(|state| state.displacement)
                    .fold(0.0, f64::max),
                worst,
            )
        };
        let (reference, error) = peak(Integrator::Tangent, 2e-6);
        assert!(error < 1e-11, "{error} J");
        let others = [
            Integrator::Explicit,
            Integrator::AlphaOs { alpha: 0.0 },
            Integrator::AlphaOs { alpha: -0.1 },
        ];
        for integrator in others {
            let (found, error) = peak(integrator, 2e-6);
            assert!(
                (found - reference).abs() < 2e-4 * reference,
                "{law:?} {integrator:?}: {found} is not {reference}"
            );
            assert!(error < 1e-2, "{law:?} {integrator:?}: {error} J of 5 J");
        }
        // α-OS with K_I = K is the tangent form on a linear frame.
        let (coarse, error) = peak(Integrator::AlphaOs { alpha: 0.0 }, 1e-3);
        assert!(
            (coarse - peak(Integrator::Tangent, 1e-3).0).abs() < 1e-13,
            "{coarse}"
        );
        assert!(error < 1e-11, "{error} J");
    }
}

#[test]
fn what_is_no_impact_on_a_frame_is_refused() {
    let frame = uniform(2, 4.0, 3e4);
    let refused = |integrator, struck, law| {
        let input = impact_on(at(&frame, integrator, 1e-3, &[0.0; 2]), struck, law);
        FrameImpactSolver::on(&input.frame, &input.setup).expect_err("no impact")
    };
    let hertz = ContactLaw::Hertz {
        stiffness: 1e8,
        loss: 0.0,
        force_limit: None,
    };
    assert_eq!(
        refused(Integrator::Tangent, 2, RIGID),
        ImpactError::NoSuchDegreeOfFreedom {
            struck: 2,
            order: 2
        }
    );
    assert_eq!(
        refused(Integrator::AlphaOs { alpha: 0.0 }, 0, hertz),
        ImpactError::Contact(NeedsTangent("hertz"))
    );
    let bounce = ContactLaw::Restitution { coefficient: 0.5 };
    assert_eq!(
        refused(Integrator::Explicit, 0, bounce),
        ImpactError::Contact(NeedsTangent("restitution"))
    );
}
