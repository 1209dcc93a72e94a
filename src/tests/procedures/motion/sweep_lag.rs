//! Damping sweep on an actuator that lags: c and its U, for any K of the plan.

use crate::tests::testing::{elastic_plan, number, ramp, result_of, run_unwatched};
use psd_plan::formula::Formula;
use psd_plan::record::Record;
use psd_plan::uncertainty::{Source, measurement_uncertainty};
use psd_plan::{
    Behaviour, Breaks, DampingSweep, Link, Move, Plan, ProcedureKind, Settle, VirtualLink,
};

const DAMPING: f64 = 300.0;
const COULOMB: f64 = 10.0;
const STIFFNESS: f64 = 85e3;

fn plan(stiffness: Formula, before: Vec<ProcedureKind>, link: VirtualLink) -> Plan {
    let sweep = DampingSweep {
        specimen: 0,
        velocities: [5e-3, 1e-2, 2e-2, 4e-2, 8e-2]
            .map(Formula::Constant)
            .to_vec(),
        stroke: Formula::Constant(8e-3),
        about: None,
        stiffness,
        rate: None,
    };
    let procedures = before
        .into_iter()
        .chain([ProcedureKind::DampingSweep(sweep)])
        .collect();
    let mut plan = elastic_plan(STIFFNESS, procedures);
    (plan.specimens[0].damping, plan.specimens[0].coulomb) = (DAMPING, COULOMB);
    plan.rig.settle = Settle {
        band: 5e-6,
        force_rate: 20.0,
        dwell: 0.1,
        timeout: 10.0,
    };
    plan.rig.link = Link::Virtual(link);
    plan
}

/// c, and U of it.
fn damping(record: &Record, procedure: usize) -> (f64, f64) {
    let parts = &record.procedures[procedure]
        .result("damping")
        .unwrap()
        .contributions;
    let known = measurement_uncertainty(parts, record).unwrap();
    (
        number(record, procedure, "damping").0.unwrap(),
        known.expanded(),
    )
}

/// The measured positions of the two directions differ by 2vτ. A K that is wrong by 5 kN/m made c wrong by 5 kN/m·τ = 75 N·s/m. On the
/// steady part the piston is within 2e⁻⁵ of the commanded velocity: taken as that velocity, it made c up to 0.5 % too small. The velocity
/// of a first-order lag is exact. What remains is the band of 5 µm within which a stroke may begin: of a lag of 5 mm/s·0.04 s it is 1/40,
/// which decays by e⁻² while the rig settles and by e⁻⁵ until the steady part, to 2 of 100,000.
#[test]
fn a_wrong_stiffness_reaches_no_damping_on_a_rig_that_lags() {
    for lag in [0.0, 2e-3, 5e-3, 15e-3, 40e-3] {
        for stiffness in [60e3, 80e3, 85e3, 110e3] {
            let record = run_unwatched(&plan(
                Formula::Constant(stiffness),
                Vec::new(),
                VirtualLink {
                    lag,
                    ..VirtualLink::default()
                },
            ));
            let (found, _) = damping(&record, 0);
            assert!(
                (found / DAMPING - 1.0).abs() < 2e-5,
                "lag {lag} s, K {stiffness} N/m: {found} N·s/m"
            );
            let coulomb = number(&record, 0, "coulomb_force").0.unwrap();
            assert!(
                (coulomb - COULOMB).abs() < 1e-4,
                "lag {lag} s, K {stiffness} N/m: {coulomb} N"
            );
        }
    }
}

/// With K from the plan's own ramp, with and without lag: U covers c in 93 to 97 of 100 runs.
#[test]
fn noisy_sweeps_are_held_with_and_without_lag() {
    for lag in [0.0, 5e-3, 15e-3] {
        let held = (1..=200).filter(|seed| {
            let link = VirtualLink {
                lag,
                noise: 2.0,
                seed: *seed,
                ..VirtualLink::default()
            };
            let before = vec![ProcedureKind::StiffnessRamp(ramp(5e-4))];
            let (found, expanded) = damping(
                &run_unwatched(&plan(result_of(0, "stiffness"), before, link)),
                1,
            );
            (found - DAMPING).abs() <= expanded
        });
        let held = held.count();
        assert!((186..=194).contains(&held), "lag {lag} s: {held} of 200");
    }
}

/// The stiffness of the passes is a line of the budget if it contributes. Without lag it does not appear.
#[test]
fn the_stiffness_of_the_strokes_is_in_the_budget_of_a_rig_that_lags() {
    for (lag, counts) in [(0.0, false), (15e-3, true)] {
        let link = VirtualLink {
            lag,
            noise: 2.0,
            seed: 1,
            ..VirtualLink::default()
        };
        let record = run_unwatched(&plan(Formula::Constant(80e3), Vec::new(), link));
        let parts = &record.procedures[0]
            .result("damping")
            .unwrap()
            .contributions;
        let of_strokes = parts
            .iter()
            .find(|part| matches!(part.source, Source::StrokeStiffness { .. }));
        assert_eq!(
            of_strokes.is_some_and(|part| part.amount.abs() > 1e-6),
            counts,
            "lag {lag} s: {parts:?}"
        );
    }
}

/// A broken specimen has no stiffness and no damping ratio. Rounding does not count as stiffness, at the scale of micrometres or of
/// metres.
#[test]
fn strokes_without_stiffness_have_no_damping_ratio() {
    for scale in [1.0, 1e-6] {
        let sweep = DampingSweep {
            specimen: 0,
            velocities: [0.01, 0.02, 0.05]
                .map(|velocity| Formula::Constant(velocity * scale))
                .to_vec(),
            stroke: Formula::Constant(2e-3 * scale),
            about: Some(Formula::Constant(0.033 * scale)),
            stiffness: Formula::Constant(40e3),
            rate: None,
        };
        let broken = Move {
            to: Formula::Constant(0.033 * scale),
            speed: None,
        };
        let mut plan = elastic_plan(
            1.0,
            vec![
                ProcedureKind::Move(broken),
                ProcedureKind::DampingSweep(sweep),
            ],
        );
        let of = Box::new(Behaviour::Elastic { stiffness: 40e3 });
        plan.specimens[0].behaviour = Some(Behaviour::Fracture {
            of,
            at: Breaks::Displacement(0.017 * scale),
        });
        plan.specimens[0].damping = 30.0;
        let record = run_unwatched(&plan);
        assert_eq!(number(&record, 1, "damping_ratio").0, None, "scale {scale}");
        assert!((number(&record, 1, "damping").0.unwrap() / 30.0 - 1.0).abs() < 1e-6);
        assert!(
            record
                .events
                .iter()
                .any(|event| event.text.contains("show no stiffness")),
            "{:?}",
            record.events
        );
    }
}
