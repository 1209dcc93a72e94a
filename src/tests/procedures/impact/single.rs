//! Impacts on plans built by hand: the paper's first example, observations, limits, inspections, resolution of the rig.

use crate::check::{Options, check, no_files};
use crate::run::{Inspection, Observer, run};
use crate::tests::testing::{elastic_plan, every, number, result_of, run_unwatched};
use psd_physics::contact::state::StepState;
use psd_plan::formula::Formula;
use psd_plan::procedures::impact::block as schema;
use psd_plan::record::{EventKind, History, ImpactStep, ImpactSteps, Outcome, Record};
use psd_plan::{
    Contact, Impact, InspectTrigger, Interval, Link, Plan, ProcedureKind, Stepping, Until,
    VirtualLink,
};
use psd_rig::VirtualRig;
use psd_testing::plans::ChangeTarget as _;

fn constant(value: f64) -> Formula {
    Formula::Constant(value)
}

/// Example 1.
fn impact() -> Impact {
    crate::tests::testing::impact(constant(327.65))
}

fn plan(impact: Impact) -> Plan {
    elastic_plan(327.65, vec![ProcedureKind::Impact(impact)])
}

fn steps(record: &Record) -> Vec<ImpactStep> {
    match &record.procedures[0].history {
        History::Impact(impact) => impact.steps.iter().collect(),
        other => panic!("{other:?}"),
    }
}

fn value(record: &Record, name: &str) -> f64 {
    number(record, 0, name)
        .0
        .unwrap_or_else(|| panic!("{name} is missing"))
}

#[expect(clippy::cast_precision_loss, reason = "some hundred steps")]
fn count(steps: u64) -> f64 {
    steps as f64
}

#[test]
fn example_1_comes_out_as_printed() {
    let record = run_unwatched(&plan(impact()));
    assert_eq!(record.outcome, Outcome::Completed);
    assert!((value(&record, "max_displacement") - 0.157_864).abs() < 5e-7);
    assert!((value(&record, "stop_time") - 0.29).abs() < 1e-12);
    assert_eq!(value(&record, "max_contact_force").round(), 252.0);
    assert!((value(&record, "critical_time_step") - 0.0347).abs() < 5e-5);
    assert_eq!(value(&record, "striker_energy"), 5.0);
    assert!(value(&record, "energy_error").abs() < 1e-12);
    let steps = steps(&record);
    assert_eq!(
        (steps[0].step, steps[0].time, steps[0].state),
        (0, 0.0, StepState::Free)
    );
    assert_eq!(steps[1].state, StepState::Contact);
    assert_eq!(value(&record, "steps"), count(steps.len() as u64 - 1));
    // Each move at the rig's own 1 mm/s: at least 0.157864 m outwards.
    let travel: f64 = steps
        .windows(2)
        .map(|pair| (pair[1].command - pair[0].command).abs())
        .sum();
    assert!((steps.last().unwrap().wall_time - travel / 1e-3).abs() < 1e-9);
}

/// Beside the same steps without the constants of the impact, three numbers fewer are in memory: time and both kinetic energies.
#[test]
fn on_an_ideal_rig_times_and_kinetic_energies_are_not_kept() {
    let record = run_unwatched(&plan(impact()));
    let History::Impact(history) = &record.procedures[0].history else {
        panic!("an impact")
    };
    let kept = |steps: &ImpactSteps| {
        let text = format!("{steps:?}");
        text.matches("each: [").count() - text.matches("each: []").count()
    };
    let alone: ImpactSteps = history.steps.iter().collect();
    assert!(alone.iter().eq(history.steps.iter()));
    assert_eq!(kept(&alone) - kept(&history.steps), 3);
}

