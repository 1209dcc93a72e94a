//! Frames of which the rig carries a part: a split frame has the results of the whole frame, in every arrangement.

use crate::tests::testing::{elastic_plan, every, run_unwatched};
use crate::tests::uncertainty::frame::{base_excited_plan, entry, from};
use psd_plan::formula::Formula::Constant;
use psd_plan::formula::{ResultValue, UncertaintyStatus};
use psd_plan::procedures::shake::block::{FINAL_DRIFT, MAX_DRIFT};
use psd_plan::procedures::unload::block as unload;
use psd_plan::record::{FloorMotion, Floors as _, History, Outcome, Record};
use psd_plan::uncertainty::Source;
use psd_plan::{
    Behaviour, Contact, Impact, ImpactTarget, Integrator, Link, Mode, Part, Plan, Procedure,
    ProcedureKind, Scale, Shake, ShakeDamping, Stepping, Storey, StoreyTarget, Unload, Until,
    VirtualLink,
};

pub(crate) const TESTED: Part = Part::TESTED;
pub(super) const APART: Part = Part::Tested {
    apart: true,
    scale: Scale::FULL,
};
pub(crate) const COMPUTED: Part = Part::Computed;

/// First, middle and highest storey tested; two in one assembly; an assembly on a computed storey; two assemblies; adjacent but apart;
/// none tested.
pub(super) const SPLITS: [[Part; 3]; 9] = [
    [TESTED, COMPUTED, COMPUTED],
    [COMPUTED, TESTED, COMPUTED],
    [COMPUTED, COMPUTED, TESTED],
    [TESTED, TESTED, COMPUTED],
    [COMPUTED, TESTED, TESTED],
    [TESTED, COMPUTED, TESTED],
    [TESTED, APART, COMPUTED],
    [TESTED, APART, APART],
    [COMPUTED, COMPUTED, COMPUTED],
];

pub(super) const INTEGRATORS: [Integrator; 4] = [
    Integrator::Tangent,
    Integrator::Explicit,
    Integrator::AlphaOs { alpha: 0.0 },
    Integrator::AlphaOs { alpha: -0.05 },
];

/// Each storey yields at a drift of 10 mm.
pub(crate) fn bilinear(stiffness: f64) -> Behaviour {
    Behaviour::Bilinear {
        stiffness,
        yield_force: 0.01 * stiffness,
        post_yield_ratio: 0.05,
    }
}

/// No tangent exceeds the initial stiffness.
pub(super) fn bouc_wen(stiffness: f64) -> Behaviour {
    Behaviour::BoucWen {
        stiffness,
        yield_force: 0.01 * stiffness,
        post_yield_ratio: 0.05,
        sharpness: 2.0,
        beta: 0.5,
    }
}

pub(crate) fn elastic(stiffness: f64) -> Behaviour {
    Behaviour::Elastic { stiffness }
}

/// Storeys of 600, 400 and 300 kN/m on ground that excites them beyond yield.
pub(crate) fn shaken(
    parts: [Part; 3],
    model: fn(f64) -> Behaviour,
    integrator: Integrator,
) -> Plan {
    let storey = |(mass, stiffness), part| Storey {
        part,
        ..Storey::new(mass, stiffness, model(stiffness))
    };
    let storeys = [(2000.0, 6e5), (1500.0, 4e5), (1000.0, 3e5)];
    let storeys = storeys.into_iter().zip(parts);
    let sample = |sample: u32| {
        let time = 0.01 * f64::from(sample);
        6.0 * (10.0 * time).sin() + 4.0 * (17.0 * time).sin()
    };
    let mut plan = base_excited_plan(
        storeys
            .map(|(storey_of, part)| storey(storey_of, part))
            .collect(),
        (0..150).map(sample).collect(),
        0.01,
    );
    let shake = shake(&mut plan);
    shake.stepping.integrator = integrator;
    shake.damping = ShakeDamping::Rayleigh(Constant(0.02));
    plan
}

