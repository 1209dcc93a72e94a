//! Effect of rounding on holds and on secants. It is compared with replays on rigs that differ in the zero of their quantization grid.

use crate::tests::noise::uniform;
use crate::tests::testing::{elastic_plan, number, ramp, run_unwatched};
use psd_physics::relaxation::law::RelaxationLaw;
use psd_physics::relaxation::time_constant::RelaxationModel;
use psd_plan::formula::Formula;
use psd_plan::record::Record;
use psd_plan::uncertainty::{MeasurementUncertainty, Source, measurement_uncertainty};
use psd_plan::{
    Behaviour, Calibration, Link, Plan, ProcedureKind, StiffnessRamp, VirtualLink, WatchedHold,
    WatchedModel,
};

const STIFFNESS: f64 = 3e5;

fn elastic(stiffness: f64) -> Box<Behaviour> {
    Box::new(Behaviour::Elastic { stiffness })
}

/// Six holds of 8 s, each of 21 readings, `begin` \[m\] from the zero of the grids.
fn holds(behaviour: Behaviour, begin: f64, model: WatchedModel, link: VirtualLink) -> Plan {
    let displacement = |step: u32| Formula::Constant(begin + 2e-4 * f64::from(step));
    let asked = StiffnessRamp {
        displacements: (1..=6).map(displacement).collect(),
        pause: Formula::Constant(8.0),
        relaxation: Some(WatchedHold {
            readings: 20,
            model,
        }),
        ..ramp(1e-4)
    };
    let mut plan = elastic_plan(STIFFNESS, vec![ProcedureKind::StiffnessRamp(asked)]);
    plan.specimens[0].behaviour = Some(behaviour);
    plan.rig.link = Link::Virtual(link);
    plan
}

fn value_and_uncertainty(record: &Record, name: &'static str) -> (f64, MeasurementUncertainty) {
    let result = record.procedures[0].result(name).expect(name);
    (
        number(record, 0, name).0.expect(name),
        measurement_uncertainty(&result.contributions, record)
            .unwrap_or(MeasurementUncertainty::exact(0.0)),
    )
}

