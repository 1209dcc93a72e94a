//! Effect of rounding on a fit. It is compared with replays on rigs that differ in the zero of their quantization grid.

use crate::tests::noise::uniform;
use crate::tests::testing::{elastic_plan, ramp, result_of, run_unwatched};
use psd_plan::formula::{Formula, ProcedureId, ResultPart, ResultReference, ResultValue, Results};
use psd_plan::record::{History, Record};
use psd_plan::uncertainty::{MeasurementUncertainty, Source, measurement_uncertainty};
use psd_plan::{
    Behaviour, DampingSweep, Link, Plan, ProcedureKind, RampFit, StiffnessRamp, VirtualLink,
};

const STIFFNESS: f64 = 3e5;
/// \[m\]
const REACH: f64 = 1e-3;

fn value_and_uncertainty(
    record: &Record,
    procedure: usize,
    name: &'static str,
) -> (f64, MeasurementUncertainty) {
    let reference = ResultReference {
        procedure: ProcedureId(procedure),
        name,
        part: ResultPart::Value,
    };
    let Some(ResultValue::Number {
        value: Some(value), ..
    }) = record.result(reference)
    else {
        panic!("no {name}")
    };
    (
        value,
        measurement_uncertainty(&record.contributions(reference), record)
            .unwrap_or(MeasurementUncertainty::exact(0.0)),
    )
}

/// `points` steps to the reach from `begin` \[m\], on a specimen of `stiffness` \[N/m\].
fn ramp_plan(points: u32, begin: f64, stiffness: f64, link: VirtualLink) -> Plan {
    let displacement =
        |point| Formula::Constant(begin + REACH * f64::from(point) / f64::from(points));
    let kind = ProcedureKind::StiffnessRamp(StiffnessRamp {
        displacements: (1..=points).map(displacement).collect(),
        ..ramp(1e-4)
    });
    let mut plan = elastic_plan(stiffness, vec![kind]);
    plan.rig.link = Link::Virtual(link);
    plan
}

/// Results of replays: root mean square of the errors, root mean square of the reported u, and the fraction of errors within U.
#[derive(Debug)]
struct Replayed {
    error: f64,
    reported: f64,
    held: f64,
}

fn replayed(
    count: u32,
    mut replay: impl FnMut(&mut u64) -> (f64, MeasurementUncertainty),
) -> Replayed {
    let mut state = 23;
    let (mut errors, mut squares, mut held) = (0.0, 0.0, 0);
    for _ in 0..count {
        let (error, known) = replay(&mut state);
        errors += error * error;
        squares += known.standard * known.standard;
        held += u32::from(error.abs() <= known.expanded());
    }
    let mean = |sum: f64| (sum / f64::from(count)).sqrt();
    Replayed {
        error: mean(errors),
        reported: mean(squares),
        held: f64::from(held) / f64::from(count),
    }
}

/// From three quantization steps over the whole ramp to 77, and from 3 points to 40. U covers at least 95 %. u is at least the scatter of
/// the replays and at most three times that scatter.
#[test]
fn replays_of_a_ramp_on_a_coarse_load_cell_are_held() {
    for points in [3, 5, 12, 40] {
        for resolution_steps in [3.0, 10.0, 77.0] {
            let quantum = STIFFNESS * REACH / resolution_steps;
            let found = replayed(100, |state| {
                let stiffness = STIFFNESS * (1.0 + (uniform(state) - 0.5) / resolution_steps);
                let begin = uniform(state) * quantum / stiffness;
                let link = VirtualLink {
                    force_resolution: quantum,
                    ..VirtualLink::default()
                };
                let record = run_unwatched(&ramp_plan(points, begin, stiffness, link));
                let (value, known) = value_and_uncertainty(&record, 0, "stiffness");
                (value - stiffness, known)
            });
            let Replayed {
                error,
                reported,
                held,
            } = found;
            assert!(
                held >= 0.94,
                "{points} points over {resolution_steps} resolution_steps: {found:?}"
            );
            assert!(
                reported > 0.93 * error && reported < 3.0 * error,
                "{points} points over {resolution_steps} resolution_steps: {found:?}"
            );
        }
    }
}

