//! Number of impacts, and the reference energy of relative energy errors, on one degree of freedom and on one storey.

use crate::tests::testing::{elastic_plan, every, impact, number, run_unwatched, struck_frame};
use psd_plan::formula::Formula::Constant;
use psd_plan::record::{History, ImpactStep, Record, StepState};
use psd_plan::{
    Behaviour, Contact, Frame, Impact, Integrator, Move, Plan, Procedure, ProcedureKind, Stepping,
    Storey, Until,
};
use psd_testing::plans::ChangeTarget as _;

/// As heavy as the earth, compared with a striker of 10 kg.
const HEAVY: f64 = 1e9;

/// A striker that falls onto a heavy mass at 1 m/s, alone or as the only storey of a frame.
fn bouncing(contact: &Contact, time_step: f64, framed: bool) -> Plan {
    let mut plan = if framed {
        let mut plan = struck_frame();
        let storey = Storey::new(HEAVY, HEAVY, Behaviour::Elastic { stiffness: HEAVY });
        plan.specimens[0].frame = Some(Frame::of_storeys(vec![storey]));
        let ProcedureKind::Impact(impact) = &mut plan.procedures[0].kind else {
            panic!()
        };
        *impact = Impact {
            contact: contact.clone(),
            stepping: every(time_step),
            duration: Constant(0.5),
            until: Until::Duration,
            ..impact.clone()
        }
        .with_storey(|storey| storey.storey = 0);
        plan
    } else {
        let struck = Impact {
            contact: contact.clone(),
            stepping: every(time_step),
            duration: Constant(0.5),
            until: Until::Duration,
            ..impact(Constant(HEAVY))
        }
        .with_point(|point| point.mass = Constant(HEAVY));
        elastic_plan(HEAVY, vec![ProcedureKind::Impact(struck)])
    };
    plan.strikers[0].gravity = 9.806_65;
    plan
}

fn steps(record: &Record, procedure: usize) -> Vec<ImpactStep> {
    match &record.procedures[procedure].history {
        History::Impact(impact) => impact.steps.iter().collect(),
        other => panic!("{other:?}"),
    }
}

/// Steps in contact that follow a step without contact, or begin the run.
fn runs_in_contact(steps: &[ImpactStep]) -> usize {
    let free = |step: &ImpactStep| step.state == StepState::Free;
    steps
        .windows(2)
        .filter(|pair| free(&pair[0]) && !free(&pair[1]))
        .count()
}

/// After the n-th impact a ball is in flight for 2eⁿu/g. The impacts are followed until this time is a thousandth of a step, however many
/// impacts one step contains.
#[test]
fn impacts_inside_a_step_are_impacts() {
    for coefficient in [0.0, 0.5, 0.7] {
        for time_step in [0.05, 0.01] {
            for framed in [false, true] {
                let contact = Contact::Restitution {
                    coefficient: Constant(coefficient),
                };
                let record = run_unwatched(&bouncing(&contact, time_step, framed));
                let away = |impact: i32| 2.0 * f64::powi(coefficient, impact) / 9.806_65;
                let by_hand = (1..100)
                    .find(|impact| away(*impact) <= 1e-3 * time_step)
                    .unwrap();
                let found = number(&record, 0, "contacts").0.unwrap();
                assert!(
                    (found - f64::from(by_hand)).abs() < 0.5,
                    "e = {coefficient}, {time_step} s: {found}, by hand {by_hand}"
                );
                let runs = runs_in_contact(&steps(&record, 0));
                assert!(
                    coefficient == 0.0 || runs < usize::try_from(by_hand).unwrap() / 2,
                    "{runs} runs of {by_hand}"
                );
            }
        }
    }
}

/// A surface of finite stiffness rebounds the striker elastically: it returns after 2u/g = 0.204 s, and again after the same time. Half a
/// second contains three impacts, also if a step is longer than the flight.
#[test]
fn a_surface_that_closes_inside_a_step_is_struck() {
    let contact = Contact::Hertz {
        stiffness: Constant(1e9),
        loss: Constant(0.0),
        force_limit: None,
    };
    for (time_step, apart) in [(0.01, true), (0.25, false)] {
        for framed in [false, true] {
            let record = run_unwatched(&bouncing(&contact, time_step, framed));
            assert_eq!(number(&record, 0, "contacts").0, Some(3.0), "{time_step} s");
            assert_eq!(
                runs_in_contact(&steps(&record, 0)) == 3,
                apart,
                "{time_step} s"
            );
        }
    }
}

