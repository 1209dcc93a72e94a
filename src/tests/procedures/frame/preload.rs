//! Constant axial load on a tested storey: its P-Δ in the reading of the rig, beside that of the weights in the computer.

use super::gravity::weighed;
use super::hybrid::{COMPUTED, INTEGRATORS, SPLITS, TESTED, bilinear, shake, shaken};
use super::scaled::{at_scale, of};
use super::{close, rest};
use crate::tests::testing::{elastic_plan, run_unwatched};
use psd_plan::formula::Formula::Constant;
use psd_plan::procedures::unload::block::RESIDUAL_DISPLACEMENT;
use psd_plan::record::{
    EventKind, Floors as _, History, Outcome, ProcedureRecord, Record, ShakeHistory, ShakeStep,
    UnloadHistory, UnloadStep, Unloaded,
};
use psd_plan::{
    AxialAxis, AxisPlan, Behaviour, Frame, Integrator, Interval, Link, Move, Part, Plan, Preload,
    Procedure, ProcedureKind, Storey,
};

const HEIGHT: f64 = 3.0;

/// Loads a storey with this force \[N\] before all else.
pub(crate) fn preloaded(plan: &Plan, storey: usize, force: f64, p_delta: f64) -> Plan {
    let mut plan = plan.clone();
    let band = Interval {
        low: -0.1,
        high: 0.1,
    };
    plan.rig.simulated_axes = vec![AxisPlan::default(); plan.degrees_of_freedom()];
    plan.rig.simulated_axes.push(AxisPlan {
        displacement: Some(band),
        axial: Some(AxialAxis {
            storey,
            rate: 1e4,
            tolerance: 1.0,
            p_delta,
        }),
        ..AxisPlan::default()
    });
    let load = Procedure {
        name: "load".to_owned(),
        kind: ProcedureKind::Preload(Preload { storey, force }),
    };
    plan.procedures.insert(0, load);
    let enter = |storeys: &mut [Storey]| {
        let loaded = &mut storeys[storey];
        loaded.axial_load = p_delta * force * loaded.part.scale().forces();
    };
    let frame = plan.specimens[0].frame.as_ref().unwrap().with(enter);
    plan.specimens[0].frame = Some(frame);
    plan
}

/// The record of a loaded run without that of its preload.
fn after_preload(plan: &Plan) -> Record {
    let mut record = run_unwatched(plan);
    assert_eq!(record.outcome, Outcome::Completed, "{:?}", record.events);
    record.procedures.remove(0);
    record
}

/// Ground motion that makes the frame yield, and not fall.
fn gentle(parts: [Part; 3], integrator: Integrator) -> Plan {
    let mut plan = shaken(parts, bilinear, integrator);
    shake(&mut plan).scale = Constant(0.3);
    plan
}

fn history(record: &Record) -> &ShakeHistory {
    match &record.procedures[0].history {
        History::Shake(history) => history,
        other => panic!("{other:?}"),
    }
}

/// The floors have the same motion and the same net shear. The restoring force contains the P-Δ that the rig measures, and differs.
fn moves_alike(found: &Record, wanted: &Record, case: &str) {
    let (found, wanted) = (&history(found).steps, &history(wanted).steps);
    assert_eq!(found.len(), wanted.len(), "{case}");
    let shear = |step: &ShakeStep| step.net_shear()[0];
    let largest = |value: &dyn Fn(&ShakeStep) -> f64| {
        wanted
            .iter()
            .map(value)
            .fold(0.0, |most: f64, value| most.max(value.abs()))
    };
    let (most_shear, most) = (largest(&shear), largest(&|step| step.command()[2]));
    assert!(most > 0.03 && most < 0.3, "{case}: {most} m");
    for (found, wanted) in found.iter().zip(wanted) {
        let at = format!("{case}, step {}", wanted.step);
        close_to(found.command(), wanted.command(), 1e-9 * most, &at);
        close_to(&[shear(found)], &[shear(wanted)], 1e-9 * most_shear, &at);
    }
}

fn close_to(found: &[f64], wanted: &[f64], within: f64, case: &str) {
    for (found, wanted) in found.iter().zip(wanted) {
        assert!(
            (found - wanted).abs() <= within,
            "{case}: {found}, not {wanted}"
        );
    }
}

/// The motion is that of the weights, wherever their P-Δ is counted: on the rig, in the computer, or in both.
#[test]
fn a_frame_moves_alike_wherever_p_delta_is_counted() {
    for integrator in INTEGRATORS {
        for parts in [[TESTED; 3]].into_iter().chain(SPLITS) {
            let plan = weighed(gentle(parts, integrator));
            let in_the_computer = run_unwatched(&plan);
            let Some(storey) = parts.iter().position(|part| *part != COMPUTED) else {
                continue;
            };
            let above = [2.7e5, 1.8e5, 1e5][storey];
            for (force, p_delta) in [
                (above, 1.0),
                (0.4 * above, 1.0),
                (above, 0.0),
                (1.3 * above, 0.5),
            ] {
                let loaded = preloaded(&plan, storey, force, p_delta);
                let case = format!("{integrator:?}, {parts:?}, {force} N, φ = {p_delta}");
                let found = after_preload(&loaded);
                moves_alike(&found, &in_the_computer, &case);
            }
        }
    }
}

