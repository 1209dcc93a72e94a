//! What a study tells of a shaken frame with an input moved, against the same run on the same rig with that input truly moved:
//! every kind of storey, stopping and under way, with a damper in each storey and without.

use super::Unwatched;
use super::frame_doubts_tests::{constant, entry, from, shaken};
use crate::mechanics::extremes::{Extremes, Peak};
use crate::mechanics::path::Path;
use crate::plan::{
    Behaviour, Calibration, Frame, Integrator, Link, Mode, Plan, ProcedureKind, Settle, Shake, ShakeDamping, Stepping, Storey,
    VirtualLink,
};
use crate::record::{History, Record};
use crate::rig::{DeclaredNoise, EachReading, Identity, Offer, Reading, Rig, RigFault, virtual_rig};
use crate::uncertainty::{Contribution, Source};

const TIME_SCALE: f64 = 50.0;
/// C/K of the dampers as the frame feels them, s.
const LOSS: f64 = 9e-3;
const TIME_STEP: f64 = 0.01;
/// Standard uncertainty of every source, of its value.
const SHARE: f64 = 0.01;
/// Of the damping ratio itself.
const RATIO: f64 = 0.02;

/// A rig whose cell and transducer of one axis have other factors than they are taken to have.
struct Miscalibrated {
    rig: Box<dyn Rig>,
    axis: usize,
    force: f64,
    displacement: f64,
}

impl Miscalibrated {
    fn read_as(&self, mut reading: Reading) -> Reading {
        reading.force[self.axis] *= self.force;
        reading.displacement[self.axis] *= self.displacement;
        reading
    }
}

impl Rig for Miscalibrated {
    fn identity(&self) -> Identity {
        self.rig.identity()
    }

    fn degrees_of_freedom(&self) -> usize {
        self.rig.degrees_of_freedom()
    }

    fn time(&self) -> f64 {
        self.rig.time()
    }

    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<Offer, RigFault> {
        let mut truly = targets.to_vec();
        truly[self.axis] /= self.displacement;
        let offer = self.rig.propose(&truly, speed)?;
        Ok(Offer { targets: targets.to_vec(), ..offer })
    }

    fn execute(&mut self) -> Result<(), RigFault> {
        self.rig.execute()
    }

    fn pause(&mut self, seconds: f64) -> Result<(), RigFault> {
        self.rig.pause(seconds)
    }

    fn read(&mut self) -> Result<Reading, RigFault> {
        let reading = self.rig.read()?;
        Ok(self.read_as(reading))
    }

    fn traverse(&mut self, targets: &[f64], velocity: f64, samples: usize, each: EachReading<'_>) -> Result<(), RigFault> {
        self.rig.traverse(targets, velocity, samples, each)
    }

    fn glide(&mut self, paths: &[Path], samples: usize, each: EachReading<'_>) -> Result<(), RigFault> {
        let mut truly = paths.to_vec();
        let path = &mut truly[self.axis];
        for place in [&mut path.from, &mut path.to, &mut path.start_velocity, &mut path.end_velocity] {
            *place /= self.displacement;
        }
        let (axis, force, displacement) = (self.axis, self.force, self.displacement);
        self.rig.glide(&truly, samples, &mut |mut reading| {
            reading.force[axis] *= force;
            reading.displacement[axis] *= displacement;
            each(reading)
        })
    }

    fn hold(&mut self) {
        self.rig.hold();
    }

