//! Weights on the floors of a frame: runs on a virtual rig, on computed storeys, and to a collapse.

use super::hybrid::{
    COMPUTED, INTEGRATORS, SPLITS, TESTED, bilinear, elastic, floors, same, shake, shaken, struck,
};
use crate::tests::testing::run_unwatched;
use crate::tests::uncertainty::frame::entry;
use psd_plan::formula::Formula::Constant;
use psd_plan::procedures::shake::block::{ENERGY_ERROR, MAX_BASE_SHEAR, MAX_DRIFT, STEPS};
use psd_plan::record::{Floors as _, History, Outcome, Record, ShakeHistory};
use psd_plan::{Contact, Integrator, Mode, Plan, ProcedureKind, ShakeDamping, Storey, Until};

/// Weights \[N\] and heights \[m\] of the floors: P/h is 15, 16 and 13 % of the initial stiffness, beyond the post-yield one of 5 %.
const WEIGHTS: [(f64, f64); 3] = [(9e4, 3.0), (8e4, 3.0), (1e5, 2.5)];

pub(crate) fn weighed(mut plan: Plan) -> Plan {
    let frame = plan.specimens[0].frame.as_ref().unwrap();
    let weigh = |storeys: &mut [Storey]| {
        for (storey, (gravity, height)) in storeys.iter_mut().zip(WEIGHTS) {
            (storey.gravity, storey.height) = (gravity, Some(height));
        }
    };
    plan.specimens[0].frame = Some(frame.with(weigh));
    plan
}

fn history(record: &Record) -> &ShakeHistory {
    match &record.procedures[0].history {
        History::Shake(history) => history,
        other => panic!("{other:?}"),
    }
}

fn number(record: &Record, name: &str) -> f64 {
    record.procedures[0].number(name).unwrap()
}

#[test]
fn a_split_frame_with_weights_moves_as_the_whole_frame() {
    for integrator in INTEGRATORS {
        let plan = |parts| weighed(shaken(parts, bilinear, integrator));
        let whole = run_unwatched(&plan([TESTED; 3]));
        for parts in SPLITS {
            let case = format!("{integrator:?}, {parts:?}");
            same(&run_unwatched(&plan(parts)), &whole, 0, 1e-12, &case);
        }
    }
}

#[test]
fn an_impact_on_a_split_frame_with_weights_is_that_on_the_whole_frame() {
    for (integrator, contact) in [
        (Integrator::Tangent, Contact::Rigid),
        (
            Integrator::Tangent,
            Contact::Restitution {
                coefficient: Constant(0.5),
            },
        ),
        (Integrator::AlphaOs { alpha: 0.0 }, Contact::Rigid),
    ] {
        for floor in [0, 2] {
            let plan = |parts| weighed(struck(parts, floor, integrator, contact.clone()));
            let whole = run_unwatched(&plan([TESTED; 3]));
            assert!(number(&whole, ENERGY_ERROR.name).abs() < 0.02);
            for parts in SPLITS.into_iter().step_by(2) {
                let case = format!("{integrator:?}, floor {floor}, {parts:?}");
                same(&run_unwatched(&plan(parts)), &whole, 0, 1e-11, &case);
            }
        }
    }
}

/// Without damping Σ(R − G X) is the inertia of all floors, −Σ M (Ẍ + `ü_g`).
#[test]
fn the_base_shear_is_that_of_the_inertia() {
    let masses = [2000.0, 1500.0, 1000.0];
    let parts = [TESTED, TESTED, COMPUTED];
    let mut plan = weighed(shaken(parts, bilinear, Integrator::Explicit));
    shake(&mut plan).damping = ShakeDamping::Rayleigh(Constant(0.0));
    let record = run_unwatched(&plan);
    let mut largest: f64 = 0.0;
    for step in &history(&record).steps {
        let accelerations = step.floors.acceleration.iter().zip(masses);
        let inertia: f64 = accelerations
            .map(|(own, mass)| mass * (own + step.ground_acceleration))
            .sum();
        let net = step.net_shear()[0];
        assert!((net + inertia).abs() < 1e-7 * net.abs().max(1e3));
        largest = largest.max(net.abs());
        // The springs carry P/h times the drift more.
        let above: f64 = WEIGHTS.iter().map(|(weight, _)| weight).sum();
        let gross = net + above / 3.0 * step.command()[0];
        assert!((step.shear()[0] - gross).abs() < 1e-7 * gross.abs().max(1e3));
    }
    let found = number(&record, MAX_BASE_SHEAR.name);
    assert!((found - largest).abs() < 1e-9 * largest);
}