pub(super) fn shake(plan: &mut Plan) -> &mut Shake {
    match &mut plan.procedures[0].kind {
        ProcedureKind::Shake(shake) => shake,
        other => panic!("{other:?}"),
    }
}

/// A striker of 500 kg at 3 m/s on a floor of the same frame.
pub(super) fn struck(
    parts: [Part; 3],
    floor: usize,
    integrator: Integrator,
    contact: Contact,
) -> Plan {
    let plan = shaken(parts, bilinear, integrator);
    let impact = Impact {
        specimen: 0,
        striker: 0,
        target: ImpactTarget::Storey(StoreyTarget {
            storey: floor,
            damping: ShakeDamping::Rayleigh(Constant(0.02)),
            damping_uncertainty: 0.0,
        }),
        contact,
        stepping: Stepping {
            integrator,
            max_tangent_ratio: Constant(2.0),
            ..every(0.005)
        },
        duration: Constant(0.5),
        until: Until::Duration,
    };
    let mut struck = elastic_plan(1.0, vec![ProcedureKind::Impact(impact)]);
    struck.strikers[0].mass = 500.0;
    struck.strikers[0].velocity = 3.0;
    struck.specimens = plan.specimens;
    struck
}

pub(super) fn floors(record: &Record, procedure: usize) -> Vec<FloorMotion> {
    match &record.procedures[procedure].history {
        History::Shake(history) => history
            .steps
            .iter()
            .map(|step| step.floors.clone())
            .collect(),
        History::Impact(history) => {
            let frame = history.frame.as_ref().unwrap();
            frame
                .floors
                .iter()
                .map(|step| step.floors.clone())
                .collect()
        }
        _ => panic!("no floors"),
    }
}

/// One quantity of the floors.
type Quantity = fn(&FloorMotion) -> &Vec<f64>;

/// Every quantity of every step differs by less than `within` of its largest value.
pub(super) fn same(found: &Record, wanted: &Record, procedure: usize, within: f64, case: &str) {
    assert_eq!(found.outcome, Outcome::Completed, "{case}");
    assert_eq!(wanted.outcome, Outcome::Completed, "{case}");
    let (found, wanted) = (floors(found, procedure), floors(wanted, procedure));
    assert_eq!(found.len(), wanted.len(), "{case}");
    let quantities: [(&str, Quantity); 6] = [
        ("command", |floors| &floors.command),
        ("displacement", |floors| &floors.displacement),
        ("computed", |floors| &floors.computed),
        ("velocity", |floors| &floors.velocity),
        ("acceleration", |floors| &floors.acceleration),
        ("restoring force", |floors| &floors.restoring_force),
    ];
    for (name, of) in quantities {
        let values = || wanted.iter().flat_map(of);
        let largest = values().fold(0.0, |most: f64, value| most.max(value.abs()));
        let found = found.iter().flat_map(of);
        let off = found
            .zip(values())
            .map(|(found, wanted)| (found - wanted).abs());
        let off = off.fold(0.0, f64::max);
        assert!(
            largest > 0.0 && off <= within * largest,
            "{case}: {name} off by {off} of {largest}"
        );
    }
}

#[test]
fn a_split_frame_moves_as_the_whole_frame() {
    for model in [elastic, bilinear, bouc_wen] {
        for integrator in INTEGRATORS {
            let whole = run_unwatched(&shaken([TESTED; 3], model, integrator));
            let drifts = whole.procedures[0].result(MAX_DRIFT.name).unwrap();
            assert!(drifts.value.values().iter().all(|drift| *drift > 0.012));
            for parts in SPLITS {
                let case = format!("{integrator:?}, {:?}, {parts:?}", model(1.0));
                let split = run_unwatched(&shaken(parts, model, integrator));
                same(&split, &whole, 0, 1e-11, &case);
            }
        }
    }
}

