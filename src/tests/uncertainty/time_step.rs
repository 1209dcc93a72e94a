//! Effect of the length of the time step on the results: closed forms, and the same runs with much smaller steps. Also inputs that cannot
//! be perturbed by ±u in both directions.

use crate::tests::testing::{elastic_plan, every, impact, number, run_unwatched};
pub(crate) use psd_plan::formula::{Formula, Stated};
use psd_plan::record::{EventKind, Outcome, Record};
use psd_plan::uncertainty::{Source, StepInterval};
use psd_plan::{
    Behaviour, Contact, Frame, Ground, Impact, Link, Plan, ProcedureKind, Shake, ShakeDamping,
    Specimen, Stepping, Storey, VirtualLink,
};
use psd_testing::plans::ChangeTarget as _;

const STIFFNESS: f64 = 327.65;
const STRIKER: f64 = 10.0;
const MASS: f64 = 1.0;

/// Perfectly plastic: both bodies continue with V = `Ms·V0/(M + Ms)`.
fn sticking(time_step: f64) -> Plan {
    let contact = Contact::Restitution {
        coefficient: Formula::Constant(0.0),
    };
    let struck = Impact {
        contact,
        stepping: every(time_step),
        ..impact(Formula::Constant(STIFFNESS))
    };
    elastic_plan(STIFFNESS, vec![ProcedureKind::Impact(struck)])
}

/// The largest effect of finer steps on a result.
fn of_step(record: &Record, name: &str) -> f64 {
    let parts = &record.procedures[0].result(name).unwrap().contributions;
    let [low, high] = StepInterval::of(parts).map_or([0.0; 2], |step| step.ends);
    high.max(-low)
}

/// The difference of a result in a quarter of the steps.
fn in_quarter(record: &Record, name: &str) -> f64 {
    let parts = &record.procedures[0].result(name).unwrap().contributions;
    StepInterval::of(parts).unwrap().quarter
}

/// The interval of a result in any finer steps, with U to both sides of it.
fn interval(record: &Record, name: &str) -> [f64; 2] {
    let (value, u) = number(record, 0, name);
    let parts = &record.procedures[0].result(name).unwrap().contributions;
    let ends = StepInterval::of(parts).map_or([0.0; 2], |step| step.ends);
    let (value, expanded) = (value.unwrap(), 2.0 * u.unwrap());
    [value + ends[0] - expanded, value + ends[1] + expanded]
}

/// X = `Ms·V0/√(K(M + Ms))`, a quarter period and the energy of both. The interval of the time step holds them at every step,
/// and is small at the default step.
#[test]
fn the_interval_of_the_time_step_holds_the_closed_form_at_any_step() {
    let total = MASS + STRIKER;
    let peak = STRIKER / (STIFFNESS * total).sqrt();
    let quarter = 0.25 * std::f64::consts::TAU * (total / STIFFNESS).sqrt();
    let energy = 0.5 * STRIKER * STRIKER / total;
    let exact = [
        ("max_displacement", peak),
        ("stop_time", quarter),
        ("time_of_max_displacement", quarter),
        ("absorbed_energy", energy),
    ];
    let critical = 0.1 * std::f64::consts::TAU * (MASS / STIFFNESS).sqrt();
    for divisor in [1.0, 1.7, 3.0, 6.0, 20.0] {
        let record = run_unwatched(&sticking(critical / divisor));
        for (name, exact) in exact {
            let [low, high] = interval(&record, name);
            assert!(
                (low..=high).contains(&exact),
                "critical/{divisor}: {name} from {low} to {high}, truly {exact}"
            );
        }
        assert!(divisor < 20.0 || of_step(&record, "max_displacement") < 5e-4 * peak);
    }
    assert!(of_step(&run_unwatched(&sticking(critical)), "max_displacement") > 1e-3 * peak);
}

/// The same with noise, which the re-integrated path contains in all its steps: it changes the difference by less than U.
#[test]
fn noise_is_not_counted_as_an_error_of_the_time_step() {
    let mut plan = sticking(2e-3);
    plan.rig.link = Link::Virtual(VirtualLink {
        noise: 0.02,
        seed: 3,
        ..VirtualLink::default()
    });
    let (quiet, noisy) = (run_unwatched(&sticking(2e-3)), run_unwatched(&plan));
    for name in ["max_displacement", "absorbed_energy"] {
        let (of_quiet, of_noisy) = (in_quarter(&quiet, name), in_quarter(&noisy, name));
        let u = number(&noisy, 0, name).1.unwrap();
        assert!(
            (of_quiet - of_noisy).abs() < 2.0 * u,
            "{name}: {of_quiet}, {of_noisy}, u = {u}"
        );
    }
}

fn base_excited_plan(time_step: f64) -> Record {
    let storey = |stiffness| Storey::new(1000.0, stiffness, Behaviour::Elastic { stiffness });
    let mut specimen = Specimen::new("frame", 2000.0, None);
    specimen.frame = Some(Frame::of_storeys(vec![storey(2e6), storey(1.5e6)]));
    let times: Vec<f64> = (0..=200).map(|index| 0.01 * f64::from(index)).collect();
    let accelerations = times
        .iter()
        .map(|time| 2.0 * (9.0 * time).sin() + (31.0 * time).sin())
        .collect();
    let shake = Shake {
        specimen: 0,
        ground: 0,
        scale: Formula::Constant(1.0),
        damping: ShakeDamping::Rayleigh(Formula::Constant(0.02)),
        damping_uncertainty: 0.0,
        stepping: Stepping {
            max_tangent_ratio: Formula::Constant(2.0),
            ..every(time_step)
        },
        duration: None,
        until: None,
    };
    let mut plan = elastic_plan(1.0, vec![ProcedureKind::Shake(shake)]);
    plan.specimens = vec![specimen];
    let name = || "quake".to_owned();
    plan.grounds = vec![Ground {
        name: name(),
        file: name(),
        unit: 1.0,
        scale: 1.0,
        scale_uncertainty: 0.0,
        times,
        accelerations,
    }];
    run_unwatched(&plan)
}