#[test]
fn results_are_in_the_order_of_the_reference_also_without_values() {
    let of_a_point = schema::RESULTS.iter().filter(|kind| !kind.of_storey);
    let reference: Vec<_> = of_a_point.map(|kind| kind.name).collect();
    for mass in [1.0, -1.0] {
        let record = run_unwatched(&plan(
            Impact { ..impact() }.with_point(|point| point.mass = constant(mass)),
        ));
        let names: Vec<_> = record.procedures[0]
            .results
            .iter()
            .map(|result| result.name)
            .collect();
        assert_eq!(names, reference);
        assert_eq!(record.procedures[0].complete, mass > 0.0);
    }
}

#[test]
fn pauses_take_rig_time_and_a_time_step_may_be_critical() {
    let twentieth = Formula::Binary(
        psd_plan::formula::Operator::Divide,
        Box::new(Formula::CriticalTimeStep),
        Box::new(constant(20.0)),
    );
    let record = run_unwatched(&plan(Impact {
        stepping: Stepping {
            time_step: twentieth,
            pause: constant(0.5),
            ..every(0.01)
        },
        ..impact()
    }));
    assert!(
        (value(&record, "time_step") - value(&record, "critical_time_step") / 20.0).abs() < 1e-15
    );
    let steps = steps(&record);
    let last = steps.last().unwrap();
    let travel: f64 = steps
        .windows(2)
        .map(|pair| (pair[1].command - pair[0].command).abs())
        .sum();
    let by_hand = travel / 1e-3 + 0.5 * count(last.step);
    assert!(
        (last.wall_time - by_hand).abs() < 1e-6,
        "{} {by_hand}",
        last.wall_time
    );
}

/// With a contact of finite stiffness, the critical step is that of the contact. A step that the plan does not specify must resolve the
/// impact. Between free masses F = k^(2/5)(5/4 μu²)^(3/5) (Hertz). The spring adds nothing significant in such a short time.
#[test]
fn a_default_step_resolves_the_impact_of_a_stiff_contact() {
    let hertz = |step, duration| {
        let divided = |by| {
            let parts = (Box::new(Formula::CriticalTimeStep), Box::new(constant(by)));
            Formula::Binary(psd_plan::formula::Operator::Divide, parts.0, parts.1)
        };
        let contact = Contact::Hertz {
            stiffness: constant(1e9),
            loss: constant(0.0),
            force_limit: None,
        };
        let stepping = Stepping {
            time_step: divided(step),
            ..every(0.01)
        };
        let record = run_unwatched(&plan(Impact {
            contact,
            stepping,
            duration: constant(duration),
            until: Until::Duration,
            ..impact()
        }));
        value(&record, "max_contact_force")
    };
    let free = 1e9_f64.powf(0.4) * (1.25_f64 * 10.0 / 11.0).powf(0.6);
    let first = hertz(20.0, 0.5e-3);
    assert!((first / free - 1.0).abs() < 2e-3, "{first} {free}");
    // Later impacts hit a structure that moves back, and are harder.
    let (found, fine) = (hertz(20.0, 0.05), hertz(400.0, 0.05));
    assert!((found / fine - 1.0).abs() < 5e-3, "{found} {fine}");
}

#[test]
fn a_run_that_ends_early_reports_that_its_maximum_was_not_reached() {
    let mut still_moving_on = 0;
    for duration in [0.09, 0.1, 0.11, 0.12] {
        let record = run_unwatched(&plan(Impact {
            duration: constant(duration),
            ..impact()
        }));
        assert_eq!(number(&record, 0, "stop_time"), (None, None));
        let has_event = |text| {
            record
                .events
                .iter()
                .any(|event| event.kind == EventKind::Remark && event.text.contains(text))
        };
        assert!(has_event("did not stop"));
        let last = *steps(&record).last().unwrap();
        let largest = steps(&record)
            .iter()
            .map(|step| step.displacement)
            .fold(0.0, f64::max);
        // A run that continues past its largest X contains the peak.
        let moving_on = last.velocity > 0.0 && last.displacement >= largest;
        assert_eq!(
            has_event("not reached within the run"),
            moving_on,
            "{duration}"
        );
        still_moving_on += u32::from(moving_on);
    }
    assert!((1..4).contains(&still_moving_on), "both ends are tried");
    let whole = run_unwatched(&plan(Impact {
        until: Until::Duration,
        ..impact()
    }));
    assert_eq!(steps(&whole).len(), 51);
}

