//! Contributions to the results of an impact, compared with its closed form.

use super::{MASS, STIFFNESS, STRIKER, all_uncertain, contributions, from, plan, sticking};
use crate::tests::testing::{elastic_plan, impact, number, ramp, result_of, run_unwatched};
use psd_plan::formula::ProcedureId;
use psd_plan::uncertainty::{Contribution, Source, StepInterval, combined};
use psd_plan::{Impact, Link, ProcedureKind, VirtualLink};
use psd_testing::plans::ChangeTarget as _;

/// X = `Ms·V0/√(K(M + Ms))`, t = π/2·√((M + Ms)/K), ½KX². K is proportional to the factor of the force over that of the displacement. A
/// force F₀ that was read too low changes X by −F₀/K.
#[test]
fn an_elastic_impact_has_the_uncertainty_of_its_closed_form() {
    let record = run_unwatched(&all_uncertain(plan(sticking(1e-3))));
    let total = MASS + STRIKER;
    let largest = STRIKER / (STIFFNESS * total).sqrt();
    let quarter = 0.5 * std::f64::consts::PI * (total / STIFFNESS).sqrt();
    let energy = 0.5 * STRIKER * STRIKER / total;
    // Relative sensitivities, times 1 %.
    let cases = [
        (Source::StrikerVelocity(0), [1.0, 0.0, 2.0]),
        (
            Source::StrikerMass(0),
            [
                1.0 - 0.5 * STRIKER / total,
                0.5 * STRIKER / total,
                2.0 - STRIKER / total,
            ],
        ),
        (
            Source::SpecimenMass(0),
            [-0.5 * MASS / total, 0.5 * MASS / total, -MASS / total],
        ),
        (Source::ForceScale(0), [-0.5, -0.5, 0.0]),
        (Source::DisplacementScale(0), [0.5, 0.5, 0.0]),
    ];
    for (source, relative) in cases {
        let results = [
            "max_displacement",
            "time_of_max_displacement",
            "absorbed_energy",
        ];
        for ((name, size), relative) in results
            .into_iter()
            .zip([largest, quarter, energy])
            .zip(relative)
        {
            let (found, by_hand) = (from(&record, name, source), 0.01 * relative * size);
            assert!(
                (found - by_hand).abs() < 1e-4 * 0.01 * size * 3.0,
                "{name} by {source:?}: {found}, by hand {by_hand}"
            );
        }
    }
    // ½KX² + F₀X = E: dX = −F₀/K. The energy is still that after the impact.
    let zero = from(&record, "max_displacement", Source::ForceZero(0));
    assert!(
        (zero + 0.2 / STIFFNESS).abs() < 0.01 * 0.2 / STIFFNESS,
        "{zero}"
    );
    // A result that depends on the striker only is exact. A result without uncertain inputs has no uncertainty.
    assert!((from(&record, "striker_energy", Source::StrikerVelocity(0)) - 0.1).abs() < 1e-12);
    assert!((number(&record, 0, "striker_energy").1.unwrap() - 0.05 * 5.0_f64.sqrt()).abs() < 1e-9);
    assert_eq!(number(&record, 0, "time_step").1, None);
    assert!(number(&record, 0, "critical_time_step").1.is_some());
    let parts = contributions(&record, 0, "max_displacement");
    assert!(parts.iter().all(|part| part.smooth), "{parts:?}");
    assert_eq!(number(&record, 0, "max_displacement").1, combined(parts));
    assert!(
        !record
            .events
            .iter()
            .any(|event| event.text.contains("uncertainty")),
        "{:?}",
        record.events
    );
}