    fn declared_noise(&self) -> DeclaredNoise {
        self.rig.declared_noise()
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Elastic,
    Bilinear,
    BoucWen,
}

/// Which run.
#[derive(Clone, Copy, Debug)]
struct Case {
    kind: Kind,
    continuous: bool,
    dampers: bool,
    link: VirtualLink,
}

/// Seconds on a ground of two sines, as long as it lasts and a rest.
fn plan(case: Case) -> Plan {
    let ground = (0..200).map(|sample| 0.01 * f64::from(sample)).map(|time| {
        let rises = (std::f64::consts::PI * time / 2.0).sin();
        rises * (2.2 * (9.0 * time).sin() + 1.4 * (21.0 * time).sin())
    });
    let storey = |mass: f64, stiffness: f64, yield_force: f64| {
        let behaviour = match case.kind {
            Kind::Elastic => Behaviour::Elastic { stiffness },
            Kind::Bilinear => Behaviour::Bilinear { stiffness, yield_force, hardening: 0.1 },
            Kind::BoucWen => Behaviour::BoucWen { stiffness, yield_force, hardening: 0.1, sharpness: 2.0, beta: 0.5 },
        };
        let damping = if case.dampers { LOSS * TIME_SCALE * stiffness } else { 0.0 };
        Storey { damping, ..Storey::new(mass, stiffness, behaviour) }
    };
    let storeys = vec![storey(2000.0, 600e3, 5500.0), storey(1500.0, 400e3, 3200.0)];
    let mut plan = shaken(storeys, ground.chain([0.0]).collect(), TIME_STEP);
    let mode = if case.continuous { Mode::Continuous { time_scale: TIME_SCALE } } else { Mode::StepAndPause };
    let integrator = if case.continuous { Integrator::Explicit } else { Integrator::Tangent };
    let shake = shake(&mut plan);
    shake.stepping = Stepping { mode, integrator, i_modification: case.continuous, ..shake.stepping.clone() };
    shake.damping = ShakeDamping::Rayleigh(constant(RATIO));
    shake.duration = Some(constant(3.0));
    plan.rig.link = Link::Virtual(case.link);
    plan.rig.settle = Settle { band: 5e-6, force_rate: 50.0, dwell: 0.1, timeout: 10.0 };
    plan
}

fn shake(plan: &mut Plan) -> &mut Shake {
    match &mut plan.procedures[0].kind {
        ProcedureKind::Shake(shake) => shake,
        other => panic!("{other:?}"),
    }
}

const SOURCES: [Source; 6] = [
    Source::StoreyMass { specimen: 0, storey: 0 },
    Source::StoreyStiffness { specimen: 0, storey: 1 },
    Source::DampingRatio { procedure: crate::formula::ProcedureId(0), mode: 0 },
    Source::GroundScale(0),
    Source::ForceScale(1),
    Source::DisplacementScale(0),
];

fn doubtful(case: Case) -> Plan {
    let mut plan = plan(case);
    let storeys = &mut plan.specimens[0].frame.as_mut().unwrap().storeys;
    storeys[0].mass_uncertainty = SHARE * storeys[0].mass;
    storeys[1].stiffness_uncertainty = SHARE * storeys[1].stiffness;
    let storeys = std::mem::take(storeys);
    plan.specimens[0].frame = Some(Frame::of_storeys(storeys));
    shake(&mut plan).damping_uncertainty = 0.1 * RATIO;
    plan.grounds[0].scale_uncertainty = SHARE;
    plan.rig.calibration = Calibration { force_uncertainty: SHARE, displacement_uncertainty: SHARE, ..Calibration::default() };
    plan
}

/// The same run with a source truly moved by so many of its uncertainties: the rig bends what it bent.
fn moved(case: Case, source: Source, by: f64) -> Record {
    let (rig_of, mut plan) = (plan(case), plan(case));
    let mut rig = Miscalibrated { rig: virtual_rig(&rig_of), axis: 0, force: 1.0, displacement: 1.0 };
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
        Source::DampingRatio { .. } => shake(&mut plan).damping = ShakeDamping::Rayleigh(constant(RATIO * (1.0 + 0.1 * by))),
        Source::GroundScale(_) => shake(&mut plan).scale = constant(1.0 + by * SHARE),
        Source::ForceScale(axis) => (rig.axis, rig.force) = (axis, 1.0 + by * SHARE),
        Source::DisplacementScale(axis) => (rig.axis, rig.displacement) = (axis, 1.0 + by * SHARE),
        other => panic!("{other:?}"),
    }
    super::run(&plan, &mut rig, &mut Unwatched)
}

const NAMES: [(&str, usize); 7] = [
    ("max_displacement", 0),
    ("max_displacement", 1),
    ("max_drift", 0),
    ("max_drift", 1),
    ("residual_drift", 0),
    ("residual_drift", 1),
    ("max_base_shear", 0),
];

