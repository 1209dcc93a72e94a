//! Results under the rigid law, whose contacts follow the time step: the stop time jumps when another contact is the last. Compared
//! with the same impact in steps of 0.5 µs.

use crate::tests::testing::{elastic_plan, every, impact, number, run_unwatched};
use psd_physics::contact::Approaching;
use psd_physics::impact::{ImpactInput, Until};
use psd_physics::reintegration::impact::{ImpactValues, integrate};
use psd_physics::reintegration::recorded_path::Reading;
use psd_plan::formula::Formula;
use psd_plan::record::{NamedResult, Record};
use psd_plan::uncertainty::StepInterval;
use psd_plan::{Contact, Impact, Link, Plan, ProcedureKind, VirtualLink};
use psd_testing::plans::ChangeTarget as _;

/// The beam of `plans/beam.psd`.
const STIFFNESS: f64 = 3e5;
const MASS: f64 = 0.73;
const DAMPING: f64 = 6.0;
const STRIKER: f64 = 20.0;

/// Time steps \[s\], from 0.02 to 0.5 ms.
const STEPS: [f64; 17] = [
    2e-5, 2.5e-5, 3e-5, 4e-5, 5e-5, 6.25e-5, 7e-5, 8e-5, 1e-4, 1.25e-4, 1.5e-4, 1.8e-4, 2e-4,
    2.5e-4, 3e-4, 4e-4, 5e-4,
];
const SEEDS: std::ops::RangeInclusive<u64> = 1..=12;

type Read = fn(&ImpactValues) -> f64;

const RESULTS: [(&str, Read); 3] = [
    ("stop_time", |values| values.stop_time),
    ("max_displacement", |values| values.max_displacement),
    ("absorbed_energy", |values| values.absorbed_energy),
];

fn constant(value: f64) -> Formula {
    Formula::Constant(value)
}

fn beam(time_step: f64, contact: Contact, seed: u64) -> Plan {
    let struck = Impact {
        contact,
        stepping: every(time_step),
        duration: constant(0.05),
        ..impact(constant(STIFFNESS))
    }
    .with_point(|point| {
        point.mass = constant(MASS);
        point.damping = constant(DAMPING);
    });
    let mut plan = elastic_plan(STIFFNESS, vec![ProcedureKind::Impact(struck)]);
    plan.strikers[0].mass = STRIKER;
    plan.rig.link = Link::Virtual(VirtualLink {
        noise: 2.0,
        resolution: 1e-6,
        seed,
        ..VirtualLink::default()
    });
    plan
}

/// The same impact without noise, in steps of 0.5 µs.
fn converged() -> ImpactValues {
    let time_step = 5e-7;
    let approaching = Approaching {
        mass: MASS,
        striker_mass: STRIKER,
        velocity: 1.0,
        time_step,
    };
    let input = ImpactInput {
        damping: DAMPING,
        ..ImpactInput::rigid(STIFFNESS, approaching)
    };
    let start = Reading {
        target: 0.0,
        displacement: 0.0,
        force: 0.0,
    };
    let spring = |target: f64, _: f64| (target, STIFFNESS * target);
    integrate(&input, Until::StrikerStop, 100_000, start, spring)
        .unwrap()
        .values
}

fn found<'a>(record: &'a Record, name: &str) -> &'a NamedResult {
    record.procedures[0].result(name).unwrap()
}

/// Half of the width of the interval of a result with U to both sides, and its distance from `exact` in these; None if it is withheld.
fn off(record: &Record, name: &str, exact: f64) -> Option<(f64, f64)> {
    let (value, u) = number(record, 0, name);
    let (value, expanded) = (value.unwrap(), 2.0 * u?);
    let ends =
        StepInterval::of(&found(record, name).contributions).map_or([0.0; 2], |step| step.ends);
    let half = 0.5 * (ends[1] - ends[0]) + expanded;
    let middle = value + 0.5 * (ends[0] + ends[1]);
    Some((half, (middle - exact).abs() / half))
}

/// The converged value lies in the interval that is stated, or none is stated. Where contacts are as many in finer steps, from 0.08 ms on,
/// most results have one.
#[test]
fn the_converged_value_lies_in_the_interval_or_none_is_stated() {
    let exact = converged();
    // As in `docs/method/verification.md`.
    assert!(
        (exact.max_displacement - 7.740e-3).abs() < 5e-7,
        "{exact:?}"
    );
    assert!((exact.stop_time - 12.5e-3).abs() < 5e-5, "{exact:?}");
    let (mut stated, mut fine) = (0, 0);
    for time_step in STEPS {
        for seed in SEEDS {
            let record = run_unwatched(&beam(time_step, Contact::Rigid, seed));
            for (name, read) in RESULTS {
                let Some((half, distance)) = off(&record, name, read(&exact)) else {
                    continue;
                };
                assert!(
                    distance <= 1.0,
                    "{time_step} s, seed {seed}: {name} is off by {distance} of {half}"
                );
                stated += u32::from(time_step <= 8e-5);
            }
            fine += u32::from(time_step <= 8e-5);
        }
    }
    assert!(2 * stated > 3 * fine, "{stated} of {}", 3 * fine);
}

/// At 0.5 ms a run has 3 contacts, and 7 in half of the steps.
#[test]
fn nothing_is_stated_where_finer_steps_have_other_contacts() {
    for seed in SEEDS {
        let record = run_unwatched(&beam(5e-4, Contact::Rigid, seed));
        for (name, _) in RESULTS {
            assert_eq!(number(&record, 0, name).1, None, "seed {seed}: {name}");
        }
        // The energy of the striker does not follow the time step.
        assert_eq!(number(&record, 0, "striker_energy").1, Some(0.0));
    }
}

/// Contacts that are located inside their steps converge: a result has an interval at every step. e = Ms/(Ms + 2M), the limit of the rigid
/// law.
#[test]
fn located_contacts_always_have_an_interval() {
    let exact = converged();
    for time_step in [1e-4, 2e-4, 5e-4] {
        let contact = Contact::Restitution {
            coefficient: constant(STRIKER / (STRIKER + 2.0 * MASS)),
        };
        let record = run_unwatched(&beam(time_step, contact, 1));
        for (name, read) in &RESULTS[1..] {
            let (half, distance) = off(&record, name, read(&exact)).unwrap();
            assert!(
                distance <= 1.0,
                "{time_step} s: {name} is off by {distance} of {half}"
            );
        }
    }
}