/// The same for the displacement, including its effect on the intercept.
#[test]
fn replays_of_a_ramp_on_a_coarse_transducer_are_held() {
    for (points, resolution_steps) in [(5, 5.3), (10, 33.3)] {
        let quantum = REACH / resolution_steps;
        for name in ["stiffness", "intercept_force"] {
            let found = replayed(150, |state| {
                // The path has the required length except for part of a quantization step, and begins at any position.
                let begin = uniform(state) * quantum;
                let link = VirtualLink {
                    resolution: quantum,
                    ..VirtualLink::default()
                };
                let mut plan = ramp_plan(points, begin, STIFFNESS, link);
                let longer = 1.0 + (uniform(state) - 0.5) / resolution_steps;
                let ProcedureKind::StiffnessRamp(ramp) = &mut plan.procedures[0].kind else {
                    panic!()
                };
                for (point, displacement) in (1..).zip(&mut ramp.displacements) {
                    *displacement = Formula::Constant(
                        begin + longer * REACH * f64::from(point) / f64::from(points),
                    );
                }
                let (value, known) = value_and_uncertainty(&run_unwatched(&plan), 0, name);
                (
                    value - if name == "stiffness" { STIFFNESS } else { 0.0 },
                    known,
                )
            });
            assert!(
                found.held >= 0.92 && found.reported > 0.85 * found.error,
                "{name}, {points} over {resolution_steps} resolution_steps: {found:?}"
            );
        }
    }
}

/// Readings in phase with the grid lie exactly on one line. The reported uncertainty of K is then the effect of one quantization step,
/// and the budget states this. A resolution of zero has no effect.
#[test]
fn a_ramp_in_step_with_its_grid_is_not_known_to_the_last_digit() {
    let link = VirtualLink {
        force_resolution: 10.0,
        ..VirtualLink::default()
    };
    let plan = ramp_plan(10, 0.0, STIFFNESS, link);
    let record = run_unwatched(&plan);
    let (value, known) = value_and_uncertainty(&record, 0, "stiffness");
    assert!((value / STIFFNESS - 1.0).abs() < 1e-9);
    // q/√12 of each of ten points, over √Σ(x − x̄)².
    let squares: f64 = (1..=10)
        .map(|point| (REACH / 10.0 * (f64::from(point) - 5.5)).powi(2))
        .sum();
    assert!(
        (known.standard / (10.0 / 12_f64.sqrt() / squares.sqrt()) - 1.0).abs() < 1e-6,
        "{known:?}"
    );
    assert!(known.degrees > 1e12, "stated, not estimated: {known:?}");
    let parts = &record.procedures[0]
        .result("stiffness")
        .unwrap()
        .contributions;
    assert!(parts.iter().any(|part| matches!(
        part.source,
        Source::Rounding {
            result: "stiffness",
            ..
        }
    )));
    let ideal = run_unwatched(&ramp_plan(10, 0.0, STIFFNESS, VirtualLink::default()));
    assert!(value_and_uncertainty(&ideal, 0, "stiffness").1.standard < 1e-6);
    // Figures and reports use the same uncertainty of the fit.
    let History::StiffnessRamp(ramp) = &record.procedures[0].history else {
        panic!()
    };
    assert!((ramp.fit.unwrap().slope_error / known.standard - 1.0).abs() < 1e-9);
    // Noise that is larger than the quantization step is reported as scatter.
    let noisy = |force_resolution| VirtualLink {
        noise: 30.0,
        seed: 3,
        force_resolution,
        ..VirtualLink::default()
    };
    let [fine, none] = [1.0, 0.0].map(|quantum| {
        value_and_uncertainty(
            &run_unwatched(&ramp_plan(10, 0.0, STIFFNESS, noisy(quantum))),
            0,
            "stiffness",
        )
    });
    assert!(
        (fine.1.standard / none.1.standard - 1.0).abs() < 0.02
            && (fine.1.degrees - 8.0).abs() < 1e-6,
        "{fine:?} {none:?}"
    );
}