#[test]
fn a_breach_keeps_every_step_and_what_follows_from_them() {
    let mut plan = plan(impact());
    plan.limits.displacement = Interval {
        low: -0.01,
        high: 0.1,
    };
    let mut rig = VirtualRig::of_plan(&plan);
    let record = run(&plan, &mut rig, &mut crate::run::Unwatched);
    assert!(matches!(record.outcome, Outcome::Aborted { .. }));
    assert!(!record.procedures[0].complete);
    let last = *steps(&record).last().unwrap();
    assert!(last.displacement <= 0.1 && last.displacement > 0.07);
    let largest = steps(&record)
        .iter()
        .map(|step| step.displacement)
        .fold(0.0, f64::max);
    assert_eq!(value(&record, "max_displacement"), largest);
    assert_eq!(value(&record, "steps"), count(last.step));
    assert_eq!(record.events.last().unwrap().kind, EventKind::LimitBreach);
    assert_eq!(record.events.last().unwrap().step, Some(last.step));
    // A force limit is detected by reading. The step that exceeded the limit is in the results, because the specimen reached it.
    plan.limits = psd_plan::Limits {
        force: Interval {
            low: -30.0,
            high: 30.0,
        },
        ..psd_plan::Limits::NONE
    };
    let record = run_unwatched(&plan);
    assert!(matches!(record.outcome, Outcome::Aborted { .. }));
    let steps = steps(&record);
    let (last, before) = steps.split_last().unwrap();
    assert!(
        last.restoring_force > 30.0 && before.iter().all(|step| step.restoring_force <= 30.0),
        "{last:?}"
    );
    assert_eq!(value(&record, "max_displacement"), last.displacement);
    assert_eq!(value(&record, "steps"), count(last.step));
}

#[test]
fn an_energy_error_past_its_limit_aborts_after_recording_the_step() {
    let within = |impact: Impact| {
        let mut plan = plan(impact);
        plan.limits.energy_error = Interval {
            low: 0.0,
            high: 1e-6,
        };
        run_unwatched(&plan)
    };
    assert_eq!(within(impact()).outcome, Outcome::Completed);
    // A tangent limited to a hundredth of K0 no longer closes the balance.
    let record = within(Impact {
        stepping: Stepping {
            max_tangent_ratio: constant(0.01),
            ..every(0.01)
        },
        ..impact()
    });
    assert!(
        matches!(&record.outcome, Outcome::Aborted { reason } if reason.contains("energy error")),
        "{:?}",
        record.outcome
    );
    let steps = steps(&record);
    let (last, before) = steps.split_last().unwrap();
    assert!((last.energies.error / 5.0).abs() > 1e-6);
    assert!(
        before
            .iter()
            .all(|step| (step.energies.error / 5.0).abs() <= 1e-6)
    );
}

/// Counts inspections.
struct Onlooker(Vec<String>);

impl Observer for Onlooker {
    fn inspect(&mut self, note: &str) -> Inspection {
        self.0.push(note.to_owned());
        Inspection::go_on()
    }
}

#[test]
fn inspections_come_while_it_runs_and_change_nothing() {
    let triggers = vec![InspectTrigger::Every(10), InspectTrigger::At(0.05)];
    let mut onlooker = Onlooker(Vec::new());
    let inspected = plan(Impact {
        stepping: Stepping {
            inspect: triggers,
            ..every(0.01)
        },
        ..impact()
    });
    let record = run(
        &inspected,
        &mut VirtualRig::of_plan(&inspected),
        &mut onlooker,
    );
    assert_eq!(
        onlooker.0.len(),
        record
            .events
            .iter()
            .filter(|event| event.kind == EventKind::Inspection)
            .count()
    );
    assert_eq!(onlooker.0[0], "inspection at 0.05 s of test time");
    assert_eq!(steps(&record), steps(&run_unwatched(&plan(impact()))));
}

