//! A client that drives every floor of a frame simultaneously, over loopback.

use super::tests::{Element, LIMITS, served_on};
use super::*;
use psd_physics::integrator::input::FrameInput;
use psd_physics::integrator::solver::FrameSolver;
use psd_physics::integrator::tangents::Tangents;
use psd_physics::structure::{FrameMatrices, SymmetricBand};
use psd_plan::{Behaviour, Frame, Integrator, Limits, Settle, Storey, VirtualLink};
use psd_rig::VirtualRig;

const MASSES: [f64; 2] = [2000.0, 1500.0];

fn frame() -> Frame {
    let storey = |(mass, stiffness)| Storey::new(mass, stiffness, Behaviour::Elastic { stiffness });
    Frame::of_storeys(MASSES.into_iter().zip([3e6, 2e6]).map(storey).collect())
}

fn served<T: Send>(limits: Limits, client: impl FnOnce(SocketAddr) -> T + Send) -> (T, Session) {
    let settle = Settle {
        band: 0.0,
        force_rate: 0.0,
        dwell: 0.0,
        timeout: 60.0,
    };
    let mut rig = VirtualRig::of_frame(VirtualLink::default(), settle, &frame(), 1.0);
    let protocol = Protocol::GenericClient {
        stiffness: frame().stiffness.concat(),
    };
    served_on(&mut rig, &protocol, limits, client)
}

/// The values of OpenSees for two degrees of freedom.
const TWO: [i32; 11] = [2, 2, 2, 0, 1, 0, 0, 0, 2, 0, 256];

/// Explicit Newmark of the client under a ground motion, compared with psd's own: equal displacements except for rounding
/// errors.
#[test]
fn an_explicit_newmark_of_the_client_is_that_of_psd() {
    const STEP: f64 = 2e-3;
    let ground = |step: u32| (0.05 * f64::from(step)).sin();
    let matrices = FrameMatrices {
        mass: SymmetricBand::diagonal(&MASSES),
        damping: SymmetricBand::zero(2, 0),
        stiffness: SymmetricBand::from_dense(&frame().stiffness).unwrap(),
        gravity: None,
    };
    let zero = [0.0; 2];
    let mut own = FrameSolver::new(&FrameInput {
        elements: None,
        matrices: &matrices,
        operator_stiffness: &matrices.stiffness,
        integrator: Integrator::Explicit,
        i_modification: false,
        tangents: Tangents::Initial,
        time_step: STEP,
        initial_displacement: &zero,
        initial_restoring_force: &zero,
        initial_load: &zero,
        readings: &[],
    })
    .unwrap();
    let (found, session) = served(LIMITS, |address| {
        let mut element = Element::connect(address, TWO);
        let (mut d, mut v, mut a, mut found) = ([0.0_f64; 2], [0.0; 2], [0.0; 2], Vec::new());
        for step in 1..=200 {
            for i in 0..2 {
                d[i] += STEP * v[i] + 0.5 * STEP * STEP * a[i];
            }
            element.send(&[
                3.0,
                d[0],
                d[1],
                v[0],
                v[1],
                a[0],
                a[1],
                STEP * f64::from(step),
            ]);
            let force = element.ask(10.0);
            element.send(&[5.0]);
            for i in 0..2 {
                let next = -ground(step) - force[i] / MASSES[i];
                v[i] += 0.5 * STEP * (a[i] + next);
                a[i] = next;
            }
            found.push(d);
        }
        element.send(&[99.0]);
        found
    });
    assert_eq!(session.ended, Ended::Closed);
    // The first of its targets is the present position of the frame: it causes no motion.
    assert_eq!(session.driven.targets, 199);
    let (mut load, mut force, mut largest) = ([0.0; 2], [0.0; 2], 0.0_f64);
    for (step, found) in (1..).zip(&found) {
        matrices.ground_load(ground(step), &mut load);
        let target = own.predict(&load).to_vec();
        matrices.stiffness.mul_into(&target, &mut force);
        let state = own.complete(&target, &force);
        for i in 0..2 {
            assert!(
                (state.displacement[i] - found[i]).abs() < 1e-15,
                "step {step}: {:?}, {found:?}",
                state.displacement
            );
            largest = largest.max(found[i].abs());
        }
    }
    assert!(
        largest > 3e-3 && session.driven.displacement == largest,
        "{largest} m"
    );
}

#[test]
fn a_vector_is_answered_by_a_vector_and_a_stiffness_by_a_matrix() {
    let (answers, session) = served(LIMITS, |address| {
        let mut element = Element::connect(address, [2, 0, 0, 0, 0, 2, 2, 2, 2, 1, 9]);
        element.send(&[3.0, 0.001, 0.003]);
        let answers = [6.0, 7.0, 10.0, 12.0, 14.0, 8.0].map(|action| element.ask(action));
        element.send(&[99.0]);
        answers
    });
    // V₂ = 2 MN/m · 2 mm, V₁ = 3 MN/m · 1 mm; the longer move of 3 mm takes 3 s.
    let near = |found: &[f64], expected: &[f64]| {
        let padded = expected.iter().chain(std::iter::repeat(&0.0));
        for (found, expected) in found.iter().zip(padded) {
            assert!((found - expected).abs() < 1e-9, "{found} is not {expected}");
        }
    };
    near(
        &answers[0],
        &[0.001, 0.003, 0.0, 0.0, 0.0, 0.0, -1000.0, 4000.0, 3.0],
    );
    near(&answers[1], &[0.001, 0.003]);
    near(&answers[2], &[-1000.0, 4000.0]);
    near(&answers[3], &[5e6, -2e6, -2e6, 2e6]);
    near(&answers[4], &[]);
    near(&answers[5], &[]);
    assert_eq!(session.ended, Ended::Closed);
}

/// If a limit refuses the target of one floor, no floor moves. If the force of one floor exceeds its limit, the session ends.
#[test]
fn an_obstacle_to_one_floor_stops_all_floors() {
    for targets in [[0.001, 0.021], [0.021, 0.001], [0.001, f64::NAN]] {
        let (force, session) = served(LIMITS, |address| {
            let mut element = Element::connect(address, TWO);
            element.send(&[3.0, targets[0], targets[1]]);
            let force = element.ask(10.0)[0];
            element.send(&[99.0]);
            force
        });
        assert!(
            force.is_nan() && matches!(session.ended, Ended::Limit(_)),
            "{session:?}"
        );
        assert_eq!(
            session.driven,
            Driven {
                refused: 1,
                ..Driven::default()
            }
        );
    }
}

#[test]
fn a_client_of_another_size_and_one_whose_messages_are_too_short_are_sent_away() {
    let ended = |header: [i32; 11], action: f64| {
        let client = |address| {
            let mut element = Element::connect(address, header);
            element.send(&[action]);
            element.is_closed()
        };
        let (closed, session) = served(LIMITS, client);
        assert!(closed);
        match session.ended {
            Ended::Misspoken(reason) => reason,
            other => panic!("{other:?}"),
        }
    };
    assert!(
        ended([1, 1, 1, 0, 1, 0, 0, 0, 1, 0, 256], 10.0)
            .contains("1 degrees of freedom; this rig has 2")
    );
    assert!(
        ended([2, 0, 0, 0, 0, 0, 0, 0, 2, 0, 3], 12.0)
            .contains("3 words are too short for an answer of 4")
    );
}
