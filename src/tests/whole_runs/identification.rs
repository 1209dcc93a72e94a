//! Results of a ramp and a sweep: the specimen itself, within the standard errors, in the order of the reference.

use super::{constant, link, ramp_steps, ramp_then_sweep, sweep_steps};
use crate::run::{Unwatched, run};
use crate::tests::testing::{elastic_plan, number, ramp, run_unwatched};
use psd_plan::record::Outcome;
use psd_plan::{ProcedureKind, StiffnessRamp, VirtualLink};
use psd_rig::{Rig, VirtualRig};

/// ζ = c/(2√(KM)) with only M uncertain: u(ζ) = ζ u(M)/(2M).
#[test]
fn the_mass_of_the_specimen_is_in_its_damping_ratio() {
    let mut plan = ramp_then_sweep();
    plan.specimens[0].mass_uncertainty = 0.04;
    let record = run_unwatched(&plan);
    let (ratio, uncertainty) = number(&record, 1, "damping_ratio");
    let expected = 0.5 * 0.08 * ratio.unwrap();
    assert!(
        (uncertainty.unwrap() / expected - 1.0).abs() < 1e-6,
        "{uncertainty:?} is not {expected}"
    );
    assert!(
        number(&record, 1, "damping").1.unwrap() < 1e-6,
        "c does not hang on it"
    );
}

#[test]
fn an_ideal_ramp_and_sweep_give_back_the_specimen() {
    let record = run_unwatched(&ramp_then_sweep());
    assert_eq!(record.outcome, Outcome::Completed);
    let near = |procedure, name, expected: f64| {
        let value = number(&record, procedure, name).0.unwrap();
        assert!(
            (value - expected).abs() <= 1e-9 * expected.abs().max(1.0),
            "{name}: {value}"
        );
    };
    near(0, "stiffness", 3e5);
    near(0, "intercept_force", 3.0);
    // Friction acts from the first increment on: (30 + 3) N over 0.1 mm.
    near(0, "secant_stiffness", 3.3e5);
    near(0, "max_force", 303.0);
    near(0, "max_displacement", 1e-3);
    near(0, "relaxation", 0.0);
    assert_eq!(number(&record, 0, "loop_energy"), (None, None));
    near(1, "damping", 400.0);
    near(1, "coulomb_force", 3.0);
    near(1, "damping_ratio", 400.0 / (2.0 * (3e5_f64 * 0.5).sqrt()));
    near(1, "max_velocity", 0.01);
    let steps = sweep_steps(&record.procedures[1].history);
    let steady = steps.iter().filter(|step| step.steady).count();
    assert!(steady >= 10 * 50, "{steady}");
    assert_eq!(steps.len() as u64, steps.last().unwrap().step);
    assert!(
        (steps.last().unwrap().displacement).abs() < 1e-15,
        "back where it began"
    );
}

#[test]
fn results_are_in_the_order_of_the_reference() {
    let record = run_unwatched(&ramp_then_sweep());
    let names = |procedure: usize| -> Vec<_> {
        record.procedures[procedure]
            .results
            .iter()
            .map(|result| result.name)
            .collect()
    };
    let ramp = "stiffness, secant_stiffness, intercept_force, r_squared, max_force, max_displacement, loop_energy, relaxation, \
                tangent_stiffness, yield_force, yield_displacement, post_yield_stiffness, post_yield_ratio, breaks, \
                break_forces, curve_stiffnesses, time_constant, \
                relaxed_stiffness, branch_stiffness, remaining_relaxation, required_pause";
    assert_eq!(names(0).join(", "), ramp);
    assert_eq!(
        names(1).join(", "),
        "damping, coulomb_force, r_squared, damping_ratio, max_velocity"
    );
}

