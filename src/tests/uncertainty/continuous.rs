//! Sensitivity of a ground-motion test by re-integration, compared with a re-run on the same rig with the input perturbed: every kind of
//! storey, ramp-and-hold and continuous, with a damper in each storey and without.

use super::frame::{base_excited_plan, constant, entry};
use super::rest::{Misread, RIGHT};
use crate::run::Unwatched;
use psd_physics::impact::peaks::{Peak, PeakDisplacements};
use psd_plan::record::{History, Record};
use psd_plan::uncertainty::{Contribution, Source};
use psd_plan::{
    Behaviour, Calibration, Frame, Integrator, Link, Mode, Plan, ProcedureKind, Settle, Shake,
    ShakeDamping, Stepping, Storey, VirtualLink,
};
use psd_rig::virtual_rig;

const TIME_SCALE: f64 = 50.0;
/// C/K of the dampers in the time of the frame \[s\].
const LOSS: f64 = 9e-3;
const TIME_STEP: f64 = 0.01;
/// Relative standard uncertainty of every source.
const SHARE: f64 = 0.01;
/// The damping ratio itself.
const RATIO: f64 = 0.02;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Elastic,
    Bilinear,
    BoucWen,
}

/// Identifies one run.
#[derive(Clone, Copy, Debug)]
struct Case {
    kind: Kind,
    continuous: bool,
    dampers: bool,
    link: VirtualLink,
}

/// Ground motion of two sines for its duration, followed by a rest.
fn plan(case: Case) -> Plan {
    let ground = (0..200).map(|sample| 0.01 * f64::from(sample)).map(|time| {
        let rises = (std::f64::consts::PI * time / 2.0).sin();
        rises * (2.2 * (9.0 * time).sin() + 1.4 * (21.0 * time).sin())
    });
    let storey = |mass: f64, stiffness: f64, yield_force: f64| {
        let behaviour = match case.kind {
            Kind::Elastic => Behaviour::Elastic { stiffness },
            Kind::Bilinear => Behaviour::Bilinear {
                stiffness,
                yield_force,
                post_yield_ratio: 0.1,
            },
            Kind::BoucWen => Behaviour::BoucWen {
                stiffness,
                yield_force,
                post_yield_ratio: 0.1,
                sharpness: 2.0,
                beta: 0.5,
            },
        };
        let damping = if case.dampers {
            LOSS * TIME_SCALE * stiffness
        } else {
            0.0
        };
        Storey {
            damping,
            ..Storey::new(mass, stiffness, behaviour)
        }
    };
    let storeys = vec![storey(2000.0, 600e3, 5500.0), storey(1500.0, 400e3, 3200.0)];
    let mut plan = base_excited_plan(storeys, ground.chain([0.0]).collect(), TIME_STEP);
    let mode = if case.continuous {
        Mode::Continuous {
            time_scale: TIME_SCALE,
        }
    } else {
        Mode::RampAndHold
    };
    let integrator = if case.continuous {
        Integrator::Explicit
    } else {
        Integrator::Tangent
    };
    let shake = shake(&mut plan);
    shake.stepping = Stepping {
        mode,
        integrator,
        i_modification: case.continuous,
        ..shake.stepping.clone()
    };
    shake.damping = ShakeDamping::Rayleigh(constant(RATIO));
    shake.duration = Some(constant(3.0));
    plan.rig.link = Link::Virtual(case.link);
    plan.rig.settle = Settle {
        band: 5e-6,
        force_rate: 50.0,
        dwell: 0.1,
        timeout: 10.0,
    };
    plan
}

fn shake(plan: &mut Plan) -> &mut Shake {
    match &mut plan.procedures[0].kind {
        ProcedureKind::Shake(shake) => shake,
        other => panic!("{other:?}"),
    }
}

const SOURCES: [Source; 6] = [
    Source::StoreyMass {
        specimen: 0,
        storey: 0,
    },
    Source::StoreyStiffness {
        specimen: 0,
        storey: 1,
    },
    Source::DampingRatio {
        procedure: psd_plan::formula::ProcedureId(0),
        mode: 0,
    },
    Source::GroundScale(0),
    Source::ForceScale(1),
    Source::DisplacementScale(0),
];

fn uncertain(case: Case) -> Plan {
    let mut plan = plan(case);
    let storeys = &mut plan.specimens[0].frame.as_mut().unwrap().storeys;
    storeys[0].mass_uncertainty = SHARE * storeys[0].mass;
    storeys[1].stiffness_uncertainty = SHARE * storeys[1].stiffness;
    let storeys = std::mem::take(storeys);
    plan.specimens[0].frame = Some(Frame::of_storeys(storeys));
    shake(&mut plan).damping_uncertainty = 0.1 * RATIO;
    plan.grounds[0].scale_uncertainty = SHARE;
    plan.rig.calibration = Calibration {
        force_uncertainty: SHARE,
        displacement_uncertainty: SHARE,
        ..Calibration::default()
    };
    plan
}