/// A run with an inspection takes its steps one by one, another run on an ideal rig takes them in one go: to its end, and to a limit that
/// stops it at a target or at a reading.
#[test]
fn an_impact_in_one_go_has_the_steps_of_the_impact_step_by_step() {
    let bounded = |limits: fn(&mut psd_plan::Limits) -> &mut Interval, high: f64| {
        let mut bounded = psd_plan::Limits::NONE;
        *limits(&mut bounded) = Interval { low: -high, high };
        bounded
    };
    for (limits, stops) in [
        (psd_plan::Limits::NONE, false),
        (bounded(|limits| &mut limits.displacement, 0.1), true),
        (bounded(|limits| &mut limits.increment, 0.009), true),
        (bounded(|limits| &mut limits.force, 30.0), true),
    ] {
        for contact in [
            impact().contact,
            Contact::Limit {
                force: constant(60.0),
            },
        ] {
            let runs = |inspect: Vec<InspectTrigger>| {
                let mut plan = plan(Impact {
                    contact: contact.clone(),
                    stepping: Stepping {
                        inspect,
                        ..every(0.01)
                    },
                    ..impact()
                });
                plan.limits = limits;
                run_unwatched(&plan)
            };
            let [one, other] = [Vec::new(), vec![InspectTrigger::At(1e6)]].map(runs);
            assert_eq!(
                one.outcome != Outcome::Completed,
                stops,
                "{:?}",
                one.outcome
            );
            assert_eq!((&one.outcome, &one.events), (&other.outcome, &other.events));
            assert_eq!(steps(&one), steps(&other));
            let results = |record: &Record| format!("{:?}", record.procedures[0].results);
            assert_eq!(results(&one), results(&other));
        }
    }
}

#[test]
fn noise_is_declared_to_the_tangent_stiffness_and_a_seed_repeats_the_run() {
    let mut noisy = plan(impact());
    noisy.rig.link = Link::Virtual(VirtualLink {
        noise: 0.2,
        resolution: 1e-5,
        seed: 3,
        ..VirtualLink::default()
    });
    let first = run_unwatched(&noisy);
    assert_eq!(steps(&first), steps(&run_unwatched(&noisy)));
    // A force change of less than ten standard deviations does not determine a stiffness. The guard then uses K0 at the first, short
    // steps back.
    for step in steps(&first) {
        assert!(
            (step.tangent_stiffness / 327.65 - 1.0).abs() < 0.5,
            "{}",
            step.tangent_stiffness
        );
    }
    assert!((value(&first, "max_displacement") - 0.157_864).abs() < 2e-3);
}

#[test]
fn tracking_moves_the_measured_and_not_the_computed_displacement() {
    let mut short = plan(impact());
    short.rig.link = Link::Virtual(VirtualLink {
        tracking: 0.05,
        ..VirtualLink::default()
    });
    let record = run_unwatched(&short);
    let pair = &steps(&record)[..2];
    assert!((pair[1].displacement - 0.95 * pair[1].command).abs() < 1e-15);
    assert!((pair[1].restoring_force - 327.65 * 0.95 * pair[1].command).abs() < 1e-9);
}

#[test]
fn an_input_can_be_an_earlier_result_with_its_uncertainty() {
    let mut both = elastic_plan(
        327.65,
        vec![
            ProcedureKind::StiffnessRamp(crate::tests::testing::ramp(1e-3)),
            ProcedureKind::Impact(
                Impact { ..impact() }
                    .with_point(|point| point.stiffness = result_of(0, "stiffness")),
            ),
        ],
    );
    both.rig.link = Link::Virtual(VirtualLink {
        noise: 0.01,
        seed: 1,
        ..VirtualLink::default()
    });
    let record = run_unwatched(&both);
    assert_eq!(record.outcome, Outcome::Completed);
    let (_, stiffness, _) = record.procedures[1]
        .inputs
        .iter()
        .find(|(name, ..)| *name == "stiffness")
        .unwrap();
    assert_eq!(
        (Some(stiffness.value), stiffness.uncertainty.is_some()),
        (number(&record, 0, "stiffness").0, true)
    );
}