#[test]
fn the_return_closes_the_loop_and_friction_is_its_energy() {
    let back = StiffnessRamp {
        return_path: true,
        repeats: 2,
        ..ramp(1e-4)
    };
    let mut plan = elastic_plan(1000.0, vec![ProcedureKind::StiffnessRamp(back)]);
    plan.specimens[0].coulomb = 0.5;
    let record = run_unwatched(&plan);
    let steps = ramp_steps(&record.procedures[0].history);
    assert_eq!(steps.len(), 2 * 20);
    assert_eq!(steps.iter().filter(|step| step.returning).count(), 20);
    assert_eq!(steps[19].command, 0.0);
    // Trapezoids through the readings, by hand. Out and back of 1 mm with ±0.5 N is 1 mJ, minus the corners. At the start this is half an
    // increment (from 0 N, or from −0.5 N the second time). At the reversal it is a whole one.
    let first: f64 = 0.5 * 1e-3 * 2.0 - 0.5 * 0.5 * 1e-4 - 0.5 * 1e-4;
    let second = first - 0.5 * 0.5 * 1e-4;
    let energy = number(&record, 0, "loop_energy").0.unwrap();
    assert!((energy - 0.5 * (first + second)).abs() < 1e-12, "{energy}");
    assert!((number(&record, 0, "stiffness").0.unwrap() - 1000.0).abs() < 1e-6);
}

#[test]
fn relaxation_is_the_first_reading_minus_the_mean_after_the_pause() {
    let paused = StiffnessRamp {
        pause: constant(2.0),
        ..ramp(1e-4)
    };
    let mut plan = elastic_plan(1000.0, vec![ProcedureKind::StiffnessRamp(paused)]);
    link(
        &mut plan,
        VirtualLink {
            drift: -0.25,
            ..VirtualLink::default()
        },
    );
    let record = run_unwatched(&plan);
    assert!((number(&record, 0, "relaxation").0.unwrap() - 0.5).abs() < 1e-12);
}

#[test]
fn standard_errors_of_identification_cover_the_specimen_over_many_seeds() {
    let truth = [
        (0, "stiffness", 3e5),
        (1, "damping", 400.0),
        (1, "coulomb_force", 3.0),
    ];
    let mut plan = ramp_then_sweep();
    let mut within = [[0_u32; 3]; 3];
    for seed in 0..500 {
        link(
            &mut plan,
            VirtualLink {
                noise: 2.0,
                seed,
                ..VirtualLink::default()
            },
        );
        let record = run_unwatched(&plan);
        for ((procedure, name, truth), within) in truth.into_iter().zip(&mut within) {
            let (Some(value), Some(error)) = number(&record, procedure, name) else {
                panic!("{name} has no error")
            };
            let deviations = (value - truth).abs() / error;
            for (errors, count) in [1.0, 2.0, 3.0].into_iter().zip(within) {
                *count += u32::from(deviations <= errors);
            }
        }
    }
    // Of 500, Student's t with 8 degrees of freedom (the ramp) expects 327, 460, 491; the normal one (the sweep, with
    // some 250 pairs of readings) 341, 477, 499. Four standard deviations of a count are 42, 21 and 10 or fewer.
    for (expected, found) in [[327, 460, 491], [341, 477, 499], [341, 477, 499]]
        .into_iter()
        .zip(within)
    {
        for ((expected, found), spread) in expected.into_iter().zip(found).zip([42, 21, 10]) {
            assert!(found.abs_diff(expected) <= spread, "{within:?}");
        }
    }
}

#[test]
fn a_lagging_actuator_does_not_bias_the_damping() {
    let mut plan = ramp_then_sweep();
    link(
        &mut plan,
        VirtualLink {
            lag: 2e-3,
            ..VirtualLink::default()
        },
    );
    plan.rig.settle.band = 1e-9;
    let record = run_unwatched(&plan);
    let damping = number(&record, 1, "damping").0.unwrap();
    assert!((damping / 400.0 - 1.0).abs() < 0.005, "{damping}");
}

/// At 10 mm/s and a lag of 20 ms the piston trails by 0.2 mm at the end of a pass. It must come to rest before the next move.
#[test]
fn a_sweep_ends_at_rest_at_its_start() {
    let mut plan = ramp_then_sweep();
    link(
        &mut plan,
        VirtualLink {
            lag: 20e-3,
            ..VirtualLink::default()
        },
    );
    plan.rig.settle.band = 1e-7;
    let mut rig = VirtualRig::of_plan(&plan);
    let record = run(&plan, &mut rig, &mut Unwatched);
    assert_eq!(record.outcome, Outcome::Completed);
    let left = rig.read().unwrap().displacement[0];
    // The settling time is calculated so that the piston ends on the edge of the band, to rounding.
    assert!(left.abs() <= 1e-7 * (1.0 + 1e-9), "left at {left} m");
}