/// c and the friction of a sweep on a coarse cell. Its resolution is a third of the damper force, or three times that force.
#[test]
fn replays_of_a_sweep_on_a_coarse_load_cell_are_held() {
    for quantum in [1.3, 12.0] {
        for name in ["damping", "coulomb_force"] {
            let found = replayed(30, |state| {
                let velocities = [1e-3, 4e-3, 1e-2].map(Formula::Constant).to_vec();
                let sweep = DampingSweep {
                    specimen: 0,
                    velocities,
                    stroke: Formula::Constant(1e-3),
                    about: None,
                    stiffness: Formula::Constant(2e4),
                    rate: None,
                };
                let mut plan = elastic_plan(2e4, vec![ProcedureKind::DampingSweep(sweep)]);
                plan.specimens[0].damping = 400.0 * (0.7 + 0.6 * uniform(state));
                plan.specimens[0].coulomb = 3.0 * uniform(state);
                plan.rig.link = Link::Virtual(VirtualLink {
                    force_resolution: quantum,
                    ..VirtualLink::default()
                });
                let truth = if name == "damping" {
                    plan.specimens[0].damping
                } else {
                    plan.specimens[0].coulomb
                };
                let (value, known) = value_and_uncertainty(&run_unwatched(&plan), 0, name);
                (value - truth, known)
            });
            assert!(
                found.held >= 0.9 && found.reported > 0.8 * found.error,
                "{name}, {quantum} N: {found:?}"
            );
        }
    }
}

/// Both stiffnesses and the yield point of a ramp past yield, each segment of which is a few quantization steps.
#[test]
fn replays_of_a_bilinear_ramp_on_a_coarse_load_cell_are_held() {
    for name in ["stiffness", "post_yield_stiffness", "yield_force"] {
        let found = replayed(80, |state| {
            let stiffness = STIFFNESS * (0.9 + 0.2 * uniform(state));
            let yield_force = 150.0 + 10.0 * uniform(state);
            let link = VirtualLink {
                force_resolution: 20.0,
                ..VirtualLink::default()
            };
            let mut plan = ramp_plan(20, 1e-5 * uniform(state), stiffness, link);
            plan.specimens[0].behaviour = Some(Behaviour::Bilinear {
                stiffness,
                yield_force,
                post_yield_ratio: 0.2,
            });
            let ProcedureKind::StiffnessRamp(ramp) = &mut plan.procedures[0].kind else {
                panic!()
            };
            ramp.fit = RampFit::Bilinear;
            let (value, known) = value_and_uncertainty(&run_unwatched(&plan), 0, name);
            let truth = match name {
                "stiffness" => stiffness,
                "post_yield_stiffness" => 0.2 * stiffness,
                _ => yield_force,
            };
            (value - truth, known)
        });
        assert!(
            found.held >= 0.9 && found.reported > 0.7 * found.error,
            "{name}: {found:?}"
        );
    }
}

/// A value derived from K includes its rounding once: K − K is exact.
#[test]
fn rounding_is_a_source_like_any_other() {
    let link = VirtualLink {
        force_resolution: 10.0,
        ..VirtualLink::default()
    };
    let record = run_unwatched(&ramp_plan(10, 0.0, STIFFNESS, link));
    let of = || Box::new(result_of(0, "stiffness"));
    let nothing = Formula::Binary(psd_plan::formula::Operator::Subtract, of(), of());
    assert_eq!(
        nothing.evaluate(&record, None).unwrap().uncertainty,
        Some(0.0)
    );
}