/// Two elastic storeys on moving ground, compared with the same run in steps of 62.5 µs.
#[test]
fn a_frame_is_known_no_better_than_its_time_step_lets_it_be() {
    let drifts = |record: &Record| {
        let result = record.procedures[0].result("max_drift").unwrap();
        let psd_plan::formula::ResultValue::List(values) = result.value.clone() else {
            panic!("no list")
        };
        let ends = |storey: usize| {
            let parts = result.contributions.iter();
            let own: Vec<_> = parts.filter(|part| part.entry == storey).copied().collect();
            StepInterval::of(&own).map_or([0.0; 2], |step| step.ends)
        };
        let values = values.into_iter().enumerate();
        values
            .map(|(storey, value)| (value, ends(storey)))
            .collect::<Vec<(f64, [f64; 2])>>()
    };
    let fine = drifts(&base_excited_plan(6.25e-5));
    for time_step in [4e-3, 2e-3, 1e-3] {
        let coarse = drifts(&base_excited_plan(time_step));
        for ((value, [low, high]), (exact, _)) in coarse.into_iter().zip(&fine) {
            assert!(
                (value + low..=value + high).contains(exact),
                "{time_step}: {value} {low} {high}, {exact}"
            );
            assert!(
                high - low < 0.1 * exact,
                "{time_step}: {low} {high} of {exact}"
            );
        }
    }
}

/// A plastic impact on a specimen whose damping is stated with an uncertainty.
fn damped(damping: f64, uncertainty: f64) -> Record {
    let mut plan = sticking(2e-3);
    let ProcedureKind::Impact(impact) = &mut plan.procedures[0].kind else {
        panic!("no impact")
    };
    impact.point_mut().damping = Stated {
        source: Source::SpecimenMass(9),
        value: damping,
        uncertainty,
    }
    .formula();
    run_unwatched(&plan)
}

fn of_damping(record: &Record, name: &str) -> f64 {
    let parts = &record.procedures[0].result(name).unwrap().contributions;
    parts
        .iter()
        .find(|part| part.source == Source::SpecimenMass(9))
        .unwrap()
        .amount
}

/// c = 1 ± 2 N·s/m: damping below 0 is invalid, and u is the effect of 3 N·s/m.
#[test]
fn an_input_that_would_pass_its_bound_is_moved_to_the_other_side() {
    let peak = |damping: f64| {
        number(&damped(damping, 0.0), 0, "max_displacement")
            .0
            .unwrap()
    };
    let record = damped(1.0, 2.0);
    assert_eq!(record.outcome, Outcome::Completed);
    let (found, by_hand) = (
        of_damping(&record, "max_displacement"),
        peak(3.0) - peak(1.0),
    );
    assert!(
        (found / by_hand - 1.0).abs() < 0.02,
        "{found}, by hand {by_hand}"
    );
    let central = of_damping(&damped(5.0, 2.0), "max_displacement");
    assert!((central / (0.5 * (peak(7.0) - peak(3.0))) - 1.0).abs() < 0.02);
}

/// c = −0.5 ± 2 N·s/m is compatible with 0: the impact runs with 0, and the perturbed value is 0 + 2. −5 ± 2 is not valid damping, and
/// not a fault of the rig.
#[test]
fn a_damping_that_is_not_significantly_below_none_is_none() {
    let peak = |damping: f64| {
        number(&damped(damping, 0.0), 0, "max_displacement")
            .0
            .unwrap()
    };
    let record = damped(-0.5, 2.0);
    assert_eq!(record.outcome, Outcome::Completed);
    let (found, by_hand) = (
        of_damping(&record, "max_displacement"),
        peak(2.0) - peak(0.0),
    );
    assert!(
        (found / by_hand - 1.0).abs() < 0.02,
        "{found}, by hand {by_hand}"
    );
    assert_eq!(number(&record, 0, "max_displacement").0, Some(peak(0.0)));
    let (_, of_time_step, _) = record.procedures[0]
        .inputs
        .iter()
        .find(|(name, ..)| *name == "damping")
        .unwrap();
    assert_eq!(
        (of_time_step.value, of_time_step.uncertainty),
        (0.0, Some(2.0))
    );
    let remarks: Vec<&str> = record
        .events
        .iter()
        .filter(|event| event.kind == EventKind::Remark)
        .map(|event| event.text.as_str())
        .collect();
    assert!(
        remarks
            .iter()
            .any(|text| text.contains("not significantly below 0, and is set to 0")),
        "{remarks:?}"
    );
    let refused = damped(-5.0, 2.0);
    assert!(refused.procedures[0].history.above_critical().is_none());
    let Outcome::Blocked { reason } = &refused.outcome else {
        panic!("{:?}", refused.outcome)
    };
    assert!(
        reason.contains("below 0 by more than its expanded uncertainty"),
        "{reason}"
    );
}