/// For every name: root mean square of the errors of `runs`, root mean square of the reported u, and the fraction of errors within U.
fn replayed(
    runs: u32,
    names: &[&'static str],
    link: VirtualLink,
    plan: &dyn Fn(&mut u64, VirtualLink) -> Plan,
) -> Vec<(&'static str, f64, f64, f64)> {
    let (mut state, mut sums) = (31, vec![(0.0, 0.0, 0.0); names.len()]);
    for _ in 0..runs {
        let mut same = state;
        let [found, exact] = [
            run_unwatched(&plan(&mut state, link)),
            run_unwatched(&plan(&mut same, VirtualLink::default())),
        ];
        for (name, sum) in names.iter().zip(&mut sums) {
            let ((value, known), (truth, _)) = (
                value_and_uncertainty(&found, name),
                value_and_uncertainty(&exact, name),
            );
            let error = value - truth;
            sum.0 += error * error;
            sum.1 += known.standard * known.standard;
            sum.2 += f64::from(u8::from(error.abs() <= known.expanded()));
        }
    }
    let count = f64::from(runs);
    let of = |(name, (error, reported, held)): (&&'static str, (f64, f64, f64))| {
        (
            *name,
            (error / count).sqrt(),
            (reported / count).sqrt(),
            held / count,
        )
    };
    names.iter().zip(sums).map(of).collect()
}

/// Each hold loses 20 N: ten quantization steps of the cell.
#[test]
fn replays_of_holds_on_a_coarse_load_cell_are_held() {
    let quantum = 2.0;
    let link = VirtualLink {
        force_resolution: quantum,
        ..VirtualLink::default()
    };
    let cases: [(RelaxationModel, &[&'static str]); 2] = [
        (
            RelaxationModel::Exponential,
            &[
                "time_constant",
                "relaxed_stiffness",
                "remaining_relaxation",
                "required_pause",
            ],
        ),
        (
            RelaxationModel::StandardLinearSolid,
            &[
                "time_constant",
                "relaxed_stiffness",
                "branch_stiffness",
                "remaining_relaxation",
                "required_pause",
            ],
        ),
    ];
    for (model, names) in cases {
        let plan = |state: &mut u64, link: VirtualLink| {
            let of = elastic(STIFFNESS * (0.95 + 0.1 * uniform(state)));
            let (stiffness, time_constant) = (
                1e5 * (0.9 + 0.2 * uniform(state)),
                2.0 + 0.5 * uniform(state),
            );
            let behaviour = Behaviour::Maxwell {
                of,
                stiffness,
                time_constant,
            };
            holds(
                behaviour,
                2e-5 * uniform(state),
                WatchedModel::Decay {
                    model,
                    accuracy: Some(0.5),
                },
                link,
            )
        };
        for (name, error, reported, held) in replayed(40, names, link, &plan) {
            let case = format!(
                "{model:?}, {name} by {quantum} N: {error}, reported {reported}, held {held}"
            );
            assert!(
                held >= 0.9 && reported > 0.75 * error && reported < 6.0 * error,
                "{case}"
            );
        }
    }
}

#[test]
fn replays_of_forces_that_relax_with_the_logarithm_are_held() {
    let model = WatchedModel::Reached {
        law: Some(RelaxationLaw::Logarithmic),
        rate: 0.1,
    };
    let plan = |state: &mut u64, link: VirtualLink| {
        let of = elastic(STIFFNESS * (0.95 + 0.1 * uniform(state)));
        let share = 0.02 * (0.9 + 0.2 * uniform(state));
        let behaviour = Behaviour::Logarithmic {
            of,
            share,
            reference_time: 0.5,
            longest: 1e5,
        };
        holds(behaviour, 2e-5 * uniform(state), model, link)
    };
    let link = VirtualLink {
        force_resolution: 0.7,
        ..VirtualLink::default()
    };
    let names = [
        "relaxation_share",
        "reference_time",
        "relaxation_rate",
        "required_pause",
    ];
    for (name, error, reported, held) in replayed(40, &names, link, &plan) {
        assert!(
            held >= 0.9 && reported > 0.75 * error && reported < 6.0 * error,
            "{name}: {error}, reported {reported}, held {held}"
        );
    }
}

/// The slope of relaxed forces over positions that are read with a finite resolution.
#[test]
fn replays_of_holds_on_a_coarse_transducer_are_held() {
    let link = VirtualLink {
        resolution: 3.1e-5,
        ..VirtualLink::default()
    };
    for model in [
        RelaxationModel::Exponential,
        RelaxationModel::StandardLinearSolid,
    ] {
        let plan = |state: &mut u64, link: VirtualLink| {
            let behaviour = Behaviour::Maxwell {
                of: elastic(STIFFNESS),
                stiffness: 1e5,
                time_constant: 2.0,
            };
            holds(
                behaviour,
                3.1e-5 * uniform(state),
                WatchedModel::Decay {
                    model,
                    accuracy: Some(0.5),
                },
                link,
            )
        };
        let [(_, error, reported, held)] = replayed(60, &["relaxed_stiffness"], link, &plan)[..]
        else {
            panic!()
        };
        assert!(
            held >= 0.9 && reported > 0.75 * error && reported < 6.0 * error,
            "{model:?}: {error}, reported {reported}, held {held}"
        );
    }
}

/// Uncertainty from two readings: noise, rounding and calibration, each alone and together. A rig that declares none of them has no
/// contribution.
#[test]
fn a_secant_is_as_uncertain_as_its_readings() {
    let plan = |state: &mut u64, link: VirtualLink| {
        let asked = StiffnessRamp {
            displacements: (1..=5)
                .map(|step| {
                    Formula::Constant(1e-4 * f64::from(step) * (1.0 + 0.1 * uniform(state)))
                })
                .collect(),
            samples: 4,
            ..ramp(1e-4)
        };
        let mut plan = elastic_plan(
            STIFFNESS * (0.9 + 0.2 * uniform(state)),
            vec![ProcedureKind::StiffnessRamp(asked)],
        );
        plan.rig.link = Link::Virtual(VirtualLink {
            seed: *state >> 33,
            ..link
        });
        plan
    };
    let links = [
        VirtualLink {
            noise: 0.5,
            ..VirtualLink::default()
        },
        VirtualLink {
            force_resolution: 7.0,
            ..VirtualLink::default()
        },
        VirtualLink {
            resolution: 1.7e-5,
            ..VirtualLink::default()
        },
        VirtualLink {
            noise: 1.0,
            force_resolution: 2.0,
            resolution: 5e-6,
            ..VirtualLink::default()
        },
    ];
    for link in links {
        for (name, error, reported, held) in
            replayed(200, &["secant_stiffness", "tangent_stiffness"], link, &plan)
        {
            assert!(
                held >= 0.92 && reported > 0.9 * error && reported < 2.5 * error,
                "{name}, {link:?}: {error}, reported {reported}, held {held}"
            );
        }
    }
    // By hand, with four samples of one reading and one of the other: σ√(1 + ¼)/w.
    let mut noisy = plan(&mut 5, links[0]);
    let travel = 1e-4;
    let ProcedureKind::StiffnessRamp(asked) = &mut noisy.procedures[0].kind else {
        panic!()
    };
    asked.displacements[0] = Formula::Constant(travel);
    noisy.rig.calibration = Calibration {
        force_uncertainty: 0.01,
        ..Calibration::default()
    };
    let record = run_unwatched(&noisy);
    let parts = &record.procedures[0]
        .result("secant_stiffness")
        .unwrap()
        .contributions;
    let of = |wanted: Source| {
        parts
            .iter()
            .find(|part| part.source == wanted)
            .map_or(0.0, |part| part.amount)
    };
    let by_hand = 0.5 * 1.25_f64.sqrt() / travel;
    let of_trials = parts
        .iter()
        .filter(|part| matches!(part.source, Source::Readings { .. }))
        .map(|part| part.amount.powi(2));
    assert!(
        (of_trials.sum::<f64>().sqrt() / by_hand - 1.0).abs() < 3.0 / 128.0_f64.sqrt(),
        "{parts:?}"
    );
    let value = number(&record, 0, "secant_stiffness").0.unwrap();
    assert!(
        (of(Source::ForceScale(0)) / (0.01 * value) - 1.0).abs() < 1e-6,
        "{parts:?}"
    );
    assert_eq!(
        number(
            &run_unwatched(&plan(&mut 5, VirtualLink::default())),
            0,
            "secant_stiffness"
        )
        .1,
        None
    );
}
