//! Coverage of expanded uncertainties: of hundreds of ramps of few points with simulated noise, U covers the stiffness as stated.

use crate::tests::testing::{elastic_plan, number, ramp, run_unwatched};
use crate::verdict::{Verdict, assess};
use psd_physics::statistics::student_t::LEVEL;
use psd_plan::formula::{Formula, ProcedureId, ResultPart, ResultReference, ResultValue, Results};
use psd_plan::record::Record;
use psd_plan::uncertainty::{MeasurementUncertainty, measurement_uncertainty};
use psd_plan::{
    Comparison, Condition, DecisionRule, Link, Plan, ProcedureKind, Requirement, StiffnessRamp,
    Test, VirtualLink,
};
use psd_text::units::Dimension;

const STIFFNESS: f64 = 3e5;

/// A ramp with this number of points, read with 20 N of noise.
fn plan(points: u32, seed: u64) -> Plan {
    let displacements = (1..=points)
        .map(|point| Formula::Constant(f64::from(point) * 1e-4))
        .collect();
    let kind = ProcedureKind::StiffnessRamp(StiffnessRamp {
        displacements,
        ..ramp(1e-4)
    });
    let mut plan = elastic_plan(STIFFNESS, vec![kind]);
    plan.rig.link = Link::Virtual(VirtualLink {
        noise: 20.0,
        seed,
        ..VirtualLink::default()
    });
    plan
}

fn value_and_uncertainty(record: &Record, name: &'static str) -> (f64, MeasurementUncertainty) {
    let reference = ResultReference {
        procedure: ProcedureId(0),
        name,
        part: ResultPart::Value,
    };
    let value = number(record, 0, name).0.unwrap();
    (
        value,
        measurement_uncertainty(&record.contributions(reference), record).unwrap(),
    )
}

/// In 95.45 % of 500 ramps each of 3, 4, 6 and 12 points, K and R₀ lie within U. With k = 2 it would be 70, 82, 88 and 93 %. The fraction
/// of 500 scatters by 0.93 %. Five standard deviations, 4.7 %, distinguish the first three from it.
#[test]
fn the_stated_fraction_of_ramps_contains_the_stiffness() {
    const RAMPS: u16 = 500;
    // Five standard deviations of a fraction of this many runs.
    let scatter = 5.0 * (LEVEL * (1.0 - LEVEL) / f64::from(RAMPS)).sqrt();
    for points in [3, 4, 6, 12] {
        let (mut slopes, mut intercepts) = (0_u16, 0_u16);
        for seed in 0..u64::from(RAMPS) {
            let record = run_unwatched(&plan(points, seed));
            for (name, truth, held) in [
                ("stiffness", STIFFNESS, &mut slopes),
                ("intercept_force", 0.0, &mut intercepts),
            ] {
                let (value, known) = value_and_uncertainty(&record, name);
                assert!(
                    (known.degrees - f64::from(points - 2)).abs() < 1e-9,
                    "{name}: {known:?}"
                );
                *held += u16::from((value - truth).abs() <= known.expanded());
            }
        }
        for held in [slopes, intercepts] {
            let share = f64::from(held) / f64::from(RAMPS);
            assert!((share - LEVEL).abs() < scatter, "{points} points: {share}");
        }
    }
}

/// Conformity of the stiffness of a ramp of three points is assessed with 13.97 u, and not with 2 u.
#[test]
fn a_guard_band_has_the_degrees_of_freedom_of_its_ramp() {
    let reference = ResultReference {
        procedure: ProcedureId(0),
        name: "stiffness",
        part: ResultPart::Value,
    };
    let of_limit = |limit: f64| {
        let mut plan = plan(3, 5);
        plan.decision_rule = DecisionRule::Guarded;
        plan.requirements = vec![Requirement {
            label: "stiff".to_owned(),
            conditions: vec![Condition {
                text: String::new(),
                dimension: Dimension::STIFFNESS,
                value: Formula::Result(reference),
                test: Test::Compare {
                    comparison: Comparison::GreaterEqual,
                    limit: Formula::Constant(limit),
                },
            }],
        }];
        let record = run_unwatched(&plan);
        let (value, known) = value_and_uncertainty(&record, "stiffness");
        let assessment = assess(&plan, &record);
        (
            value,
            known,
            assessment.requirements[0].conditions[0].clone(),
        )
    };
    let (value, known, condition) = of_limit(0.0);
    assert!((condition.guard_band.unwrap() / (13.968 * known.standard) - 1.0).abs() < 1e-4);
    assert_eq!(condition.measurement_uncertainty(), Some(known));
    assert!(
        (condition.margin_uncertainty().unwrap().standard / known.standard - 1.0).abs() < 1e-12
    );
    let verdict = |errors: f64| of_limit(value - errors * known.standard).2.verdict;
    let found = [3.0, 13.9, 14.0, -3.0, -14.0].map(verdict);
    let undecided = Verdict::Inconclusive;
    assert_eq!(
        found,
        [
            undecided,
            undecided,
            Verdict::Pass,
            undecided,
            Verdict::Fail
        ]
    );
}

/// Twice as far, ten times as heavy. A value calculated from K has the degrees of freedom of K. A value calculated from two ramps
/// combines theirs.
#[test]
fn what_follows_from_a_fit_has_its_degrees_of_freedom() {
    let second = |mut plan: Plan| {
        let again = plan.procedures[0].clone();
        plan.procedures.push(again);
        plan
    };
    let record = run_unwatched(&second(plan(6, 1)));
    let of = |procedure| {
        Formula::Result(ResultReference {
            procedure: ProcedureId(procedure),
            name: "stiffness",
            part: ResultPart::Value,
        })
    };
    let degrees = |formula: &Formula| {
        measurement_uncertainty(&formula.contributions(&record, None).unwrap(), &record)
            .unwrap()
            .degrees
    };
    let root = Formula::Call(psd_plan::formula::Function::Sqrt, vec![of(0)]);
    assert!((degrees(&root) - 4.0).abs() < 1e-6);
    let mean = Formula::Call(psd_plan::formula::Function::Mean, vec![of(0), of(1)]);
    let [one, other] = [0, 1].map(|procedure| {
        match record.procedures[procedure]
            .result("stiffness")
            .unwrap()
            .value
        {
            ResultValue::Number {
                uncertainty: Some(u),
                ..
            } => u,
            ref none => panic!("{none:?}"),
        }
    });
    let by_hand = (one * one + other * other).powi(2) / ((one.powi(4) + other.powi(4)) / 4.0);
    assert!((degrees(&mean) / by_hand - 1.0).abs() < 1e-6 && by_hand > 4.0);
}
