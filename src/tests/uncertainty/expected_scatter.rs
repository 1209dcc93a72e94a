//! Standard uncertainties of fits as predicted by a simulation, compared with those of runs with other noise.

use crate::tests::testing::{elastic_plan, number, ramp, run_unwatched};
use psd_physics::identification::multilinear_fit::BreakCount;
use psd_physics::relaxation::time_constant::RelaxationModel;
use psd_plan::formula::Formula;
use psd_plan::record::History;
use psd_plan::{
    Behaviour, Cycle, DampingSweep, Level, Link, Plan, ProcedureKind, RampFit, Sides,
    StiffnessRamp, VirtualLink, WatchedHold, WatchedModel,
};

const STIFFNESS: f64 = 3e5;

fn constant(value: f64) -> Formula {
    Formula::Constant(value)
}

/// The mean of u² of `runs` runs over the predicted u² of the result.
fn ratio(plan: &Plan, link: VirtualLink, name: &str, runs: u32) -> f64 {
    let with = |seed: u64| {
        let mut plan = plan.clone();
        plan.rig.link = Link::Virtual(VirtualLink { seed, ..link });
        plan
    };
    let predicted = number(&run_unwatched(&with(1).on_an_ideal_rig()), 0, name)
        .1
        .expect("predicted");
    let square = |seed: u32| {
        number(&run_unwatched(&with(u64::from(seed) + 1)), 0, name)
            .1
            .expect("reported")
            .powi(2)
    };
    (0..runs).map(square).sum::<f64>() / f64::from(runs) / (predicted * predicted)
}

/// s² of ν degrees of freedom over N runs has the standard deviation √(2/(Nν)) of σ². The limit is four of these, plus `curved` for a
/// non-linear fit.
fn assert_predicted(
    plan: &Plan,
    link: VirtualLink,
    names: &[&str],
    (runs, degrees, curved): (u32, f64, f64),
) {
    for name in names {
        let found = ratio(plan, link, name, runs);
        let within = 4.0 * (2.0 / (f64::from(runs) * degrees)).sqrt() + curved;
        assert!(
            (found - 1.0).abs() < within,
            "{name}: u² of runs is {found} of what is predicted, within {within}"
        );
    }
}

fn ramp_plan(plan: StiffnessRamp) -> Plan {
    elastic_plan(STIFFNESS, vec![ProcedureKind::StiffnessRamp(plan)])
}

const NOISY: VirtualLink = VirtualLink {
    noise: 2.0,
    resolution: 0.0,
    force_resolution: 0.0,
    lag: 0.0,
    tracking: 0.0,
    drift: 0.0,
    seed: 1,
    predicted: None,
};

/// Ten points, twice over, of three samples each.
#[test]
fn the_line_of_a_ramp_is_predicted() {
    let plan = ramp_plan(StiffnessRamp {
        samples: 3,
        repeats: 2,
        ..ramp(1e-4)
    });
    assert_predicted(
        &plan,
        NOISY,
        &["stiffness", "intercept_force"],
        (100, 18.0, 0.0),
    );
    // By hand: σ/√3 over √Sxx.
    let squares: f64 = 2.0
        * (1..=10)
            .map(|step| (1e-4 * (f64::from(step) - 5.5)).powi(2))
            .sum::<f64>();
    let mut noisy = plan.clone();
    noisy.rig.link = Link::Virtual(NOISY);
    let predicted = number(&run_unwatched(&noisy.on_an_ideal_rig()), 0, "stiffness")
        .1
        .unwrap();
    assert!(
        (predicted / (2.0 / 3.0_f64.sqrt() / squares.sqrt()) - 1.0).abs() < 1e-9,
        "{predicted}"
    );
    // Quantization of force and displacement, with noise and without: its scatter is not normally distributed.
    let rounded = VirtualLink {
        force_resolution: 5.0,
        resolution: 1.3e-5,
        ..NOISY
    };
    assert_predicted(&plan, rounded, &["stiffness"], (100, 18.0, 0.1));
    let quiet = VirtualLink {
        noise: 0.0,
        force_resolution: 7.3,
        ..NOISY
    };
    assert_predicted(&plan, quiet, &["stiffness"], (1, 1e9, 0.35));
    // An ideal rig has no scatter to predict.
    assert!(
        number(&run_unwatched(&plan.on_an_ideal_rig()), 0, "stiffness")
            .1
            .unwrap()
            < 1e-6
    );
}