/// A table that stiffens from 300 to 900 N/m at 20 mm: the check uses the first, the run measures the second.
#[test]
fn a_specimen_that_stiffens_past_the_operator_is_remarked_once() {
    let stiffening = |integrator| {
        let mut plan = plan(Impact {
            stepping: Stepping {
                integrator,
                ..every(0.002)
            },
            ..crate::tests::testing::impact(constant(310.0))
        });
        let points = vec![
            [-0.1, -90.0],
            [-0.02, -6.0],
            [0.0, 0.0],
            [0.02, 6.0],
            [0.1, 78.0],
        ];
        let unloading = psd_plan::Unloading::AlongTheCurve;
        let table = psd_plan::Table {
            file: "points.csv".to_owned(),
            points,
            unloading,
            scale: 1.0,
        };
        plan.specimens[0].behaviour = Some(psd_plan::Behaviour::Table(table));
        let record = run_unwatched(&plan);
        record
            .events
            .into_iter()
            .filter(|event| event.text.starts_with("W718"))
            .collect::<Vec<_>>()
    };
    let remarks = stiffening(psd_plan::Integrator::AlphaOs { alpha: 0.0 });
    assert_eq!(remarks.len(), 1, "{remarks:?}");
    // The first secant across the breakpoint, or after it; 2/√(590) s = 82 ms is left.
    assert!(
        remarks[0].text.contains("K_I = 310.0 N/m")
            && remarks[0].text.contains("not exceeded here (2.000 ms)"),
        "{}",
        remarks[0].text
    );
    assert!(stiffening(psd_plan::Integrator::Tangent).is_empty());
}

/// A damping ratio ζ is the coefficient C = 2 ζ √(K M), with the uncertainties of a measured stiffness and of a stated mass.
#[test]
fn a_damping_ratio_is_its_coefficient() {
    let run_with = |damping: &str| {
        let text = format!(
            "specimen beam {{\n mass = 4 kg\n mass_uncertainty = 0.2 kg\n behaviour = elastic(10 kN/m)\n}}\n\
             striker hammer {{\n mass = 10 kg\n velocity = 1 m/s\n}}\n\
             rig bench {{\n link = virtual(noise: 1 N, seed: 1)\n force_uncertainty = 0.5 %\n}}\n\
             stiffness ramp k0 {{\n displacements = 1 mm .. 10 mm step 1 mm\n}}\n\
             impact hit {{\n striker = hammer\n stiffness = k0.stiffness\n contact = restitution(0)\n {damping}\n \
             duration = 0.3 s\n}}\nrequire \"travel\" hit.max_displacement < 1 m\n"
        );
        let checked = check("ratio.psd", &text, &no_files, &Options::default());
        let plan = checked
            .plan
            .unwrap_or_else(|| panic!("{:?}", checked.diagnostics));
        run_unwatched(&plan)
    };
    let ratio = run_with("damping_ratio = 2 %");
    let coefficient = run_with("damping = 2 * 2 % * sqrt(k0.stiffness * beam.mass)");
    for name in [schema::MAX_DISPLACEMENT.name, schema::DAMPING_ENERGY.name] {
        let of_ratio = number(&ratio, 1, name);
        assert_eq!(of_ratio, number(&coefficient, 1, name), "{name}");
        assert!(of_ratio.1.is_some_and(|u| u > 0.0), "{name}");
    }
    let damping = |record: &Record| {
        let inputs = &record.procedures[1].inputs;
        let found = inputs.iter().find(|(name, ..)| *name == "damping");
        found.expect("the damping is an input").1.value
    };
    assert!(
        (damping(&ratio) / 8.0 - 1.0).abs() < 5e-3,
        "2 · 2 % · √(10 kN/m · 4 kg)"
    );
}