/// 2 N/λ² of a column at half scale that is one of two.
#[test]
fn a_column_at_scale_carries_its_share() {
    let plan = weighed(gentle([TESTED, COMPUTED, COMPUTED], INTEGRATORS[0]));
    let in_the_computer = run_unwatched(&plan);
    let scale = of(0.5, 0.25, 2.0);
    let loaded = preloaded(&at_scale(&plan, scale), 0, 2.7e5 / 8.0, 1.0);
    let frame = loaded.specimens[0].frame.as_ref().unwrap();
    assert_eq!(frame.storeys[0].axial_load, 2.7e5);
    moves_alike(&after_preload(&loaded), &in_the_computer, "half scale");
}

/// Without weights the P-Δ of the load is in the motion: that of a weight on the lowest floor alone.
#[test]
fn without_weights_the_load_is_that_of_the_specimen() {
    for integrator in INTEGRATORS {
        let mut plan = gentle([TESTED; 3], integrator);
        let with = |gravity: f64| {
            move |storeys: &mut [Storey]| {
                storeys[0].gravity = gravity;
                storeys[0].height = Some(HEIGHT);
            }
        };
        let frame = plan.specimens[0].frame.clone().unwrap();
        plan.specimens[0].frame = Some(frame.with(with(2e5)));
        let weight = run_unwatched(&plan);
        plan.specimens[0].frame = Some(frame.with(with(0.0)));
        let found = after_preload(&preloaded(&plan, 0, 2e5, 1.0));
        moves_alike(&found, &weight, &format!("{integrator:?}"));
    }
}

/// One column that yields at 10 mm: 4 MN/m, 40 kN, post-yield 8 %.
fn column(procedures: Vec<ProcedureKind>) -> Plan {
    let mut plan = elastic_plan(1.0, procedures);
    let behaviour = Behaviour::Bilinear {
        stiffness: 4e6,
        yield_force: 4e4,
        post_yield_ratio: 0.08,
    };
    plan.specimens[0].behaviour = None;
    plan.specimens[0].frame = Some(Frame::of_storeys(vec![Storey {
        height: Some(HEIGHT),
        ..Storey::new(1000.0, 4e6, behaviour)
    }]));
    plan
}

fn to(displacement: f64) -> ProcedureKind {
    ProcedureKind::Move(Move {
        to: Constant(displacement),
        speed: None,
    })
}

/// The lateral reading is R − φ N u/h, and the column shortens by u²/(2 h).
#[test]
fn the_lateral_reading_has_the_p_delta_of_the_load() {
    for p_delta in [1.0, 0.0, 0.6, 1.2] {
        let force = 2.5e5;
        let plan = preloaded(&column(vec![to(0.006), to(-0.004)]), 0, force, p_delta);
        let record = after_preload(&plan);
        for (procedure, u) in record.procedures.iter().zip([0.006, -0.004]) {
            let History::Move(steps) = &procedure.history else {
                panic!()
            };
            let wanted = 4e6 * u - p_delta * force * u / HEIGHT;
            assert!((steps[0].restoring_force - wanted).abs() < 1e-9 * wanted.abs());
            let axial = procedure.axial.last().unwrap();
            assert_eq!((axial.storey, axial.target, axial.force), (1, force, force));
            assert!((axial.displacement - u * u / (2.0 * HEIGHT)).abs() < 1e-15);
        }
    }
}

/// From u with R: to (K u − R)/(K − φ N/h) under the load, where φ N u/h remains when it is taken off, and then to u − R/K.
#[test]
fn unloading_takes_the_load_off_and_leaves_the_set_of_the_column() {
    let (reached, stiffness, force, p_delta) = (0.03, 4e6, 2.5e5, 0.8);
    let plan = preloaded(&column(vec![to(reached), rest(None)]), 0, force, p_delta);
    let record = after_preload(&plan);
    let spring = 4e4 + 0.08 * stiffness * (reached - 0.01);
    let leaning = p_delta * force / HEIGHT;
    let under_load = (stiffness * reached - spring) / (stiffness - leaning);
    let set = reached - spring / stiffness;
    let procedure = &record.procedures[1];
    let found = procedure.number(RESIDUAL_DISPLACEMENT.name).unwrap();
    assert!(
        (found - set).abs() < 1e-3 * leaning * set / stiffness,
        "{found}, not {set}"
    );
    let History::Unload(UnloadHistory {
        of: Unloaded::Floors,
        steps,
    }) = &procedure.history
    else {
        panic!()
    };
    let at = |step: &UnloadStep| (step.displacement[0], step.restoring_force[0]);
    let turn = steps
        .windows(2)
        .position(|pair| at(&pair[0]).0 == at(&pair[1]).0)
        .expect("the load goes while the axis holds");
    let [before, after] = [at(&steps[turn]), at(&steps[turn + 1])];
    close(&[before.0], &[under_load], 1e-3 * (reached - under_load));
    close(&[after.1 - before.1], &[leaning * before.0], 1e-6 * leaning);
    let axial = &procedure.axial;
    assert_eq!((axial[0].force, axial.last().unwrap().force), (force, 0.0));
    let numbers: Vec<u64> = steps.iter().map(|step| step.step).collect();
    assert!(
        numbers.windows(2).all(|pair| pair[0] < pair[1]),
        "{numbers:?}"
    );
}