#[test]
fn an_impact_on_any_floor_of_a_split_frame_is_that_on_the_whole_frame() {
    let contacts = [
        (Integrator::Tangent, Contact::Rigid),
        (
            Integrator::Explicit,
            Contact::Limit {
                force: Constant(2e4),
            },
        ),
        (
            Integrator::Tangent,
            Contact::Restitution {
                coefficient: Constant(0.5),
            },
        ),
        (Integrator::AlphaOs { alpha: 0.0 }, Contact::Rigid),
    ];
    for (integrator, contact) in contacts {
        for floor in 0..3 {
            let plan = |parts| struck(parts, floor, integrator, contact.clone());
            let whole = run_unwatched(&plan([TESTED; 3]));
            for parts in SPLITS {
                let case = format!("{integrator:?}, floor {floor}, {parts:?}");
                same(&run_unwatched(&plan(parts)), &whole, 0, 1e-11, &case);
            }
        }
    }
}

/// The actuators never stop; an ideal actuator is at its target when it is read. Its path to the target does not matter to a spring.
#[test]
fn without_a_stop_a_split_frame_moves_as_the_whole_frame() {
    let plan = |parts| {
        let mut plan = shaken(parts, elastic, Integrator::AlphaOs { alpha: -0.05 });
        shake(&mut plan).stepping.mode = Mode::Continuous { time_scale: 100.0 };
        plan
    };
    let whole = run_unwatched(&plan([TESTED; 3]));
    for parts in SPLITS.into_iter().filter(|parts| *parts != [COMPUTED; 3]) {
        let case = format!("{parts:?}");
        same(&run_unwatched(&plan(parts)), &whole, 0, 1e-11, &case);
    }
}

/// An actuator ends every increment 5 % short. On elastic storeys r* = K d̃, whatever the actuators miss, if each assembly is corrected
/// by its own stiffness in its own coordinates.
#[test]
fn the_i_modification_corrects_each_assembly_in_its_own_coordinates() {
    for parts in SPLITS {
        let mut plan = shaken(parts, elastic, Integrator::Explicit);
        let ideal = run_unwatched(&plan);
        plan.rig.link = Link::Virtual(VirtualLink {
            tracking: 0.05,
            ..VirtualLink::default()
        });
        shake(&mut plan).stepping.i_modification = true;
        let short = run_unwatched(&plan);
        let (short, ideal) = (floors(&short, 0), floors(&ideal, 0));
        let most = |of: fn(&FloorMotion) -> f64| {
            ideal
                .iter()
                .map(of)
                .fold(0.0, |most: f64, value| most.max(value.abs()))
        };
        let largest = most(|floors| floors.computed[2]);
        let missed = short
            .iter()
            .map(|floors| floors.displacement[2] - floors.command[2]);
        let missed = missed.fold(0.0, |most: f64, value| most.max(value.abs()));
        assert_eq!(missed > 1e-3 * largest, parts != [COMPUTED; 3], "{parts:?}");
        for (short, ideal) in short.iter().zip(&ideal) {
            for (short, ideal) in short.computed.iter().zip(&ideal.computed) {
                assert!((short - ideal).abs() < 1e-11 * largest, "{parts:?}");
            }
        }
    }
}

/// The measured drift of a tested storey is that of its actuators, and of a computed storey the imposed one.
#[test]
fn a_measured_floor_stands_on_the_measured_floors_below() {
    let mut plan = shaken([TESTED, COMPUTED, TESTED], bilinear, Integrator::Explicit);
    plan.rig.link = Link::Virtual(VirtualLink {
        resolution: 1e-3,
        ..VirtualLink::default()
    });
    let record = run_unwatched(&plan);
    let quantum = |drift: f64| (drift / 1e-3 - (drift / 1e-3).round()).abs() < 1e-9;
    let mut off = 0.0_f64;
    for floors in floors(&record, 0) {
        let [lower, middle, upper] = floors.drift()[..] else {
            panic!()
        };
        assert!((middle - (floors.command[1] - floors.command[0])).abs() < 1e-15);
        let measured = floors.displacement[2] - floors.displacement[1];
        assert!(quantum(floors.displacement[0]) && quantum(measured));
        off = off
            .max((measured - upper).abs())
            .max((floors.displacement[0] - lower).abs());
    }
    assert!(off > 4e-4 && off < 5.1e-4, "{off}");
}

