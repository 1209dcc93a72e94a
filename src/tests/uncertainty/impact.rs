//! Uncertainty of an impact's results: closed forms, the true virtual rig run again and again, the size of the move, results
//! that share sources, requirements with a guard band.

use crate::physics::impact::summary::ImpactSummary;
use crate::plan::formula::{Formula, ProcedureId};
use crate::plan::{
    Behaviour, Calibration, Contact, Impact, Integrator, Link, Plan, ProcedureKind, Stepping,
    Until, VirtualLink,
};
use crate::record::Record;
use crate::tests::testing::{
    Uniform, elastic_plan, every, impact, number, ramp, result_of, run_unwatched, scatter,
};
use crate::uncertainty::{Contribution, Source, combined};

const STIFFNESS: f64 = 327.65;
const STRIKER: f64 = 10.0;
const MASS: f64 = 1.0;

fn constant(value: f64) -> Formula {
    Formula::Constant(value)
}

/// Perfectly plastic contact, so that the closed form is exact: both go on with V = `Ms·V0/(M + Ms)`.
fn sticking(time_step: f64) -> Impact {
    Impact {
        contact: Contact::Restitution {
            coefficient: constant(0.0),
        },
        stepping: every(time_step),
        ..impact(constant(STIFFNESS))
    }
}

fn plan(impact: Impact) -> Plan {
    elastic_plan(STIFFNESS, vec![ProcedureKind::Impact(impact)])
}

fn contributions<'a>(record: &'a Record, procedure: usize, name: &str) -> &'a [Contribution] {
    &record.procedures[procedure]
        .result(name)
        .unwrap_or_else(|| panic!("{name} is missing"))
        .contributions
}

/// Contributions of all but the time step.
fn beside_the_step(parts: &[Contribution]) -> Vec<Contribution> {
    parts
        .iter()
        .filter(|part| !matches!(part.source, Source::TimeStep { .. }))
        .copied()
        .collect()
}

/// What a source contributes to a result.
fn from(record: &Record, name: &str, source: Source) -> f64 {
    let parts = contributions(record, 0, name);
    parts
        .iter()
        .find(|part| part.source == source)
        .map_or(0.0, |part| part.amount)
}

/// Every source at once, 1 % each but for the zero.
fn all_uncertain(mut plan: Plan) -> Plan {
    plan.strikers[0].mass_uncertainty = 0.01 * STRIKER;
    plan.strikers[0].velocity_uncertainty = 0.01;
    if let ProcedureKind::Impact(impact) = &mut plan.procedures[0].kind {
        impact.point_mut().mass_uncertainty = 0.01 * MASS;
    }
    plan.rig.calibration = Calibration {
        force_uncertainty: 0.01,
        displacement_uncertainty: 0.01,
        zero_uncertainty: 0.12,
        zero_drift: 0.16,
        ..Calibration::default()
    };
    plan
}