/// The same run with a source perturbed by `by` standard uncertainties; the rig keeps its own specimen.
fn moved(case: Case, source: Source, by: f64) -> Record {
    let (rig_of, mut plan) = (plan(case), plan(case));
    let mut rig = Misread {
        rig: virtual_rig(&rig_of),
        axes: vec![RIGHT; 2],
    };
    match source {
        Source::StoreyMass { storey, .. } => {
            let mut storeys = plan.specimens[0].frame.take().unwrap().storeys;
            storeys[storey].mass *= 1.0 + by * SHARE;
            plan.specimens[0].frame = Some(Frame::of_storeys(storeys));
        }
        Source::StoreyStiffness { storey, .. } => {
            let mut storeys = plan.specimens[0].frame.take().unwrap().storeys;
            storeys[storey].stiffness *= 1.0 + by * SHARE;
            plan.specimens[0].frame = Some(Frame::of_storeys(storeys));
        }
        Source::DampingRatio { .. } => {
            shake(&mut plan).damping = ShakeDamping::Rayleigh(constant(RATIO * (1.0 + 0.1 * by)));
        }
        Source::GroundScale(_) => shake(&mut plan).scale = constant(1.0 + by * SHARE),
        Source::ForceScale(axis) => rig.axes[axis].force += by * SHARE,
        Source::DisplacementScale(axis) => rig.axes[axis].displacement += by * SHARE,
        other => panic!("{other:?}"),
    }
    crate::run::run(&plan, &mut rig, &mut Unwatched)
}

const NAMES: [(&str, usize); 7] = [
    ("max_displacement", 0),
    ("max_displacement", 1),
    ("max_drift", 0),
    ("max_drift", 1),
    ("final_drift", 0),
    ("final_drift", 1),
    ("max_base_shear", 0),
];

/// Results of a run, including peaks between the ends of its steps.
fn numbers(record: &Record) -> [f64; 7] {
    let History::Shake(history) = &record.procedures[0].history else {
        panic!("{:?}", record.outcome)
    };
    let (mut displacements, mut drifts, mut shear) = (
        PeakDisplacements::new(2, TIME_STEP),
        PeakDisplacements::new(2, TIME_STEP),
        Peak::default(),
    );
    for step in &history.steps {
        let (x, v) = (&step.floors.computed, &step.floors.velocity);
        displacements.take([(x[0], v[0]), (x[1], v[1])].into_iter());
        drifts.take([(x[0], v[0]), (x[1] - x[0], v[1] - v[0])].into_iter());
        shear.take(step.floors.restoring_force.iter().sum());
    }
    let last = &history.steps.last().unwrap().floors.computed;
    let (displacements, drifts) = (displacements.largest(), drifts.largest());
    [
        displacements[0],
        displacements[1],
        drifts[0],
        drifts[1],
        last[0],
        last[1] - last[0],
        shear.largest(),
    ]
}