/// The frame is shaken, unloaded, and shaken again.
pub(super) fn twice(parts: [Part; 3]) -> Plan {
    let mut plan = shaken(parts, bilinear, Integrator::Explicit);
    let again = plan.procedures[0].clone();
    let rest = ProcedureKind::Unload(Unload {
        specimen: 0,
        stiffness: None,
        within: Some(Constant(1e-6)),
        speed: None,
        keep_axial_load: false,
    });
    let named = |name: &str, kind| Procedure {
        name: name.to_owned(),
        kind,
    };
    plan.procedures
        .extend([named("rest", rest), named("again", again.kind)]);
    plan
}

/// Both storeys are left with the plastic drift of their shear history, the computed one without a motion; the second test begins there.
#[test]
fn computed_storeys_keep_their_state_and_begin_again_at_zero_shear() {
    let whole = run_unwatched(&twice([TESTED; 3]));
    for parts in SPLITS {
        let split = run_unwatched(&twice(parts));
        let drifts = |record: &Record| match &record.procedures[1].result("residual_drift") {
            Some(result) => result.value.values().to_vec(),
            None => panic!(),
        };
        for (split, whole) in drifts(&split).iter().zip(drifts(&whole)) {
            assert!(
                (split - whole).abs() < 1e-9 && whole.abs() > 1e-5,
                "{split} {whole}"
            );
        }
        same(&split, &whole, 2, 1e-6, &format!("{parts:?}"));
        let begins = &floors(&split, 2)[0];
        assert!(
            begins
                .restoring_force
                .iter()
                .all(|force| force.abs() < 1e-5)
        );
    }
    // Without an unloading, only the rig keeps its position: the computed storeys come to rest.
    let mut plan = twice([TESTED, COMPUTED, COMPUTED]);
    plan.procedures.remove(1);
    let record = run_unwatched(&plan);
    let (ended, begins) = (floors(&record, 0), floors(&record, 1));
    let (ended, begins) = (ended.last().unwrap(), &begins[0]);
    assert_eq!(begins.command[0], ended.command[0]);
    let sheared = ended.shear()[1];
    assert!(
        sheared.abs() > 100.0 && begins.shear()[1].abs() < 1e-6,
        "{sheared}"
    );
    let moved = begins.drift()[1] - ended.drift()[1];
    assert!(
        (moved + sheared / 4e5).abs() < 1e-12,
        "unloads along its initial stiffness"
    );
}

/// A load cell that reads one per cent too much is a storey that is stiffer by one per cent: the computed storeys change with the motion.
#[test]
fn the_calibration_of_the_tested_storey_is_the_only_one_of_the_rig() {
    let parts = [COMPUTED, TESTED, COMPUTED];
    let stiffer = |by: f64| {
        let mut plan = shaken(parts, elastic, Integrator::Explicit);
        let frame = plan.specimens[0].frame.as_ref().unwrap();
        let stiffer = |storeys: &mut [Storey]| {
            storeys[1].behaviour = storeys[1].behaviour.scaled(1.0 + by);
        };
        plan.specimens[0].frame = Some(frame.with(stiffer));
        run_unwatched(&plan)
    };
    let mut plan = shaken(parts, elastic, Integrator::Explicit);
    plan.rig.calibration.force_uncertainty = 0.01;
    plan.rig.calibration.displacement_uncertainty = 0.002;
    let record = run_unwatched(&plan);
    let drifts = |record: &Record| match &record.procedures[0].result(FINAL_DRIFT.name) {
        Some(result) => result.value.values().to_vec(),
        None => panic!(),
    };
    let (more, less) = (drifts(&stiffer(0.01)), drifts(&stiffer(-0.01)));
    for storey in 0..3 {
        let (_, parts) = entry(&record, FINAL_DRIFT.name, storey);
        let wanted = 0.5 * (more[storey] - less[storey]);
        let found = from(&parts, Source::ForceScale(0));
        assert!(
            (found.abs() - wanted.abs()).abs() < 0.01 * wanted.abs(),
            "storey {storey}: {found} for {wanted}"
        );
        assert!(from(&parts, Source::DisplacementScale(0)) != 0.0);
        let other = |part: &&psd_plan::uncertainty::Contribution| matches!(part.source, Source::ForceScale(axis) | Source::DisplacementScale(axis) if axis > 0);
        assert!(parts.iter().find(other).is_none());
    }
}