/// The numbers of a run, between the ends of its steps.
fn numbers(record: &Record) -> [f64; 7] {
    let History::Shake(history) = &record.procedures[0].history else { panic!("{:?}", record.outcome) };
    let (mut places, mut drifts, mut shear) = (Extremes::new(2, TIME_STEP), Extremes::new(2, TIME_STEP), Peak::default());
    for step in &history.steps {
        let (x, v) = (&step.computed, &step.velocity);
        places.take([(x[0], v[0]), (x[1], v[1])].into_iter());
        drifts.take([(x[0], v[0]), (x[1] - x[0], v[1] - v[0])].into_iter());
        shear.take(step.restoring_force.iter().sum());
    }
    let last = &history.steps.last().unwrap().computed;
    let (places, drifts) = (places.largest(), drifts.largest());
    [places[0], places[1], drifts[0], drifts[1], last[0], last[1] - last[0], shear.largest()]
}

/// A number, what a source does to it as told and truly.
#[derive(Debug)]
struct Cell {
    name: (&'static str, usize),
    source: Source,
    told: Option<Contribution>,
    truth: f64,
    value: f64,
}

fn cells(case: Case) -> Vec<Cell> {
    let plan = doubtful(case);
    let told = super::run(&plan, &mut *virtual_rig(&plan), &mut Unwatched);
    for event in &told.events {
        println!("{case:?}: {}", event.text);
    }
    let itself = numbers(&told);
    let mut found = Vec::new();
    for source in SOURCES {
        let (up, down) = (numbers(&moved(case, source, 1.0)), numbers(&moved(case, source, -1.0)));
        for (place, name) in NAMES.into_iter().enumerate() {
            let (_, parts) = entry(&told, name.0, name.1);
            let told = parts.iter().find(|part| part.source == source).copied();
            found.push(Cell { name, source, told, truth: 0.5 * (up[place] - down[place]), value: itself[place] });
        }
    }
    found
}

#[test]
fn print_all() {
    let link = VirtualLink { lag: 0.02, resolution: 1e-6, seed: 3, ..VirtualLink::default() };
    for kind in [Kind::Elastic, Kind::Bilinear, Kind::BoucWen] {
        for continuous in [false, true] {
            for dampers in [false, true] {
                let case = Case { kind, continuous, dampers, link };
                for Cell { name, source, told, truth, value } in cells(case) {
                    let (amount, smooth) = told.map_or((0.0, true), |told| (told.amount, told.smooth));
                    println!(
                        "{kind:?} c{} d{} {source:?} {name:?}: told {:.3}% truth {:.3}% diff {:.3}% {}",
                        u8::from(continuous), u8::from(dampers), 100.0 * amount / value, 100.0 * truth / value, 100.0 * (amount - truth) / value,
                        if smooth { "" } else { "marked" }
                    );
                }
            }
        }
    }
}

#[test]
fn print_one() {
    for lag in [0.0, 0.02] {
        for resolution in [0.0, 1e-6] {
            for dampers in [false, true] {
                for kind in [Kind::Elastic, Kind::Bilinear, Kind::BoucWen] {
                    let link = VirtualLink { lag, resolution, seed: 3, ..VirtualLink::default() };
                    let case = Case { kind, continuous: true, dampers, link };
                    eprintln!("=== {kind:?} dampers {dampers} lag {lag} resolution {resolution}");
                    let plan = doubtful(case);
                    let told = super::run(&plan, &mut *virtual_rig(&plan), &mut Unwatched);
                    for event in &told.events {
                        eprintln!("{}", event.text);
                    }
                }
            }
        }
    }
}

#[test]
fn print_bw() {
    let link = VirtualLink::default();
    let case = Case { kind: Kind::BoucWen, continuous: true, dampers: false, link };
    let mut plan = plan(case);
    let mut step = shake(&mut plan).stepping.clone();
    let d = doubtful(case);
    plan = d;
    for (mode, integrator) in [(Mode::StepAndPause, Integrator::Explicit), (Mode::StepAndPause, Integrator::Tangent)] {
        step.mode = mode;
        step.integrator = integrator;
        step.i_modification = false;
        shake(&mut plan).stepping = step.clone();
        eprintln!("=== {mode:?} {integrator:?}");
        let told = super::run(&plan, &mut *virtual_rig(&plan), &mut Unwatched);
        for event in &told.events {
            eprintln!("{}", event.text);
        }
    }
}
