//! Uncertainty of an impact, compared with the scatter of many virtual runs.

use super::{MASS, STIFFNESS, constant, contributions, plan, sticking, without_the_time_step};
use crate::tests::testing::{
    Uniform, elastic_plan, number, ramp, result_of, run_unwatched, scatter,
};
use psd_plan::formula::Formula;
use psd_plan::uncertainty::Source;
use psd_plan::{Behaviour, Impact, Link, ProcedureKind, VirtualLink};
use psd_testing::plans::ChangeTarget as _;

/// The rig runs again with random inputs; the scatter is compared with the prediction of one recorded run. The specimen yields and
/// unloads with a residual displacement. A cell with a force factor error makes the specimen stronger by that factor.
#[test]
fn repeated_runs_scatter_as_predicted() {
    const RUNS: u32 = 200;
    let given_impact = || Impact {
        until: psd_plan::Until::Rebound,
        ..sticking(2e-3)
    };
    let with = |velocity: f64, mass: f64, force: f64| {
        let mut plan =
            plan(Impact { ..given_impact() }.with_point(|point| point.mass = constant(mass)));
        plan.strikers[0].velocity = velocity;
        plan.specimens[0].behaviour = Some(Behaviour::Bilinear {
            stiffness: force * STIFFNESS,
            yield_force: force * 25.0,
            post_yield_ratio: 0.1,
        });
        plan
    };
    let mut uncertain = with(1.0, MASS, 1.0);
    uncertain.strikers[0].velocity_uncertainty = 0.01;
    uncertain.rig.calibration.force_uncertainty = 0.02;
    if let ProcedureKind::Impact(impact) = &mut uncertain.procedures[0].kind {
        impact.point_mut().mass_uncertainty = 0.02 * MASS;
    }
    let with_uncertainty = run_unwatched(&uncertain);
    let mut uniform = Uniform(20_060_101);
    let names = [
        "max_displacement",
        "absorbed_energy",
        "final_displacement",
        "impulse",
        "max_velocity",
    ];
    let mut found: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
    for _ in 0..RUNS {
        let velocity = 1.0 + 0.01 * uniform.normal();
        let mass = MASS * (1.0 + 0.02 * uniform.normal());
        let force = 1.0 + 0.02 * uniform.normal();
        let record = run_unwatched(&with(velocity, mass, force));
        for (values, name) in found.iter_mut().zip(names) {
            values.push(number(&record, 0, name).0.unwrap());
        }
    }
    for (values, name) in found.iter().zip(names) {
        let scatter = scatter(values);
        let u = number(&with_uncertainty, 0, name).1.unwrap();
        // The relative standard deviation of a standard deviation of normal numbers is 1/√(2(n − 1)); the limit is three times this.
        assert!(
            (scatter / u - 1.0).abs() < 3.0 / (2.0 * f64::from(RUNS - 1)).sqrt(),
            "{name}: {scatter} of runs, {u} predicted"
        );
    }
}

/// Noise of the cell: runs that differ only in the seed.
#[test]
fn noise_scatters_repeated_runs_as_its_trials_predict() {
    const RUNS: u64 = 100;
    let with = |seed: u64| {
        let mut plan = plan(sticking(2e-3));
        plan.rig.link = Link::Virtual(VirtualLink {
            noise: 1.0,
            seed,
            ..VirtualLink::default()
        });
        plan
    };
    let with_uncertainty = run_unwatched(&with(1));
    let u = number(&with_uncertainty, 0, "max_displacement").1.unwrap();
    let values: Vec<f64> = (1..=RUNS)
        .map(|seed| {
            number(&run_unwatched(&with(seed)), 0, "max_displacement")
                .0
                .unwrap()
        })
        .collect();
    let scatter = scatter(&values);
    // Both are Monte Carlo estimates: 1/√(2·99) and 1/√(2·64), three standard deviations of their ratio.
    assert!(
        (scatter / u - 1.0).abs() < 3.0 * (1.0 / 198.0_f64 + 1.0 / 128.0).sqrt(),
        "{scatter} of runs, {u} predicted"
    );
    let parts = without_the_time_step(contributions(&with_uncertainty, 0, "max_displacement"));
    assert!(
        parts
            .iter()
            .all(|part| matches!(part.source, Source::Readings { .. }))
    );
    assert_eq!(parts.len(), 64);
}

/// K of a ramp and X of an impact, read on one cell: the factor of the cell affects K·X through both together.
#[test]
fn readings_of_one_rig_share_its_calibration() {
    let struck =
        Impact { ..sticking(1e-3) }.with_point(|point| point.stiffness = result_of(0, "stiffness"));
    let mut plan = elastic_plan(
        STIFFNESS,
        vec![
            ProcedureKind::StiffnessRamp(ramp(1e-3)),
            ProcedureKind::Impact(struck),
        ],
    );
    plan.rig.calibration.force_uncertainty = 0.01;
    let record = run_unwatched(&plan);
    let (stiffness, u) = number(&record, 0, "stiffness");
    assert!((u.unwrap() / stiffness.unwrap() - 0.01).abs() < 1e-9);
    let product = Formula::Binary(
        psd_plan::formula::Operator::Multiply,
        Box::new(result_of(0, "stiffness")),
        Box::new(result_of(1, "max_displacement")),
    );
    let found = product.evaluate(&record, None).unwrap();
    // K·X is proportional to the root of the factor: ½ %, and not √(1 + ¼) %.
    assert!(
        (found.uncertainty.unwrap() / found.value - 0.005).abs() < 1e-5,
        "{found:?}"
    );
}