/// The uncertainty of the stiffness of a computed storey is that of its model, too.
#[test]
fn a_computed_storey_is_uncertain_with_its_model() {
    let parts = [COMPUTED, TESTED, COMPUTED];
    let stiffer = |by: f64| {
        let mut plan = shaken(parts, elastic, Integrator::Explicit);
        let frame = plan.specimens[0].frame.as_ref().unwrap();
        let stiffer = |storeys: &mut [Storey]| {
            storeys[0].stiffness *= 1.0 + by;
            storeys[0].behaviour = storeys[0].behaviour.scaled(1.0 + by);
        };
        plan.specimens[0].frame = Some(frame.with(stiffer));
        run_unwatched(&plan)
    };
    let mut plan = shaken(parts, elastic, Integrator::Explicit);
    let frame = plan.specimens[0].frame.as_ref().unwrap();
    let uncertain = |storeys: &mut [Storey]| storeys[0].stiffness_uncertainty = 6e3;
    plan.specimens[0].frame = Some(frame.with(uncertain));
    let record = run_unwatched(&plan);
    let drift =
        |record: &Record| match &record.procedures[0].result(FINAL_DRIFT.name).unwrap().value {
            ResultValue::List(values) => values[0],
            ResultValue::Number { .. } => panic!(),
        };
    let wanted = 0.5 * (drift(&stiffer(0.01)) - drift(&stiffer(-0.01)));
    let (_, parts) = entry(&record, FINAL_DRIFT.name, 0);
    let source = Source::StoreyStiffness {
        specimen: 0,
        storey: 0,
    };
    let found = from(&parts, source);
    assert!(
        (found.abs() - wanted.abs()).abs() < 0.01 * wanted.abs() && wanted != 0.0,
        "{found} for {wanted}"
    );
}

/// A floor on a computed storey has no known uncertainty: its storey was not measured. The drift of a measured storey has one.
#[test]
fn what_stands_on_a_computed_storey_has_no_uncertainty() {
    let mut plan = shaken([TESTED, COMPUTED, TESTED], bilinear, INTEGRATORS[0]);
    plan.rig.calibration.force_uncertainty = 0.01;
    plan.rig.calibration.displacement_uncertainty = 0.002;
    plan.procedures.push(Procedure {
        name: "rest".to_owned(),
        kind: super::rest(None),
    });
    let record = run_unwatched(&plan);
    let known = |name: &str| -> Vec<bool> {
        let result = record.procedures[1].result(name).unwrap();
        let entries = result.entry_uncertainties();
        entries.iter().map(Option::is_some).collect()
    };
    assert_eq!(known(unload::FLOOR_DISPLACEMENT.name), [true, false, false]);
    assert_eq!(known(unload::RESIDUAL_DRIFT.name), [true, false, true]);
    let status = |entry| {
        let result = record.procedures[1].result(unload::RESIDUAL_DRIFT.name);
        result.unwrap().uncertainty_status("unload", entry)
    };
    assert_eq!(status(Some(0)), UncertaintyStatus::Known);
    assert!(matches!(status(Some(1)), UncertaintyStatus::Partial(_)));
    assert!(matches!(status(None), UncertaintyStatus::Partial(_)));
}