/// Under the step-by-step laws, consecutive steps in contact are one impact.
#[test]
fn consecutive_steps_in_contact_are_one_impact() {
    for contact in [
        Contact::Rigid,
        Contact::Limit {
            force: Constant(300.0),
        },
    ] {
        for integrator in [Integrator::Tangent, Integrator::Explicit] {
            let stepping = Stepping {
                integrator,
                ..every(0.002)
            };
            let struck = Impact {
                contact: contact.clone(),
                stepping: stepping.clone(),
                ..impact(Constant(327.65))
            };
            let alone = run_unwatched(&elastic_plan(327.65, vec![ProcedureKind::Impact(struck)]));
            let mut plan = struck_frame();
            let ProcedureKind::Impact(struck) = &mut plan.procedures[0].kind else {
                panic!()
            };
            (struck.contact, struck.stepping) = (contact.clone(), stepping);
            for record in [alone, run_unwatched(&plan)] {
                let runs = runs_in_contact(&steps(&record, 0));
                assert!(runs > 1, "{contact:?}");
                assert_eq!(
                    number(&record, 0, "contacts").0,
                    u32::try_from(runs).ok().map(f64::from)
                );
            }
        }
    }
}

fn at_a_load(mut plan: Plan, to: f64, time_step: f64) -> Plan {
    plan.strikers[0].mass = 0.01;
    let stepping = Stepping {
        integrator: Integrator::Explicit,
        ..every(time_step)
    };
    match &mut plan.procedures[0].kind {
        ProcedureKind::Impact(impact) => {
            *impact = Impact {
                stepping,
                duration: Constant(1.0),
                until: Until::Duration,
                contact: Contact::Rigid,
                ..impact.clone()
            };
        }
        other => panic!("{other:?}"),
    }
    let away = ProcedureKind::Move(Move {
        to: Constant(to),
        speed: None,
    });
    plan.procedures.insert(
        0,
        Procedure {
            name: "away".to_owned(),
            kind: away,
        },
    );
    plan
}

/// A specimen released from 0.1 m under a striker of 5 mJ vibrates with ½KX₀² = 1.5 J. The error of the explicit scheme is relative to
/// this energy. It oscillates by at most (ωΔt)²/4 of it, and decreases with Δt². Relative to the energy of the striker it would be
/// hundreds.
#[test]
fn errors_are_shares_of_all_that_was_put_in() {
    let stiffness = 300.0;
    let alone = || {
        elastic_plan(
            stiffness,
            vec![ProcedureKind::Impact(impact(Constant(stiffness)))],
        )
    };
    let framed = || {
        let mut plan = struck_frame();
        let storey = Storey::new(1.0, stiffness, Behaviour::Elastic { stiffness });
        plan.specimens[0].frame = Some(Frame::of_storeys(vec![storey]));
        plan.specimens[0].behaviour = Some(Behaviour::Elastic { stiffness });
        let ProcedureKind::Impact(impact) = &mut plan.procedures[0].kind else {
            panic!()
        };
        impact.storey_mut().storey = 0;
        impact.storey_mut().damping = psd_plan::ShakeDamping::Rayleigh(Constant(0.0));
        plan
    };
    for plan in [&alone as &dyn Fn() -> Plan, &framed] {
        for time_step in [0.01, 0.005] {
            let record = run_unwatched(&at_a_load(plan(), 0.1, time_step));
            let input = 0.5 * 0.01 + 0.5 * stiffness * 0.1 * 0.1;
            let last = *steps(&record, 1).last().unwrap();
            let found = number(&record, 1, "energy_error").0.unwrap();
            assert!(
                (found - last.energies.error / input).abs() < 1e-12,
                "{found}"
            );
            let largest = steps(&record, 1)
                .iter()
                .map(|step| (step.energies.error / input).abs())
                .fold(0.0, f64::max);
            let bound = 0.25 * stiffness * time_step * time_step;
            assert!(
                largest > 0.3 * bound && largest < 1.5 * bound,
                "{time_step} s: {largest} of {bound}"
            );
        }
    }
}

/// The work of the weight of a falling striker is also input. If this work is negligible, the input is ½ Ms V0², as in the paper.
#[test]
fn the_work_of_a_weight_is_put_in() {
    let of = |gravity: f64| {
        let struck = Impact {
            stepping: Stepping {
                integrator: Integrator::Explicit,
                ..every(0.01)
            },
            ..impact(Constant(327.65))
        };
        let mut plan = elastic_plan(327.65, vec![ProcedureKind::Impact(struck)]);
        plan.strikers[0].gravity = gravity;
        let record = run_unwatched(&plan);
        let error = steps(&record, 0).last().unwrap().energies.error;
        let weight = steps(&record, 0)
            .iter()
            .map(|step| step.energies.weight)
            .fold(0.0, f64::max);
        (number(&record, 0, "energy_error").0.unwrap(), error, weight)
    };
    let (share, error, weight) = of(0.0);
    assert!(weight == 0.0 && (share - error / 5.0).abs() < 1e-15);
    let (share, error, weight) = of(9.8);
    assert!(
        weight > 10.0 && (share - error / (5.0 + weight)).abs() < 1e-12,
        "{weight} J"
    );
}