/// A result with the reported and the true effects of its sources.
struct ReportedNumber {
    name: (&'static str, usize),
    value: f64,
    parts: Vec<(Source, Option<Contribution>, f64)>,
}

impl ReportedNumber {
    /// The reported and the true standard uncertainty from all sources.
    fn uncertainties(&self) -> [f64; 2] {
        let root = |amounts: &mut dyn Iterator<Item = f64>| {
            amounts.map(|amount| amount * amount).sum::<f64>().sqrt()
        };
        let reported = |(_, reported, _): &(Source, Option<Contribution>, f64)| {
            reported.map_or(0.0, |reported| reported.amount)
        };
        [
            root(&mut self.parts.iter().map(reported)),
            root(&mut self.parts.iter().map(|(.., truth)| *truth)),
        ]
    }
}

fn reported_numbers(case: Case) -> Vec<ReportedNumber> {
    let plan = uncertain(case);
    let record = crate::run::run(&plan, &mut *virtual_rig(&plan), &mut Unwatched);
    assert!(
        !record
            .events
            .iter()
            .any(|event| event.text.contains("not known")),
        "{case:?}: {:?}",
        record.events
    );
    let values = numbers(&record);
    let moved = SOURCES.map(|source| [1.0, -1.0].map(|by| numbers(&moved(case, source, by))));
    let number = |(index, name): (usize, (&'static str, usize))| {
        let (_, parts) = entry(&record, name.0, name.1);
        let part = |(source, [up, down]): (Source, &[[f64; 7]; 2])| {
            (
                source,
                parts.iter().find(|part| part.source == source).copied(),
                0.5 * (up[index] - down[index]),
            )
        };
        ReportedNumber {
            name,
            value: values[index],
            parts: SOURCES.into_iter().zip(&moved).map(part).collect(),
        }
    };
    NAMES.into_iter().enumerate().map(number).collect()
}

/// Allowed difference between reported and true values.
#[derive(Clone, Copy)]
struct Within {
    /// The reported effect of a source that is marked smooth, relative to its true effect.
    smooth: f64,
    /// The combined uncertainty, relative to the true one: smaller, and larger.
    less: f64,
    more: f64,
}

/// Checks every result of every run of one kind of storey. Effects smaller than a ten thousandth of a result count as zero.
fn compare(kind: Kind, within: Within, links: [VirtualLink; 2], modes: &[(bool, bool)]) {
    let mut wrong = Vec::new();
    for (continuous, dampers) in modes.iter().copied() {
        let case = Case {
            kind,
            continuous,
            dampers,
            link: links[usize::from(continuous)],
        };
        let mut smooth = 0;
        for number in reported_numbers(case) {
            let nothing = 2e-4 * number.value.abs();
            for (source, reported, truth) in &number.parts {
                let Some(reported) = reported.filter(|reported| reported.smooth) else {
                    continue;
                };
                smooth += 1;
                if (reported.amount - truth).abs() > within.smooth * truth.abs() + nothing {
                    wrong.push(format!(
                        "{:?} by {source:?}: {:e}, truly {truth:e}; {case:?}",
                        number.name, reported.amount
                    ));
                }
            }
            let [reported, truth] = number.uncertainties();
            // A Bouc–Wen specimen does not follow Masing's rule, so marked contributions have no guaranteed accuracy.
            let promised = kind != Kind::BoucWen
                || number
                    .parts
                    .iter()
                    .all(|(_, reported, _)| reported.is_none_or(|reported| reported.smooth));
            if !promised {
                continue;
            }
            if reported < truth * (1.0 - within.less) - nothing
                || (number.name.0 != "final_drift"
                    && reported > truth * (1.0 + within.more) + nothing)
            {
                wrong.push(format!(
                    "{:?}: u = {reported:e}, truly {truth:e}; {case:?}",
                    number.name
                ));
            }
        }
        // For a specimen that yields during the run, the smooth contributions end before its first reversal.
        assert!(
            smooth > 0 || kind == Kind::BoucWen || continuous && kind != Kind::Elastic,
            "{case:?}"
        );
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

const EVERY: [(bool, bool); 4] = [(false, false), (false, true), (true, false), (true, true)];
/// A servo that is 0.04 of a step behind, and one that is not.
const LINKS: [VirtualLink; 2] = [IDEAL, VirtualLink { lag: 0.02, ..IDEAL }];
const IDEAL: VirtualLink = VirtualLink {
    noise: 0.0,
    resolution: 0.0,
    force_resolution: 0.0,
    lag: 0.0,
    tracking: 0.0,
    drift: 0.0,
    seed: 3,
    predicted: None,
};

#[test]
fn elastic_storeys_are_reported_with_their_true_response() {
    compare(
        Kind::Elastic,
        Within {
            smooth: 0.02,
            less: 0.02,
            more: 0.02,
        },
        LINKS,
        &EVERY,
    );
}

#[test]
fn yielding_storeys_are_reported_with_their_true_response() {
    compare(
        Kind::Bilinear,
        Within {
            smooth: 0.1,
            less: 0.03,
            more: 0.15,
        },
        LINKS,
        &EVERY,
    );
}

/// A Bouc–Wen specimen loses the memory of its reversals during plastic flow, and does not follow Masing's rule. The unmarked
/// contributions are still correct.
#[test]
fn bouc_wen_storeys_are_reported_with_their_true_response() {
    compare(
        Kind::BoucWen,
        Within {
            smooth: 0.25,
            less: 0.1,
            more: 1.0,
        },
        LINKS,
        &EVERY,
    );
}

/// With a resolution of 1 µm and 2 N of noise, the same in every run.
#[test]
fn noise_during_the_motion_does_not_hide_the_effect_of_an_input() {
    let noisy = VirtualLink {
        lag: 0.02,
        resolution: 1e-6,
        noise: 2.0,
        ..IDEAL
    };
    for kind in [Kind::Elastic, Kind::Bilinear] {
        compare(
            kind,
            Within {
                smooth: 0.2,
                less: 0.1,
                more: 0.2,
            },
            [noisy; 2],
            &[(true, true)],
        );
    }
}