/// Δtc = (2π/10)√(M/K) with K from a ramp: half of its relative uncertainty, from the same source, and half of that of M. The same
/// applies to the critical step of every impact of a series.
#[test]
fn the_critical_time_step_has_the_uncertainty_of_the_ramp() {
    let struck = Impact {
        ..impact(result_of(0, "stiffness"))
    }
    .with_point(|point| point.mass_uncertainty = 0.02 * MASS);
    let mut plan = elastic_plan(
        STIFFNESS,
        vec![
            ProcedureKind::StiffnessRamp(ramp(1e-3)),
            ProcedureKind::Impact(struck),
        ],
    );
    plan.rig.link = Link::Virtual(VirtualLink {
        noise: 0.02,
        seed: 9,
        ..VirtualLink::default()
    });
    let record = run_unwatched(&plan);
    let (stiffness, known) = number(&record, 0, "stiffness");
    let (critical, reported) = number(&record, 1, "critical_time_step");
    let (relative, critical) = (known.unwrap() / stiffness.unwrap(), critical.unwrap());
    let by_hand = 0.5 * critical * relative.hypot(0.02);
    assert!(
        relative > 1e-3 && (reported.unwrap() / by_hand - 1.0).abs() < 1e-3,
        "{reported:?}, by hand {by_hand}"
    );
    let parts = contributions(&record, 1, "critical_time_step");
    let of = |source| {
        parts
            .iter()
            .find(|part| part.source == source)
            .map_or(0.0, |part| part.amount)
    };
    let fitted = Source::Fit {
        procedure: ProcedureId(0),
        result: "stiffness",
    };
    assert!(
        (of(fitted) / (-0.5 * critical * relative) - 1.0).abs() < 1e-3,
        "{parts:?}"
    );
    assert!(
        (of(Source::SpecimenMass(0)) / (0.01 * critical) - 1.0).abs() < 1e-3,
        "{parts:?}"
    );
}

/// Without uncertain inputs, the time step alone has an effect, and u is 0.
#[test]
fn an_exact_impact_has_the_effect_of_its_time_step() {
    let record = run_unwatched(&plan(sticking(1e-3)));
    for result in &record.procedures[0].results {
        let of_step = |part: &Contribution| !part.source.is_of_uncertainty();
        assert!(result.contributions.iter().all(of_step), "{result:?}");
        assert_eq!(
            number(&record, 0, result.name).1,
            combined(&result.contributions)
        );
    }
    assert_eq!(number(&record, 0, "striker_energy").1, Some(0.0));
    assert_eq!(number(&record, 0, "max_displacement").1, Some(0.0));
    let effect = StepInterval::of(contributions(&record, 0, "max_displacement")).unwrap();
    assert!(effect.ends[1] - effect.ends[0] > 0.0, "{effect:?}");
}

/// The same results without their uncertainties, of a run that does not ask for them.
#[test]
fn a_run_may_ask_for_no_uncertainty() {
    let plan = all_uncertain(plan(sticking(1e-3)));
    let mut rig = psd_rig::virtual_rig(&plan);
    let keep = crate::run::Keep::Steps;
    let without = crate::run::run_with(&plan, &mut *rig, &mut crate::run::Unwatched, keep);
    let with = run_unwatched(&plan);
    for (one, other) in without.procedures[0]
        .results
        .iter()
        .zip(&with.procedures[0].results)
    {
        assert!(
            one.contributions.is_empty() && number(&without, 0, one.name).1.is_none(),
            "{one:?}"
        );
        assert_eq!(
            (one.name, number(&without, 0, one.name).0),
            (other.name, number(&with, 0, other.name).0)
        );
    }
}

/// Half the difference converges with the square of the perturbation. The perturbation is halved four times from a tenth of V0 and M.
#[test]
fn the_size_of_the_perturbation_converges() {
    let of = |share: f64| {
        let mut plan = plan(sticking(1e-3));
        plan.strikers[0].mass_uncertainty = share * STRIKER;
        let record = run_unwatched(&plan);
        from(&record, "max_displacement", Source::StrikerMass(0)) / share
    };
    let total = MASS + STRIKER;
    let by_hand = STRIKER / (STIFFNESS * total).sqrt() * (1.0 - 0.5 * STRIKER / total);
    let errors: Vec<f64> = [0.2, 0.1, 0.05]
        .map(|share| of(share) - of(0.2 / 64.0))
        .to_vec();
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((ratio - 4.0).abs() < 0.1, "{errors:?}");
    }
    assert!((of(0.2 / 64.0) / by_hand - 1.0).abs() < 1e-4);
}