/// The balance closes with the work of the weights; in tangent form an elastic frame has rounding alone.
#[test]
fn the_energy_balance_closes_with_the_work_of_the_weights() {
    for (model, integrator, within) in [
        (elastic as fn(f64) -> _, Integrator::Tangent, 1e-10),
        (bilinear, Integrator::Tangent, 0.02),
        (bilinear, Integrator::AlphaOs { alpha: -0.05 }, 0.05),
    ] {
        let plan = weighed(shaken([TESTED, COMPUTED, COMPUTED], model, integrator));
        let record = run_unwatched(&plan);
        assert!(number(&record, ENERGY_ERROR.name).abs() < within);
        for step in &history(&record).steps {
            let e = &step.energies;
            let parts = e.kinetic + e.restoring + e.damping + e.error;
            assert!((parts - e.input - e.gravity).abs() < 1e-9 * (1.0 + parts.abs()));
            let drifts = step.drift();
            let above = |storey: usize| -> f64 { WEIGHTS[storey..].iter().map(|it| it.0).sum() };
            let work: f64 = (0..3)
                .map(|storey| 0.5 * above(storey) / WEIGHTS[storey].1 * drifts[storey].powi(2))
                .sum();
            assert!((e.gravity - work).abs() < 1e-9 * (1.0 + work));
        }
    }
}

fn collapsing(time_step: f64) -> Plan {
    let mut plan = weighed(shaken(
        [TESTED, COMPUTED, COMPUTED],
        bilinear,
        Integrator::Tangent,
    ));
    let shake = shake(&mut plan);
    shake.until = Some(0.15);
    shake.scale = Constant(0.45);
    shake.duration = Some(Constant(10.0));
    shake.stepping.time_step = Constant(time_step);
    plan
}

#[test]
fn a_drift_ends_the_run_and_the_time_of_collapse_converges() {
    let times = [0.008, 0.004, 0.002, 0.001].map(|time_step| {
        let record = run_unwatched(&collapsing(time_step));
        assert_eq!(record.outcome, Outcome::Completed);
        let history = history(&record);
        let storey = history.drift_reached.expect("a collapse");
        let [.., before, last] = &history.steps[..] else {
            panic!()
        };
        assert!(last.drift()[storey].abs() >= 0.15);
        assert!(before.drift().iter().all(|drift| drift.abs() < 0.15));
        let said = format!("storey {} reached a drift of 0.15 m", storey + 1);
        let says = |event: &psd_plan::record::Event| event.text.contains(&said);
        assert!(record.events.iter().any(says), "{:?}", record.events);
        last.floors.time
    });
    assert!(times[3] > 0.5, "{times:?}");
    for time in &times[1..] {
        assert!((time - times[3]).abs() < 0.005, "{times:?}");
    }
}

/// The re-integrated run follows the recorded one to the drift that ended it, and has as many steps.
#[test]
fn results_with_weights_have_their_uncertainty() {
    for until in [None, Some(0.012)] {
        let mut plan = weighed(shaken(
            [TESTED, COMPUTED, TESTED],
            bilinear,
            Integrator::Explicit,
        ));
        shake(&mut plan).until = until;
        plan.rig.calibration.force_uncertainty = 0.01;
        let record = run_unwatched(&plan);
        assert_eq!(history(&record).drift_reached.is_some(), until.is_some());
        let (drift, parts) = entry(&record, MAX_DRIFT.name, 0);
        assert!(drift > 0.0 && !parts.is_empty(), "{:?}", record.events);
    }
}

/// Actuators that never stop, and a striker that a drift of the struck frame ends.
#[test]
fn a_drift_ends_an_impact_and_a_continuous_test() {
    let mut plan = weighed(shaken([TESTED; 3], elastic, Integrator::Explicit));
    shake(&mut plan).stepping.mode = Mode::Continuous { time_scale: 100.0 };
    let whole = run_unwatched(&plan);
    shake(&mut plan).until = Some(0.01);
    let ended = run_unwatched(&plan);
    assert!(number(&ended, STEPS.name) < number(&whole, STEPS.name));
    let mut plan = weighed(struck([TESTED; 3], 1, Integrator::Tangent, Contact::Rigid));
    let ProcedureKind::Impact(impact) = &mut plan.procedures[0].kind else {
        panic!()
    };
    impact.until = Until::Drift(0.01);
    let record = run_unwatched(&plan);
    assert_eq!(record.outcome, Outcome::Completed);
    let floors = floors(&record, 0);
    let reaches = |floors: &psd_plan::record::FloorMotion| {
        floors.drift().iter().any(|drift| drift.abs() >= 0.01)
    };
    let (last, before) = floors.split_last().unwrap();
    assert!(reaches(last) && !before.iter().any(reaches));
}