#[test]
fn both_lines_of_a_ramp_past_yield_are_predicted() {
    let displacements = (1..=24)
        .map(|step| constant(1e-4 * f64::from(step)))
        .collect();
    let mut plan = ramp_plan(StiffnessRamp {
        displacements,
        fit: RampFit::Bilinear,
        ..ramp(1e-4)
    });
    plan.specimens[0].behaviour = Some(Behaviour::Bilinear {
        stiffness: STIFFNESS,
        yield_force: 400.0,
        post_yield_ratio: 0.2,
    });
    let names = [
        "stiffness",
        "yield_force",
        "yield_displacement",
        "post_yield_stiffness",
        "post_yield_ratio",
    ];
    assert_predicted(&plan, NOISY, &names, (60, 20.0, 0.03));
    let ProcedureKind::StiffnessRamp(asked) = &mut plan.procedures[0].kind else {
        panic!()
    };
    asked.fit = RampFit::Multilinear(BreakCount::Exactly(1));
    assert_predicted(&plan, NOISY, &names, (60, 20.0, 0.03));
}

#[test]
fn damping_is_predicted() {
    let sweep = DampingSweep {
        specimen: 0,
        velocities: [1e-3, 4e-3, 1e-2].map(Formula::Constant).to_vec(),
        stroke: constant(1e-3),
        about: None,
        stiffness: constant(2e4),
        rate: None,
    };
    let mut plan = elastic_plan(2e4, vec![ProcedureKind::DampingSweep(sweep)]);
    (plan.specimens[0].damping, plan.specimens[0].coulomb) = (400.0, 2.0);
    assert_predicted(
        &plan,
        NOISY,
        &["damping", "coulomb_force", "damping_ratio"],
        (20, 140.0, 0.0),
    );
    let rounded = VirtualLink {
        noise: 1.0,
        force_resolution: 3.0,
        ..NOISY
    };
    assert_predicted(&plan, rounded, &["damping"], (20, 140.0, 0.05));
}

#[test]
fn the_loops_of_a_cycle_are_predicted() {
    let cycle = Cycle {
        specimen: 0,
        levels: vec![Level {
            amplitude: constant(0.02),
            cycles: 2,
        }],
        sides: Sides::Both,
        about: constant(0.0),
        points: 10,
        samples: 4,
        pause: constant(0.0),
        speed: None,
        rate: None,
        inspect: Vec::new(),
        fit: None,
    };
    let mut plan = elastic_plan(1000.0, vec![ProcedureKind::Cycle(cycle)]);
    plan.specimens[0].behaviour = Some(Behaviour::Bilinear {
        stiffness: 1000.0,
        yield_force: 10.0,
        post_yield_ratio: 0.1,
    });
    // Both with the same Monte Carlo trials.
    let link = VirtualLink {
        noise: 0.05,
        force_resolution: 0.02,
        resolution: 1e-5,
        ..NOISY
    };
    assert_predicted(
        &plan,
        link,
        &["dissipated_energy", "stiffness", "last_stiffness"],
        (5, 1e9, 0.05),
    );
}

#[test]
fn the_relaxation_of_dwells_is_predicted() {
    let plan = |model| {
        let relaxation = Some(WatchedHold {
            readings: 20,
            model,
        });
        let displacements = (1..=6)
            .map(|step| constant(2e-4 * f64::from(step)))
            .collect();
        let mut plan = ramp_plan(StiffnessRamp {
            displacements,
            pause: constant(8.0),
            relaxation,
            ..ramp(1e-4)
        });
        let of = Box::new(Behaviour::Elastic {
            stiffness: STIFFNESS,
        });
        plan.specimens[0].behaviour = Some(Behaviour::Maxwell {
            of,
            stiffness: 1e5,
            time_constant: 2.0,
        });
        plan
    };
    for model in [
        RelaxationModel::Exponential,
        RelaxationModel::StandardLinearSolid,
    ] {
        let decay = plan(WatchedModel::Decay {
            model,
            accuracy: Some(1.0),
        });
        let names = ["time_constant", "remaining_relaxation", "required_pause"];
        let noisy = VirtualLink {
            noise: 0.3,
            ..NOISY
        };
        assert_predicted(&decay, noisy, &names, (20, 100.0, 0.05));
        let record = run_unwatched(&decay);
        assert!(
            matches!(&record.procedures[0].history, History::StiffnessRamp(ramp) if ramp.relaxation.is_some())
        );
    }
}