/// X = `Ms·V0/√(K(M + Ms))`, t = π/2·√((M + Ms)/K), ½KX²; K goes with the factor of the force over that of the
/// displacement, and a force F₀ that was read too low moves X by −F₀/K.
#[test]
fn an_elastic_blow_comes_out_by_its_closed_form() {
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
    // ½KX² + F₀X = E: dX = −F₀/K. And the energy stays what the blow left.
    let zero = from(&record, "max_displacement", Source::ForceZero(0));
    assert!(
        (zero + 0.2 / STIFFNESS).abs() < 0.01 * 0.2 / STIFFNESS,
        "{zero}"
    );
    // What depends on the striker alone is exact, and what depends on nothing uncertain has no uncertainty.
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

/// Δtc = (2π/10)√(M/K) of a K that a ramp told: half of its relative error, by the same source, and half of that of M; and so of the
/// critical step of every blow of a row.
#[test]
fn the_critical_step_is_as_uncertain_as_the_ramp() {
    let blow = Impact {
        ..impact(result_of(0, "stiffness"))
    }
    .with_point(|point| point.mass_uncertainty = 0.02 * MASS);
    let mut plan = elastic_plan(
        STIFFNESS,
        vec![
            ProcedureKind::StiffnessRamp(ramp(1e-3)),
            ProcedureKind::Impact(blow),
        ],
    );
    plan.rig.link = Link::Virtual(VirtualLink {
        noise: 0.02,
        seed: 9,
        ..VirtualLink::default()
    });
    let record = run_unwatched(&plan);
    let (stiffness, known) = number(&record, 0, "stiffness");
    let (critical, told) = number(&record, 1, "critical_time_step");
    let (relative, critical) = (known.unwrap() / stiffness.unwrap(), critical.unwrap());
    let by_hand = 0.5 * critical * relative.hypot(0.02);
    assert!(
        relative > 1e-3 && (told.unwrap() / by_hand - 1.0).abs() < 1e-3,
        "{told:?}, by hand {by_hand}"
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

/// Nothing uncertain, nothing told but of the time step.
#[test]
fn an_exact_blow_is_as_uncertain_as_its_time_step() {
    let record = run_unwatched(&plan(impact(constant(STIFFNESS))));
    for result in &record.procedures[0].results {
        let of_step = |part: &Contribution| matches!(part.source, Source::TimeStep { .. });
        assert!(result.contributions.iter().all(of_step), "{result:?}");
        assert_eq!(
            number(&record, 0, result.name).1,
            combined(&result.contributions)
        );
    }
    assert_eq!(number(&record, 0, "striker_energy").1, Some(0.0));
    assert!(number(&record, 0, "max_displacement").1 > Some(0.0));
}

/// The same results without their uncertainties, of a run that does not ask for them.
#[test]
fn a_run_may_ask_for_no_uncertainty() {
    let plan = all_uncertain(plan(sticking(1e-3)));
    let mut rig = crate::rig::virtual_rig(&plan);
    let settings = crate::run::Settings { uncertainty: false };
    let without = crate::run::run_with(&plan, &mut *rig, &mut crate::run::Unwatched, settings);
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

/// Half the difference converges with the square of the move, here halved four times from a tenth of V0 and M.
#[test]
fn the_size_of_the_move_converges() {
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

/// The rig itself, run again with inputs as they may be, against what one recorded run foretells: a specimen that yields and
/// comes back with a permanent set. A cell whose newtons are off by a factor makes it stronger by that factor.
#[test]
fn runs_of_the_true_rig_scatter_as_foretold() {
    const RUNS: u32 = 200;
    let blow = || Impact {
        until: crate::plan::Until::Rebound,
        ..sticking(2e-3)
    };
    let with = |velocity: f64, mass: f64, force: f64| {
        let mut plan = plan(Impact { ..blow() }.with_point(|point| point.mass = constant(mass)));
        plan.strikers[0].velocity = velocity;
        plan.specimens[0].behaviour = Some(Behaviour::Bilinear {
            stiffness: force * STIFFNESS,
            yield_force: force * 25.0,
            hardening: 0.1,
        });
        plan
    };
    let mut doubtful = with(1.0, MASS, 1.0);
    doubtful.strikers[0].velocity_uncertainty = 0.01;
    doubtful.rig.calibration.force_uncertainty = 0.02;
    if let ProcedureKind::Impact(impact) = &mut doubtful.procedures[0].kind {
        impact.point_mut().mass_uncertainty = 0.02 * MASS;
    }
    let told = run_unwatched(&doubtful);
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
        let u = number(&told, 0, name).1.unwrap();
        // The standard deviation of a standard deviation of normal numbers is 1/√(2(n − 1)) of it: three of them.
        assert!(
            (scatter / u - 1.0).abs() < 3.0 / (2.0 * f64::from(RUNS - 1)).sqrt(),
            "{name}: {scatter} of runs, {u} foretold"
        );
    }
}

/// Noise of the cell: runs that differ in nothing but the seed.
#[test]
fn noise_scatters_runs_as_its_draws_foretell() {
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
    let told = run_unwatched(&with(1));
    let u = number(&told, 0, "max_displacement").1.unwrap();
    let values: Vec<f64> = (1..=RUNS)
        .map(|seed| {
            number(&run_unwatched(&with(seed)), 0, "max_displacement")
                .0
                .unwrap()
        })
        .collect();
    let scatter = scatter(&values);
    // Both are sampled: 1/√(2·99) and 1/√(2·64), three standard deviations of their ratio.
    assert!(
        (scatter / u - 1.0).abs() < 3.0 * (1.0 / 198.0_f64 + 1.0 / 128.0).sqrt(),
        "{scatter} of runs, {u} foretold"
    );
    let parts = beside_the_step(contributions(&told, 0, "max_displacement"));
    assert!(
        parts
            .iter()
            .all(|part| matches!(part.source, Source::Readings { .. }))
    );
    assert_eq!(parts.len(), 64);
}

/// K of a ramp and X of a blow read on one cell: what the cell's factor does to K·X is what it does to either together.
#[test]
fn what_is_read_on_one_rig_shares_its_calibration() {
    let blow =
        Impact { ..sticking(1e-3) }.with_point(|point| point.stiffness = result_of(0, "stiffness"));
    let mut plan = elastic_plan(
        STIFFNESS,
        vec![
            ProcedureKind::StiffnessRamp(ramp(1e-3)),
            ProcedureKind::Impact(blow),
        ],
    );
    plan.rig.calibration.force_uncertainty = 0.01;
    let record = run_unwatched(&plan);
    let (stiffness, u) = number(&record, 0, "stiffness");
    assert!((u.unwrap() / stiffness.unwrap() - 0.01).abs() < 1e-9);
    let product = Formula::Binary(
        crate::plan::formula::Operator::Multiply,
        Box::new(result_of(0, "stiffness")),
        Box::new(result_of(1, "max_displacement")),
    );
    let found = product.evaluate(&record, None).unwrap();
    // K·X goes with the root of the factor: ½ %, and not √(1 + ¼) %.
    assert!(
        (found.uncertainty.unwrap() / found.value - 0.005).abs() < 1e-5,
        "{found:?}"
    );
}

/// A contact that yields at 60 N is struck a step sooner or later as the speed rises: the indentation jumps.
#[test]
fn what_jumps_is_not_called_smooth() {
    let summary = |velocity: f64| {
        let mut plan = plan(Impact {
            contact: Contact::Limit {
                force: constant(60.0),
            },
            ..impact(constant(STIFFNESS))
        });
        plan.strikers[0].velocity = velocity;
        plan.strikers[0].velocity_uncertainty = 0.002;
        run_unwatched(&plan)
    };
    let mut rough = 0;
    for step in 0..40 {
        let record = summary(0.9 + 0.005 * f64::from(step));
        let u = number(&record, 0, "indentation").1;
        for part in contributions(&record, 0, "indentation")
            .iter()
            .filter(|part| !part.smooth)
        {
            rough += 1;
            assert!(u.unwrap() >= part.amount.abs());
        }
    }
    assert!(rough > 0, "none of them jumps");
}

/// A run that does not lead to what is recorded of it tells no uncertainty, and why.
#[test]
fn a_record_that_does_not_lead_to_its_results_tells_none() {
    use crate::plan::formula::ProcedureId;
    use crate::procedures::impact::setting::Setting;
    use crate::record::History;
    use crate::rig::DeclaredNoise;
    use crate::run::inputs::Inputs;
    let plan = all_uncertain(plan(sticking(1e-3)));
    let record = run_unwatched(&plan);
    let ProcedureKind::Impact(blow) = &plan.procedures[0].kind else {
        panic!()
    };
    let History::Impact(history) = &record.procedures[0].history else {
        panic!()
    };
    let mut inputs = Inputs::new(&record, ProcedureId(0));
    let noise = DeclaredNoise::default();
    let point = blow.point().unwrap();
    let setting = Setting::of_point(blow, point, &plan.strikers[0], &mut inputs, noise)
        .ok()
        .unwrap();
    let doubts = crate::procedures::impact::uncertainty::ImpactUncertainty::new(
        blow, point, &plan, &inputs, noise,
    );
    let summary = ImpactSummary {
        max_displacement: 0.2,
        time_of_max_displacement: 0.2,
        stop_time: None,
        final_displacement: 0.0,
        max_velocity: 0.0,
        max_contact_force: 0.0,
        impulse: 0.0,
        contacts: 1,
        restitution: None,
        indentation: 0.0,
        indentation_energy: 0.0,
        absorbed_energy: 0.0,
        striker_energy: 5.0,
        energy_error: 0.0,
        still_rising: false,
        last_blow_cut: false,
    };
    let mut results = record.procedures[0].results.clone();
    let before = results.clone();
    let found = doubts.propagate(
        &setting,
        &history.steps,
        &summary,
        &mut results,
        &mut |_, _| Ok(()),
    );
    let Err(crate::uncertainty::engine::Unknown::Reason(reason)) = found else {
        panic!("an uncertainty is told")
    };
    assert_eq!(
        reason,
        "the recorded way, taken again, does not lead to the recorded results"
    );
    assert_eq!(results, before);
}

/// The limit is kept by 3 %: with 1 % of uncertainty that passes, with 2 % nothing is decided, and with 1 % a limit missed by 3 % fails.
#[test]
fn a_guarded_limit_decides_nothing_where_the_blow_is_uncertain() {
    use crate::plan::{Comparison, Condition, DecisionRule, Requirement, Test};
    use crate::units::Dimension;
    use crate::verdict::{Verdict, assess};
    let largest = STRIKER / (STIFFNESS * (MASS + STRIKER)).sqrt();
    let verdict = |limit: f64, uncertainty: f64, rule| {
        let mut plan = plan(sticking(1e-3));
        plan.strikers[0].velocity_uncertainty = uncertainty;
        plan.decision_rule = rule;
        let test = Test::Compare {
            comparison: Comparison::LessEqual,
            limit: constant(limit * largest),
        };
        let condition = Condition {
            text: "as written".to_owned(),
            value: result_of(0, "max_displacement"),
            test,
            dimension: Dimension::LENGTH,
        };
        plan.requirements = vec![Requirement {
            label: "stays".to_owned(),
            conditions: vec![condition],
        }];
        let record = run_unwatched(&plan);
        let assessment = assess(&plan, &record);
        let condition = &assessment.requirements[0].conditions[0];
        let band = condition.guard_band.unwrap_or(0.0) / largest;
        assert!(
            (band - 2.0 * uncertainty).abs() < 1e-3 || rule == DecisionRule::Simple,
            "{band}"
        );
        assessment.verdict
    };
    assert_eq!(verdict(1.03, 0.01, DecisionRule::Guarded), Verdict::Pass);
    assert_eq!(
        verdict(1.03, 0.02, DecisionRule::Guarded),
        Verdict::Inconclusive
    );
    assert_eq!(
        verdict(0.97, 0.02, DecisionRule::Guarded),
        Verdict::Inconclusive
    );
    assert_eq!(verdict(0.97, 0.01, DecisionRule::Guarded), Verdict::Fail);
    assert_eq!(verdict(1.03, 0.02, DecisionRule::Simple), Verdict::Pass);
}

/// Two blows of one striker and one cell share velocity and calibration, and no error of their readings.
#[test]
fn blows_of_one_striker_share_what_is_uncertain_of_it() {
    use crate::plan::{Between, Escalate};
    let rising = Escalate {
        impact: Impact {
            until: crate::plan::Until::StrikerStop,
            ..sticking(1e-3)
        },
        velocities: vec![constant(0.5), constant(1.0)],
        energies: None,
        condition: Vec::new(),
        own: crate::plan::formula::ProcedureId(0),
        between: Between::Home,
        inspect_between: false,
    };
    let run = |velocity: f64, noise: f64| {
        let mut plan = elastic_plan(STIFFNESS, vec![ProcedureKind::Escalate(rising.clone())]);
        plan.strikers[0].velocity_uncertainty = velocity;
        plan.rig.link = Link::Virtual(VirtualLink {
            noise,
            seed: 5,
            ..VirtualLink::default()
        });
        let record = run_unwatched(&plan);
        let crate::record::History::Escalate(history) = &record.procedures[0].history else {
            panic!()
        };
        let of_blows = history
            .blows
            .iter()
            .map(|blow| {
                blow.results
                    .iter()
                    .find(|result| result.name == "absorbed_energy")
                    .unwrap()
            })
            .map(|result| &result.contributions)
            .collect::<Vec<_>>();
        // The list of all blows is as uncertain as they are.
        let listed = record.procedures[0]
            .result("absorbed_energies")
            .unwrap()
            .entry_uncertainties();
        assert_eq!(
            listed,
            of_blows
                .iter()
                .map(|parts| combined(parts))
                .collect::<Vec<_>>()
        );
        let u = |name| {
            (
                number(&record, 0, name).0,
                combined(&beside_the_step(contributions(&record, 0, name))),
            )
        };
        let of_blows: Vec<f64> = of_blows
            .iter()
            .map(|parts| combined(&beside_the_step(parts)).unwrap())
            .collect();
        (of_blows, u("absorbed_energy"), u("max_displacement"))
    };
    let (of_blows, (total, u), (largest, largest_u)) = run(0.01, 0.0);
    // 1 % of V0 is 1 % of every speed, and so 2 % of every energy: the sum of the two, not its root of squares.
    assert!(
        (u.unwrap() - (of_blows[0] + of_blows[1])).abs() < 1e-9
            && (u.unwrap() / total.unwrap() - 0.02).abs() < 1e-4
    );
    assert!((largest_u.unwrap() / largest.unwrap() - 0.01).abs() < 1e-4);
    let (of_blows, (_, u), _) = run(0.0, 0.5);
    assert!(
        (u.unwrap() / of_blows[0].hypot(of_blows[1]) - 1.0).abs() < 1e-9,
        "{u:?} of {of_blows:?}"
    );
}

/// Explicit steps just below 2/ω are stable; of a cell that reads 2 % more, for a step of 2.01/ω, they are not, and what such a
/// cell would make of the results is no uncertainty of them. A tenth of that is.
#[test]
fn a_way_that_grows_without_bound_is_told_as_such() {
    let with = |force_uncertainty: f64| {
        let blow = Impact {
            contact: Contact::Rigid,
            stepping: Stepping {
                integrator: Integrator::Explicit,
                ..every(1.99 / 300.0_f64.sqrt())
            },
            duration: constant(30.0),
            until: Until::Duration,
            ..impact(constant(300.0))
        };
        let mut plan = elastic_plan(300.0, vec![ProcedureKind::Impact(blow)]);
        plan.strikers[0].mass = 0.5;
        plan.rig.calibration = Calibration {
            force_uncertainty,
            ..Calibration::default()
        };
        let record = run_unwatched(&plan);
        let grows = record
            .events
            .iter()
            .any(|event| event.text.contains("grow without bound"));
        (grows, number(&record, 0, "max_displacement").1)
    };
    assert_eq!(with(0.02), (true, None));
    let (grows, u) = with(0.002);
    assert!(!grows && u.is_some(), "{u:?}");
}