/// Between two tests it comes to rest under the load: (K u − R)/(K − φ N/h).
#[test]
fn unloading_keeps_an_axial_load_that_another_test_needs() {
    let (reached, stiffness, force) = (0.03, 4e6, 2.5e5);
    let mut between = rest(None);
    if let ProcedureKind::Unload(unload) = &mut between {
        unload.keep_axial_load = true;
    }
    let procedures = vec![to(reached), between, to(0.02), rest(None)];
    let plan = preloaded(&column(procedures), 0, force, 1.0);
    let record = after_preload(&plan);
    let spring = 4e4 + 0.08 * stiffness * (reached - 0.01);
    let under_load = (stiffness * reached - spring) / (stiffness - force / HEIGHT);
    let [_, between, after, rest] = &record.procedures[..] else {
        panic!()
    };
    let found = between.number(RESIDUAL_DISPLACEMENT.name).unwrap();
    close(&[found], &[under_load], 1e-3 * (reached - under_load));
    let last = |procedure: &ProcedureRecord| procedure.axial.last().unwrap().force;
    assert_eq!(
        [last(between), last(after), last(rest)],
        [force, force, 0.0]
    );
}

/// The operator who inspects the specimen reads that it is loaded.
#[test]
fn an_inspection_states_the_axial_load() {
    let look = || ProcedureKind::Inspect {
        note: "look".to_owned(),
    };
    let procedures = vec![look(), to(0.003), rest(None), look()];
    let record = after_preload(&preloaded(&column(procedures), 0, 2.5e5, 1.0));
    let inspections = record.events.iter();
    let inspections = inspections.filter(|event| event.kind == EventKind::Inspection);
    let texts: Vec<&str> = inspections.map(|event| event.text.as_str()).collect();
    let loaded = "look; AXIAL of storey 1 holds 250 kN in FORCE CONTROL";
    assert_eq!(texts, [loaded, "look"]);
}

/// The guard holds the rig where the force leaves its tolerance, the displacement its band, or the target the limits of the force.
#[test]
fn the_guard_stops_a_load_that_leaves_its_tolerance_its_band_or_its_limits() {
    let sound = preloaded(&column(vec![to(0.03)]), 0, 2.5e5, 1.0);
    let aborted = |plan: &Plan, wanted: &str| {
        let record = run_unwatched(plan);
        let is_aborted = matches!(record.outcome, Outcome::Aborted { .. });
        assert!(is_aborted, "{:?}", record.events);
        let text = &record.events.last().unwrap().text;
        assert!(text.contains(wanted), "{text}");
    };
    assert_eq!(run_unwatched(&sound).outcome, Outcome::Completed);
    let mut noisy = sound.clone();
    if let Link::Virtual(link) = &mut noisy.rig.link {
        link.noise = 20.0;
    }
    aborted(&noisy, "force error of axis 2");
    let mut narrow = sound.clone();
    // u²/(2 h) = 0.15 mm
    narrow.rig.simulated_axes[1].displacement = Some(Interval {
        low: -1e-4,
        high: 1e-4,
    });
    aborted(&narrow, "measured displacement of axis 2");
    let mut limited = sound.clone();
    limited.limits.force = Interval {
        low: -2e5,
        high: 2e5,
    };
    aborted(&limited, "target force of axis 2 0.225 MN");
}

/// An upper column of the frame, on the specimen below: its P-Δ is that of its own drift.
#[test]
fn an_upper_storey_leans_by_its_own_drift() {
    let parts = [TESTED, TESTED, COMPUTED];
    let plan = weighed(gentle(parts, Integrator::Tangent));
    let found = after_preload(&preloaded(&plan, 1, 1.8e5, 1.0));
    moves_alike(&found, &run_unwatched(&plan), "second storey");
}

#[test]
fn results_under_a_load_have_their_uncertainty() {
    let mut plan = weighed(gentle([TESTED, COMPUTED, TESTED], Integrator::Explicit));
    shake(&mut plan).duration = Some(Constant(0.5));
    plan.rig.calibration.force_uncertainty = 0.01;
    let loaded = preloaded(&plan, 0, 2.7e5, 1.0);
    let contributions = |record: &Record| -> Vec<f64> {
        let results = record.procedures.last().unwrap().results.iter();
        let parts = results.flat_map(|result| &result.contributions);
        parts.map(|part| part.amount).collect()
    };
    let found = contributions(&run_unwatched(&loaded));
    assert!(!found.is_empty());
}
